// What the painter asks of the core (wasm/painter.h). Scan vertices are numbered as in the file, however few are drawn.
import type { Crop, RegionSet } from "../core/edits";
import type { Matrix, Mesh } from "../core/types";

export type Side = "scan" | "template";

/** The picture that is painted on. */
export interface PaintCamera {
  /** perspective, from the frame of the mesh's positions */
  clip_from_mesh: Matrix;
  /** pixels */
  width: number;
  height: number;
}

/** What a stroke touches: `way` in pixels from the upper left corner. */
export type Stroke = { way: [number, number][] } & (
  | { with: "brush"; radius: number }
  | { with: "lasso" }
  | { with: "part" }
);

/** A mesh to paint on. */
export interface PaintMesh {
  /** scan: relative to its origin in the scan frame; template: body frame */
  mesh: Mesh;
  /** vertices that can be painted, drawn or not */
  vertices: number;
  sha256: string;
}

export interface PaintExchanges {
  /** `source`: number in the file of each vertex that is drawn */
  paint_scan: { request: { crops: readonly Crop[] }; answer: PaintMesh & { source: Uint32Array } };
  /** posed: as the scan stands; rest: limbs spread */
  paint_template: { request: { stance: "posed" | "rest" }; answer: PaintMesh };
  paint_pick: {
    request: { side: Side; camera: PaintCamera } & Stroke;
    answer: { vertices: Uint32Array };
  };
  /** The segment that each vertex seems to belong to: an index into `names`; others belong to none. */
  paint_suggest: {
    request: object;
    answer: { names: string[]; scan: Uint8Array; template: Uint8Array };
  };
  import_regions: { request: { text: string; name: string }; answer: { regions: RegionSet } };
}
