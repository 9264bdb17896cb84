// The body posed by hand. The core poses it; of requests that pile up only the latest is made.
import { effect, signal } from "@preact/signals";
import type { BodyDescription, BodyParameters, PosedBody } from "../core/teaching";
import { CoreError, type Gender, type Vec3 } from "../core/types";
import { ask } from "../ui/actions";

export const body = signal<BodyDescription | null>(null);
export const gender = signal<Gender>("neutral");
/** in standard deviations from the mean of the chosen gender */
export const shape = signal<readonly number[]>([]);
/** axis-angle of each joint */
export const turns = signal<readonly Vec3[]>([]);
export const posed = signal<PosedBody | null>(null);
export const problem = signal<CoreError | null>(null);

const REST: Vec3 = [0, 0, 0];

/** Calls with the latest argument, one call at a time. */
export function latestOnly<T>(call: (value: T) => Promise<void>): (value: T) => void {
  let next: { value: T } | null = null;
  let working = false;
  return async (value) => {
    next = { value };
    if (working) return;
    working = true;
    while (next) {
      const { value: now }: { value: T } = next;
      next = null;
      await call(now);
    }
    working = false;
  };
}

async function guarded(work: () => Promise<void>): Promise<void> {
  try {
    await work();
    problem.value = null;
  } catch (error) {
    problem.value = error instanceof CoreError ? error : new CoreError("internal", String(error));
  }
}

export function loadBody(): Promise<void> {
  return guarded(async () => {
    const description = await ask("body", {});
    body.value = description;
    if (turns.value.length !== description.joints.length) resetPose();
    if (shape.value.length !== description.shape.neutral.mean.length) resetShape();
  });
}

export function resetShape(): void {
  shape.value = body.value?.shape[gender.value].mean.map(() => 0) ?? [];
}

export function resetPose(): void {
  turns.value = body.value?.joints.map(() => REST) ?? [];
}

export function setShape(component: number, deviations: number): void {
  shape.value = shape.value.map((old, k) => (k === component ? deviations : old));
}

export function setTurn(joint: number, axis: number, radians: number): void {
  turns.value = turns.value.map((turn, j) =>
    j === joint ? (turn.map((old, a) => (a === axis ? radians : old)) as unknown as Vec3) : turn,
  );
}

function parameters(description: BodyDescription): BodyParameters {
  const { mean, deviation } = description.shape[gender.value];
  return {
    betas: mean.map((value, k) => value + (shape.value[k] ?? 0) * deviation[k]!),
    pose: turns.value.flat(),
    translation_m: [0, 0, 0],
  };
}

const pose = latestOnly((wanted: BodyParameters) =>
  guarded(async () => {
    posed.value = await ask("poseBody", { parameters: wanted });
  }),
);

effect(() => {
  const description = body.value;
  if (description && turns.value.length === description.joints.length) pose(parameters(description));
});
