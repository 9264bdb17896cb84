// What the core measures on a registered body (measurements.json, and where on the body it lies).
import type { Mesh, Vec3 } from "./types";

/** The body that a dimension is taken on: re-posed standing or sitting, or as scanned. */
export type Figure = "standing" | "sitting" | "scanned";

export interface Dimension {
  id: string;
  name: string;
  standard: string;
  definition: string;
  side: "left" | "right" | "";
  value_mm: number;
  /** standard uncertainty; null where the fit's error is unknown */
  uncertainty_mm: number | null;
  posture: "standard" | "scanned";
  figure: Figure;
  kind: "tape" | "line" | "height" | "extent";
  /** corners of the tape or line, scan frame and units */
  course: Vec3[];
}

export interface SegmentMeasure {
  segment: string;
  length_mm: number;
  volume_closed_cm3: number;
  area_cm2: number;
  mass_kg: number;
}

/** One section across a segment; null where the plane misses it. */
export interface Section {
  segment: string;
  /** 0 at the proximal joint, 1 at the distal one */
  t: number;
  area_cm2: number | null;
  perimeter_mm: number | null;
  perimeter_hull_mm: number | null;
  breadth_mm: number | null;
  depth_mm: number | null;
  /** scan frame and units */
  course: Vec3[];
}

export interface MeasurementsReport {
  body: { volume_cm3: number; area_cm2: number; mass_kg: number };
  segments: SegmentMeasure[];
  dimensions: Dimension[];
}

export interface Measurements extends MeasurementsReport {
  /** the body re-posed, standing where the scan stands; body frame, metres */
  standing: Mesh;
  /** likewise, sitting */
  seated: Mesh;
}

/** What can be exported: the format's name on the command line ("measurements": always written), and its files. */
export const EXPORTS = [
  ["measurements", "measurements.csv", "a row a value, for spreadsheets"],
  ["measurements", "measurements.json", "everything measured, for programs"],
  ["html", "report.html", "to read and print, with the tapes drawn"],
  ["glb", "body.glb", "body with skeleton, for Blender and three.js"],
  ["npz", "amass.npz", "pose and shape as AMASS has them"],
  ["smpl", "body.smpl", "pose and shape, SMPL codec"],
  ["trc", "markers.trc", "landmarks and joints for OpenSim"],
  ["trc", "markers_subject.json", "mass and stature for OpenSim"],
  ["landmarks", "landmarks.csv", "landmarks for OpenSim Creator"],
  ["ply", "segments.ply", "body coloured by segment"],
  ["ply", "errors.ply", "body coloured by distance"],
  ["obj", "segments.obj", "body coloured by segment"],
  ["obj", "errors.obj", "body coloured by distance"],
] as const;
