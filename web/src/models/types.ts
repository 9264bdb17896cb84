/** What a user's model file is for: ModelFileKind in core/pipeline/own_models.h, in its order. */
export const kModelKinds = ["body", "soft tissue", "prior"] as const;
export interface ModelFile {
  file: Blob;
  name: string;
}
export type ModelKind = (typeof kModelKinds)[number];

/** Whether a file of this kind makes room for new ones: soft tissue belongs to the body it was opened with. */
export function givesWay(kind: ModelKind, to: readonly ModelKind[]): boolean {
  return to.includes(kind) || (kind === "soft tissue" && to.includes("body"));
}

/** The models that a registration uses. */
export interface ModelsInfo {
  name: string;
  family: string;
  vertices: number;
  betas: number;
  joints: number;
  sha256: string;
  /** whether a user's file is among them */
  own: boolean;
  /** where landmarks lie on a user's body model, to be given back for the same model; null: not learnt */
  landmarks: { sha256: string; text: string } | null;
  /** of each of the new files that were given */
  kinds: ModelKind[];
}
