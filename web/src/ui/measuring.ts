// What the Measurements part of the results shows, as signals; only the functions here write them.
import { batch, computed, effect, signal } from "@preact/signals";
import type { Dimension, Figure, Measurements, Section } from "../core/measurements";
import { CoreError, type ResultData, type Vec3 } from "../core/types";
import { save } from "../result/download";
import { displayName } from "../result/format";
import { transformPoint } from "../result/transform";
import { measure, measuredFiles, profileOf } from "./actions";
import * as state from "./state";

/** The two halves of the results. */
export const half = signal<"distances" | "measurements">("distances");
export const measurements = signal<Measurements | null>(null);
/** Why there are no measurements, in the core's words. */
export const trouble = signal("");
/** The body that is looked at. */
export const figure = signal<Figure>("standing");
/** id of the dimension that is drawn */
export const selected = signal<string | null>(null);
/** A profile, and which of its sections is drawn. */
export const profile = signal<{ segment: string; sections: Section[]; at: number | null } | null>(null);

/** Sections of a profile. */
const PROFILE_SECTIONS = 61;

/** The result that was measured, or is being. */
let measured: ResultData | null = null;

/** Measures a result once, when its measurements are looked at. */
effect(() => {
  const result = state.result.value;
  if (result !== measured) {
    measured = null;
    batch(() => {
      measurements.value = null;
      profile.value = null;
      trouble.value = "";
    });
  }
  if (
    half.value !== "measurements" ||
    !result ||
    measured ||
    result.registration.verdict.status === "failed"
  ) {
    return;
  }
  measured = result;
  measure().then(
    (found) => {
      if (measured === result) measurements.value = found;
    },
    (error: unknown) => {
      if (measured === result) trouble.value = error instanceof CoreError ? error.message : String(error);
    },
  );
});

const looking = computed(
  () => half.value === "measurements" && state.stage.value === "results" && measurements.value !== null,
);

/** The dimensions taken on the chosen body. */
export const dimensions = computed<Dimension[]>(
  () => measurements.value?.dimensions.filter((each) => each.figure === figure.value) ?? [],
);

export const selectedDimension = computed(
  () => dimensions.value.find((each) => each.id === selected.value) ?? null,
);

const section = computed(() => {
  const { at, sections } = profile.value ?? { at: null, sections: [] };
  return at === null ? null : (sections[at] ?? null);
});

/** Whether the view holds the body re-posed instead of as scanned. */
const reposed = computed(() => looking.value && figure.value !== "scanned" && section.value === null);

/** The body in the 3D view; plain where something is to be drawn on it. */
export const shownBody = computed(() => {
  const body = state.shownBody.value;
  if (!body || !looking.value) return body;
  const { standing, seated } = measurements.value!;
  const mesh = !reposed.value ? body.mesh : figure.value === "sitting" ? seated : standing;
  return { mesh, errorsMm: null };
});

export const shownView = computed<state.ViewOptions>(() =>
  reposed.value
    ? { ...state.shownView.value, showScan: false, showBody: true, split: false, bodyOpacity: 1 }
    : state.shownView.value,
);

/** What is drawn on the body (body frame, metres) and the words beside it. */
export const drawn = computed<{ course: Vec3[]; text: string } | null>(() => {
  const matrix = state.result.value?.registration.alignment?.body_from_scan;
  if (!looking.value || !matrix) return null;
  const one = selectedDimension.value;
  const course = section.value?.course ?? one?.course;
  if (!course || course.length === 0) return null;
  const text = section.value
    ? `${displayName(section.value.segment)} at ${Math.round(100 * section.value.t)} %`
    : one
      ? `${title(one)} ${one.value_mm.toFixed(1)} mm`
      : "";
  return { course: course.map((corner) => transformPoint(matrix, corner)), text };
});

/** "Thigh girth, left" */
export function title(dimension: Dimension): string {
  return displayName(dimension.name) + (dimension.side ? `, ${dimension.side}` : "");
}

/** Draws a dimension, or none when it is drawn already. */
export function select(id: string): void {
  batch(() => {
    selected.value = selected.value === id ? null : id;
    if (profile.value) profile.value = { ...profile.value, at: null };
  });
}

export async function chooseSegment(segment: string): Promise<void> {
  profile.value = null;
  if (!segment) return;
  const result = state.result.peek();
  const sections = await profileOf(segment, PROFILE_SECTIONS);
  if (state.result.peek() === result) profile.value = { segment, sections, at: null };
}

/** Draws a section of the profile. */
export function showSection(at: number | null): void {
  if (profile.value && profile.value.at !== at) profile.value = { ...profile.value, at };
}

export async function downloadMeasured(format: string, name: string): Promise<void> {
  const file = (await measuredFiles(format)).find((each) => each.name === name);
  if (file) save(file.name, file.data);
}
