// Edits made by hand, as the command line reads them from files and registration.json keeps them.
import type { Matrix, Vec3 } from "./types";

/** keypoints JSON: joints by their SMPL names; one that is missing is not used. */
export interface KeypointSet {
  /** scan: scan units in the scan frame; the others: metres */
  frame: "scan" | "body" | "canonical";
  joints: Record<string, { position: Vec3; confidence?: number }>;
}

/** A part of the scan that is cut away: a box (taken to the cube from -1 to 1), or what lies behind a closed line on a picture. */
export type Crop = { remove: "inside" | "outside" } & (
  | { box_from_scan: Matrix }
  | { clip_from_scan: Matrix; polygon: [number, number][] }
);

/** regions JSON: pairs that are matched with each other only. */
export interface RegionSet {
  scan_sha256: string;
  model_sha256: string;
  pairs: {
    name: string;
    /** in file order, before any merging */
    scan_vertices: number[];
    template_vertices: number[];
  }[];
}

/** The body of an earlier registration: its `parameters`, and its model's hash. */
export interface StartBody {
  betas: number[];
  pose: number[];
  translation_m: Vec3;
  expression?: number[];
  dmpl?: number[];
  model_sha256: string;
}

/** Members of the settings; null or missing: not edited. */
export interface Edits {
  /** given instead of found; unit factor included */
  body_from_scan?: Matrix | null;
  /** given instead of detected */
  keypoints?: KeypointSet | null;
  regions?: RegionSet | null;
  /** cut away before anything else */
  crops?: Crop[] | null;
  /** where the fit starts; "file" belongs to `start` */
  init?: "auto" | "keypoints" | "tpose" | "file";
  start?: StartBody | null;
}
