// Edits with undo and redo: the list that was made is the project, what was undone waits.
import type { Crop, KeypointSet, RegionSet } from "../core/edits";
import type { Matrix } from "../core/types";
import type { Edit } from "./requests";

/** Locks a joint in its place, or frees it: undone like an edit, but nothing that a project replays. */
export interface Lock {
  edit: "lock";
  joint: string;
  locked: boolean;
  label?: string;
}
export type Step = Edit | Lock;

export interface History {
  readonly done: readonly Step[];
  readonly undone: readonly Step[];
}

export const EMPTY: History = { done: [], undone: [] };

export function made({ done }: History, step: Step): History {
  return { done: [...done, step], undone: [] };
}

export function undone({ done, undone }: History): History {
  const last = done.at(-1);
  return last ? { done: done.slice(0, -1), undone: [last, ...undone] } : { done, undone };
}

export function redone({ done, undone }: History): History {
  const next = undone[0];
  return next ? { done: [...done, next], undone: undone.slice(1) } : { done, undone };
}

/** What a list of edits comes to. */
export interface Edited {
  body_from_scan: Matrix | null;
  crops: Crop[];
  keypoints: KeypointSet | null;
  regions: RegionSet | null;
  locked: ReadonlySet<string>;
}

/** What a project holds. */
export function edits(steps: readonly Step[]): Edit[] {
  return steps.filter((step): step is Edit => step.edit !== "lock");
}

/** The same as with_edits() of core/editor/project.h, and the locks. */
export function folded(steps: readonly Step[]): Edited {
  const locked = new Set<string>();
  const result: Edited = { body_from_scan: null, crops: [], keypoints: null, regions: null, locked };
  for (const edit of steps) {
    if (edit.edit === "align") result.body_from_scan = edit.body_from_scan;
    else if (edit.edit === "crop") result.crops.push(cropOf(edit));
    else if (edit.edit === "keypoints") result.keypoints = edit.keypoints;
    else if (edit.edit === "regions") result.regions = edit.regions;
    else if (edit.edit === "lock") edit.locked ? locked.add(edit.joint) : locked.delete(edit.joint);
    else {
      const joints = { ...result.keypoints?.joints };
      for (const [name, joint] of Object.entries(edit.joints)) {
        if (joint) joints[name] = joint;
        else delete joints[name];
      }
      result.keypoints = { frame: "scan", joints };
    }
  }
  return result;
}

function cropOf(edit: Extract<Edit, { edit: "crop" }>): Crop {
  const { edit: _kind, label: _label, ...crop } = edit;
  return crop as Crop;
}
