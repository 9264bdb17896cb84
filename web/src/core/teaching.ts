// What crosses between page and core for looking at the method: the body posed by hand, the fit watched.
import type { Gender, Vec3 } from "./types";

/** `parameters` of registration.json. */
export interface BodyParameters {
  betas: number[];
  /** axis-angle, three numbers a joint, root first */
  pose: number[];
  translation_m: Vec3;
}

/** What there is to move on a body, and how far. */
export interface BodyDescription {
  name: string;
  joints: { name: string; parent: number; low_rad: Vec3 | null; high_rad: Vec3 | null }[];
  shape: Record<Gender, { mean: number[]; deviation: number[] }>;
  faces: Uint32Array;
}

export interface PosedBody {
  /** xyz triples, body frame */
  positions: Float32Array;
  joints: Vec3[];
  /** standing, of the shape alone */
  height_m: number;
}

/** What is changed in the fit; what is missing is as ever (LessonSettings in core/pipeline). */
export interface LessonSettings {
  tpose: boolean;
  keypoint_noise_mm: number;
  one_directional: boolean;
  prior_weight: number;
  iterations: number;
}

export const unchangedLesson: LessonSettings = {
  tpose: false,
  keypoint_noise_mm: 0,
  one_directional: false,
  prior_weight: 1,
  iterations: 36,
};

export const kEnergyTerms = [
  "model_to_scan",
  "scan_to_model",
  "landmarks",
  "pose_prior",
  "joint_limits",
  "shape_prior",
] as const;
export type EnergyTerm = (typeof kEnergyTerms)[number];

/** One iteration before its step; the last is the fitted body. */
export interface LessonStep {
  /** -1: from keypoints; 0..2: the surface, coarse to fine */
  stage: number;
  scale_mm: number;
  energy: Record<EnergyTerm, number>;
  model_to_scan_mm: number;
  scan_to_model_mm: number;
  landmark_mm: number;
  /** xyz triples, body frame */
  joints: Float32Array;
  /** template vertex and scan point, six numbers a pair */
  pairs: Float32Array;
  pairs_of_model: number;
  parameters: BodyParameters;
}

export interface LessonData {
  steps: LessonStep[];
  /** a template vertex, at the end */
  residual_m: Float32Array;
  unchanged_residual_m: Float32Array;
  /** where the keypoints were taken to be, body frame */
  targets: Vec3[];
  /** joints at the end, from those of the fit with nothing changed */
  apart_mm: { largest: number; mean: number };
}
