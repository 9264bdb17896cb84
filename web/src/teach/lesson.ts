// The fit as a film: run again with something changed, each iteration there to be looked at.
import { computed, effect, signal } from "@preact/signals";
import { type LessonData, type LessonSettings, type LessonStep, unchangedLesson } from "../core/teaching";
import { CoreError, type Settings } from "../core/types";
import { ask, borrowCore, change, run } from "../ui/actions";
import * as page from "../ui/state";
import { latestOnly, loadBody } from "./posing";

export const kChapters = ["align", "see", "pose", "fit", "judge"] as const;
export type Chapter = (typeof kChapters)[number];

export const chapter = signal<Chapter>("align");
export const settings = signal<LessonSettings>(unchangedLesson);
export const lesson = signal<LessonData | null>(null);
/** of the chapter's steps */
export const at = signal(0);
export const playing = signal(false);
export const showPairs = signal(true);
export const problem = signal<CoreError | null>(null);
/** vertices of the body at the step */
export const filmBody = signal<Float32Array | null>(null);

/** The steps that the chapter is about. */
export const film = computed<LessonStep[]>(() => {
  const steps = lesson.value?.steps ?? [];
  if (chapter.value === "pose") return steps.filter(({ stage }) => stage < 0);
  return chapter.value === "fit" || chapter.value === "judge" ? steps.filter(({ stage }) => stage >= 0) : [];
});
export const step = computed<LessonStep | null>(
  () => film.value[Math.min(at.value, film.value.length - 1)] ?? null,
);

export function open(next: Chapter): void {
  playing.value = false;
  chapter.value = next;
  at.value = next === "judge" ? film.value.length - 1 : 0;
}

async function guarded(work: () => Promise<void>): Promise<void> {
  try {
    await work();
    problem.value = null;
  } catch (error) {
    problem.value = error instanceof CoreError ? error : new CoreError("internal", String(error));
  }
}

/** Runs the fit with the settings, and what must be there before it. */
export async function runLesson(): Promise<void> {
  if (!page.scan.value || page.busy.value) return;
  if (!page.found.value.keypoints) await run("keypoints", page.stage.value);
  if (!page.found.value.keypoints) {
    problem.value = page.problem.value?.error ?? null;
    return;
  }
  await guarded(async () => {
    const chosen = settings.value;
    lesson.value = await borrowCore((client) => client.call("lesson", { settings: chosen }), "keep");
    at.value = Math.max(film.value.length - 1, 0);
  });
  await loadBody();
}

/** Changes something in the fit, and shows what comes of it. */
export function play(changed: Partial<LessonSettings>): void {
  settings.value = { ...settings.value, ...changed };
  void runLesson();
}

/** Changes a setting of the main view's stages, and works up to the stage again. */
export async function playStage(changed: Partial<Settings>, stage: "align" | "keypoints"): Promise<void> {
  lesson.value = null;
  await change(changed);
  if (!page.found.value[stage]) await run(stage, page.stage.value);
}

const show = latestOnly(async (wanted: LessonStep) => {
  const posed = await ask("poseBody", { parameters: wanted.parameters }).catch(() => null);
  filmBody.value = posed?.positions ?? null;
});

effect(() => {
  if (step.value) show(step.value);
  else filmBody.value = null;
});

// What was found in one scan says nothing about the next.
effect(() => {
  if (page.found.value.keypoints) return;
  lesson.value = null;
});
