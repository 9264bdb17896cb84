// What the editor shows. Only editing.ts writes it.
import { computed, signal } from "@preact/signals";
import type { KeypointSet } from "../core/edits";
import type { Keypoint, Matrix, Mesh, Vec3 } from "../core/types";
import { EMPTY, folded, type History } from "./history";
import type { Joint } from "./skeleton";

export type Tool = "joints" | "align" | "cut" | "paint";
/** null: the editor is closed */
export const tool = signal<Tool | null>(null);
export const history = signal<History>(EMPTY);
export const edited = computed(() => folded(history.value.done));

/** How the scan lay, and the joints that were found, when the editor was opened first. */
export const base = signal<{ body_from_scan: Matrix; found: readonly Keypoint[] } | null>(null);
export const bodyFromScan = computed(() => edited.value.body_from_scan ?? base.value?.body_from_scan ?? null);

export const selected = signal<Joint>("pelvis");
export const locked = computed(() => edited.value.locked);
export const wholeLimb = signal(false);
export const snaps = signal(true);
/** Joints while they are dragged; null: as edited. */
export const dragged = signal<KeypointSet | null>(null);
export const keypoints = computed(() => dragged.value ?? edited.value.keypoints);

export interface Preview {
  body: Mesh;
  joints: { name: string; body_m: Vec3 }[];
  errorMm: number;
  /** previews in the last second */
  rate: number;
  /** that the core took, and from the question to the answer */
  workMs: number;
  answerMs: number;
}
export const preview = signal<Preview | null>(null);
export const showBody = signal(true);

export type Handle = "translate" | "rotate" | "scale";
export const handle = signal<Handle>("rotate");
export const steps = signal(true);
export const cutter = signal<"box" | "lasso">("lasso");
export const cutSide = signal<"inside" | "outside">("inside");
/** The scan without what is cut away; null: nothing is. */
export const rest = signal<Mesh | null>(null);
/** The same, or the scan, with few vertices: drawn while something is dragged. */
export const coarse = signal<Mesh | null>(null);
export const trouble = signal("");
