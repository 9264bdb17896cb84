// Typed messages between the page and the worker that holds the core.
import type { EditorAnswer, EditorRequest } from "../editor/requests";
import type { ModelFile, ModelKind, ModelsInfo } from "../models/types";
import type { Measurements, Section } from "./measurements";
import type { BodyDescription, BodyParameters, LessonData, LessonSettings, PosedBody } from "./teaching";
import type { CoreStage, ErrorCode, Findings, OutputFile, ScanData, Settings } from "./types";

export interface CoreInfo {
  version: string;
  threads: number;
}

/** Every request with its arguments and its answer. */
export interface Calls {
  /** Loads the core; `threads` = 1 loads the build without threads. */
  start: { args: { base: string; threads: number }; result: CoreInfo };
  open: { args: { file: Blob; name: string }; result: ScanData };
  /**
   * Puts a user's model files to use in place of the bundled ones: new ones, and of those held the ones that do not give
   * way to them; with none, the bundled ones again. `learnt`: `landmarks` of earlier answers, text by sha256. All that
   * was found before is then dropped; on failure nothing changes.
   */
  models: {
    args: {
      fresh: ModelFile[];
      held: (ModelFile & { kind: ModelKind })[];
      learnt: Record<string, string>;
    };
    result: ModelsInfo;
  };
  /** Takes settings over; answers how many of the core's stages still hold. */
  configure: { args: { settings: Settings }; result: number };
  /** Works the opened scan up to a stage: what is not there yet, or with `again` that stage and all after it anew. */
  run: { args: { until: CoreStage; again: boolean }; result: Findings };
  /** Ends the `run` under way, which then fails with code "cancelled". */
  cancel: { args: Record<string, never>; result: null };
  /** Asks one of the editors' questions about the opened scan. */
  edit: { args: { request: EditorRequest }; result: EditorAnswer };
  /** Files of the last result as the command line writes them. */
  files: { args: { format: "ply" | "obj" | "glb" }; result: OutputFile[] };
  /** Measures the last result. */
  measure: { args: Record<string, never>; result: Measurements };
  /** `count` sections along a segment of the last result. */
  profile: { args: { segment: string; count: number }; result: Section[] };
  /** What `vitruvian measure --export format` writes; "measurements": the tables; "all": all of it. */
  measuredFiles: { args: { format: string }; result: OutputFile[] };
  /** The body model that is loaded. */
  body: { args: Record<string, never>; result: BodyDescription };
  /** The body posed by hand; may be asked while something else is worked. */
  poseBody: { args: { parameters: BodyParameters }; result: PosedBody };
  /** The fit of the opened scan, whose keypoints are found, again and watched. */
  lesson: { args: { settings: LessonSettings }; result: LessonData };
  /** Bytes of memory that the core holds, and how many of them are in use. */
  memory: { args: Record<string, never>; result: { heap: number; inUse: number } };
}

export type Kind = keyof Calls;

export type Request = { [K in Kind]: { id: number; kind: K; args: Calls[K]["args"] } }[Kind];

/** An iteration of the published solver. */
export interface EnergyPoint {
  curve: string;
  iteration: number;
  value: number;
}

export interface Progress {
  /** a stage of the core (read, align, project, detect, pose, fit, refine) or words for the user */
  stage: string;
  /** 0..1, or null when unknown */
  fraction: number | null;
  /** of the published solver's iterations since the last report */
  energies?: EnergyPoint[];
}

export type Reply =
  | { id: number; ok: true; value: unknown }
  | { id: number; ok: false; error: { code: ErrorCode; message: string } }
  | { progress: Progress };
