// What crosses between the page and the core. JSON types follow the outside contract of registration.json.

import type { Edits } from "./edits";

/** A 4x4 as four rows of four. */
export type Matrix = readonly (readonly number[])[];
export type Vec3 = readonly [number, number, number];

export type Unit = "m" | "cm" | "mm" | "in";
export type Axis = "x" | "y" | "z" | "-x" | "-y" | "-z";
export type Gender = "neutral" | "female" | "male";

/**
 * What decides a registration besides the scan and the models: members of `settings` in registration.json. What is
 * missing is as the method says.
 */
export interface Settings extends Edits {
  method: "ours" | "paper" | "paper-cpu";
  gender: Gender;
  /** pictures that the keypoints are found in */
  views?: 2 | 8 | undefined;
  units: Unit | "auto";
  up: Axis | "auto";
  front: Axis | "auto";
  detail: "off" | "vertex";
  /** published solver: of each of its stages */
  iterations?: number | undefined;
  /** published solver: of these by Adam, the rest by L-BFGS */
  adam_iterations?: number | undefined;
  seed: number;
}

export const defaultSettings: Settings = {
  method: "ours",
  gender: "neutral",
  units: "auto",
  up: "auto",
  front: "auto",
  detail: "off",
  seed: 1,
};

export interface Statistics {
  count: number;
  mean_mm: number | null;
  std_mm: number | null;
  median_mm: number | null;
  p95_mm: number | null;
  max_mm: number | null;
}

export interface SegmentRow extends Omit<Statistics, "count"> {
  segment: string;
  observed: number;
  count: number | null;
}

export interface SurfaceError {
  segments: SegmentRow[];
  all: Statistics;
  surface_segments: SegmentRow[];
  surface_all: Statistics;
  scan_to_model: Pick<Statistics, "mean_mm" | "median_mm" | "p95_mm" | "max_mm">;
}

export interface Verdict {
  status: "ok" | "doubtful" | "failed";
  confidence: number;
  reasons: string[];
}

export interface Keypoint {
  joint: string;
  position_m: Vec3 | null;
  confidence: number;
  source: "detected" | "derived" | "user" | "none";
}

export interface Alignment {
  body_from_scan: Matrix;
  canonical_from_body: Matrix;
  up: string;
  front: string;
  method: string;
}

/** registration.json */
export interface Registration {
  vitruvian: string;
  scan: {
    file: string;
    sha256: string;
    vertices: number;
    faces: number;
    unit: Unit;
    metres_per_unit: number;
  };
  model: {
    name: string;
    gender: Gender;
    vertices: number;
    faces: number;
    betas: number;
    joints: number;
    sha256: string;
  };
  alignment: Alignment | null;
  keypoints: Keypoint[];
  parameters: { betas: number[]; pose: number[]; translation_m: Vec3; offsets?: string } | null;
  joints: { name: string; body_m: Vec3; scan: Vec3 }[];
  /** `parametric`: before vertex offsets were added. */
  surface_error: (SurfaceError & { parametric?: SurfaceError }) | null;
  verdict: Verdict;
  timing_ms: Record<string, number>;
  settings: Record<string, unknown>;
}

/** Stable names of core/base/error.h, and those that only the page knows. */
export type ErrorCode =
  | "usage"
  | "not_available"
  | "unsupported_format"
  | "bad_file"
  | "no_geometry"
  | "bad_model"
  | "cannot_read"
  | "cannot_write"
  | "cancelled"
  | "internal"
  | "network"
  | "out_of_memory";

export class CoreError extends Error {
  constructor(
    readonly code: ErrorCode,
    message: string,
  ) {
    super(message);
    this.name = "CoreError";
  }
}

/** A mesh, or a bare point cloud when `indices` is empty. */
export interface Mesh {
  /** xyz triples */
  positions: Float32Array;
  /** a vertex each; absent: to be computed from the faces */
  normals?: Float32Array;
  indices: Uint32Array;
}

/** An opened scan. `mesh` is in scan units along the scan's axes and may be a decimated copy. */
export interface ScanData {
  file: string;
  bytes: number;
  vertices: number;
  faces: number;
  decimated: boolean;
  /** scan frame; `mesh` is relative to it, so that its single precision is enough */
  origin: Vec3;
  /** what was repaired or left out */
  notes: string[];
  mesh: Mesh;
}

/** One rendered view with what the network saw in it. */
export interface ViewData {
  width: number;
  height: number;
  /** height x width x 3 */
  rgb: Uint8Array;
  landmarks: { x: number; y: number; confidence: number }[];
}

/** How the scan lies. */
export interface AlignData {
  unit: Unit;
  metres_per_unit: number;
  /** scan axes */
  up: Axis;
  front: Axis;
  /** false: nothing tells front from back */
  front_is_known: boolean;
  method: string;
  body_from_scan: Matrix;
  /** extent along up, without floor and strays */
  height_m: number;
  /** plain words when another unit is possible too, else empty */
  note: string;
}

export interface KeypointsData {
  views: ViewData[];
  /** the 22 joints, body frame */
  joints: Keypoint[];
}

/** The body that the fit starts from. */
export interface PoseData {
  /** body frame; angle against the parent */
  joints: { name: string; body_m: Vec3; turn_rad: number }[];
  /** body frame, metres */
  body: Mesh;
}

/** The registered body. */
export interface ResultData {
  registration: Registration;
  /** registered vertices, body frame, metres; empty when failed */
  body: Mesh;
  /** a vertex of `body`, to the scan's surface; empty when failed */
  vertexErrorMm: Float32Array;
}

/** What each of the core's stages found; null for those that are not reached. */
export interface Findings {
  align: AlignData | null;
  keypoints: KeypointsData | null;
  pose: PoseData | null;
  register: ResultData | null;
}

export interface OutputFile {
  name: string;
  data: Uint8Array;
}

/** Stages of the core, in its order (PipelineStage in core/pipeline/stage.h). */
export const kCoreStages = ["align", "keypoints", "pose", "register"] as const;
export type CoreStage = (typeof kCoreStages)[number];

/** Stages of the page. */
export const kStages = ["scan", "align", "keypoints", "pose", "register", "results"] as const;
export type Stage = (typeof kStages)[number];
