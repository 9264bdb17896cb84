// What the editors ask of the core (wasm/editor.h). Positions and lines of sight are in the scan frame, scan units.
import type { Crop, KeypointSet, RegionSet } from "../core/edits";
import type { Matrix, Mesh, Settings, Vec3 } from "../core/types";
import type { PaintExchanges } from "../paint/requests";

export interface PlacedJoint {
  position: Vec3;
  confidence?: number;
}
export type JointChanges = Record<string, PlacedJoint | null>;

/** One thing done by hand, as a project file holds it. */
export type Edit = { label?: string } & (
  | { edit: "align"; body_from_scan: Matrix | null }
  | ({ edit: "crop" } & Crop)
  | { edit: "keypoints"; keypoints: KeypointSet | null }
  | { edit: "joints"; joints: JointChanges }
  | { edit: "regions"; regions: RegionSet | null }
);

interface Exchanges extends PaintExchanges {
  /** Poses the body by the keypoints; `sight` first puts a joint in the middle of the body along a line. */
  preview: {
    request: {
      keypoints: KeypointSet;
      body_from_scan: Matrix;
      /** from the start, not from the last pose */
      anew?: boolean;
      sight?: { joint: string; origin: Vec3; direction: Vec3 };
    };
    answer: {
      /** where `sight` put its joint; null: nowhere else */
      moved: Vec3 | null;
      joints: { name: string; body_m: Vec3 }[];
      /** of the joints to their keypoints, mean */
      error_mm: number;
      /** that the core took */
      work_ms: number;
      /** body frame */
      body: Mesh;
    };
  };
  /** The shown scan without what is cut away, thinned to about so many vertices. */
  cut: { request: { crops: Crop[]; most_vertices?: number }; answer: { mesh: Mesh } };
  /** Left and right exchanged, or one side's limbs mirrored to the other. */
  sides: {
    request: { keypoints: KeypointSet; locked: string[]; from?: "left" | "right" };
    answer: { joints: JointChanges };
  };
  /** The joints that were found, where the model has them; after the stage "keypoints". */
  found_keypoints: { request: { body_from_scan: Matrix }; answer: { keypoints: KeypointSet } };
  import_keypoints: {
    request: { text: string; name: string; body_from_scan: Matrix };
    answer: { keypoints: KeypointSet };
  };
  save_project: { request: { edits: Edit[] }; answer: { text: string } };
  open_project: {
    request: { text: string; name: string };
    answer: { settings: Settings; edits: Edit[] };
  };
}

export type EditorRequest = { [K in keyof Exchanges]: { do: K } & Exchanges[K]["request"] }[keyof Exchanges];
export type EditorAnswer = Exchanges[keyof Exchanges]["answer"];
export type AnswerTo<R extends EditorRequest> = Exchanges[R["do"]]["answer"];
