// Everything that the page shows, as signals. Only actions.ts writes them (view options and theme apart).
import { computed, signal } from "@preact/signals";
import type { CoreInfo, Progress } from "../core/messages";
import {
  type CoreError,
  type CoreStage,
  defaultSettings,
  type Findings,
  kCoreStages,
  kStages,
  type ScanData,
  type Settings,
  type Stage,
} from "../core/types";
import { legendMaximum } from "../result/colours";

export const stage = signal<Stage>("scan");
export const core = signal<CoreInfo | null>(null);
export const settings = signal<Settings>(defaultSettings);

export const scan = signal<ScanData | null>(null);

export const NOTHING: Findings = { align: null, keypoints: null, pose: null, register: null };
/** What the stages found with the settings as they are. */
export const found = signal<Findings>(NOTHING);
/** Stages whose finding was dropped because a setting changed. */
export const stale = signal<ReadonlySet<CoreStage>>(new Set());
/** The registered body. */
export const result = computed(() => found.value.register);

export interface Busy {
  /** the stage in the rail that works */
  stage: Stage;
  /** performance.now() at the start */
  since: number;
}
export const busy = signal<Busy | null>(null);
export const progress = signal<Progress | null>(null);
export const problem = signal<{ stage: Stage; error: CoreError } | null>(null);

export type Done = "waiting" | "working" | "done" | "stale" | "failed";

/** The rail's stage that a stage of the core belongs to. */
const RAIL: Record<string, Stage> = {
  read: "scan",
  align: "align",
  project: "keypoints",
  detect: "keypoints",
  pose: "pose",
  fit: "register",
  refine: "register",
};

/** The core's stages in words; what is not here comes in words already. */
const WORDS: Record<string, string> = {
  read: "Reading the scan",
  align: "Finding up and units",
  project: "Drawing the scan from all sides",
  detect: "Finding keypoints",
  pose: "Posing the body",
  fit: "Fitting the body",
  refine: "Refining and measuring",
  model: "Reading the body model",
  calibrate: "Looking at the body model to learn where its landmarks are",
};

/** What is being done, in words; null when nothing is. */
export const doing = computed(() => {
  if (!busy.value) return null;
  const name = progress.value?.stage ?? "";
  return WORDS[name] ?? (name || "Preparing");
});

/** The rail's stage that works; never one beyond the stage that was asked for. */
export const stageAtWork = computed<Stage | null>(() => {
  if (!busy.value) return null;
  const at = RAIL[progress.value?.stage ?? ""] ?? busy.value.stage;
  return kStages.indexOf(at) > kStages.indexOf(busy.value.stage) ? busy.value.stage : at;
});

function isCoreStage(name: Stage): name is CoreStage {
  return (kCoreStages as readonly string[]).includes(name);
}

/** State of each stage for the rail. While one works, those before it are done. */
export const progressOf = computed<Record<Stage, Done>>(() => {
  const at = stageAtWork.value;
  const failure = problem.value && problem.value.error.code !== "cancelled" ? problem.value.stage : null;
  const states = kStages.map((name, i): [Stage, Done] => {
    if (name === at) return [name, "working"];
    if (name === failure) return [name, "failed"];
    if (name === "scan") return [name, scan.value ? "done" : "waiting"];
    const of = isCoreStage(name) ? name : "register";
    if (found.value[of] || (at !== null && i < kStages.indexOf(at))) return [name, "done"];
    return [name, stale.value.has(of) ? "stale" : "waiting"];
  });
  return Object.fromEntries(states) as Record<Stage, Done>;
});

export type Measure = "surface" | "points";

export interface ViewOptions {
  showScan: boolean;
  showBody: boolean;
  scanOpacity: number;
  bodyOpacity: number;
  wireframe: boolean;
  split: boolean;
  heatMap: boolean;
  showKeypoints: boolean;
  /** upper end of the error colours, mm; null: chosen from the data */
  legendMaximum: number | null;
}

export const view = signal<ViewOptions>({
  showScan: true,
  showBody: true,
  scanOpacity: 0.2,
  bodyOpacity: 1,
  wireframe: false,
  split: false,
  heatMap: true,
  showKeypoints: true,
  legendMaximum: null,
});

export function setView(change: Partial<ViewOptions>): void {
  view.value = { ...view.value, ...change };
}

/** The body in the 3D view, with its errors when they are known. */
export const shownBody = computed(() => {
  const { pose, register } = found.value;
  if (stage.value === "pose") return pose && { mesh: pose.body, errorsMm: null };
  if (stage.value !== "register" && stage.value !== "results") return null;
  return register && { mesh: register.body, errorsMm: register.vertexErrorMm };
});

/** What the 3D view draws: the user's choice for the result, and what each earlier stage is about. */
export const shownView = computed<ViewOptions>(() => {
  if (!shownBody.value) {
    return { ...view.value, showScan: true, showBody: false, split: false, scanOpacity: 1 };
  }
  if (stage.value === "pose") {
    return { ...view.value, showScan: true, showBody: true, split: false, scanOpacity: 0.35, bodyOpacity: 1 };
  }
  return view.value;
});

/** Upper end of the error colours, mm. */
export const legend = computed(
  () => view.value.legendMaximum ?? legendMaximum(result.value?.vertexErrorMm ?? new Float32Array()),
);

export const aboutOpen = signal(false);
export const helpOpen = signal(false);
