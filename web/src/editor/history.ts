// Edits with undo and redo: the list that was made is the project, what was undone waits.
import type { Crop, KeypointSet, RegionSet } from "../core/edits";
import type { Matrix } from "../core/types";
import type { Edit } from "./requests";

export interface History {
  readonly done: readonly Edit[];
  readonly undone: readonly Edit[];
}

export const EMPTY: History = { done: [], undone: [] };

export function made({ done }: History, edit: Edit): History {
  return { done: [...done, edit], undone: [] };
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
}

/** The same as with_edits() of core/editor/project.h. */
export function folded(edits: readonly Edit[]): Edited {
  const result: Edited = { body_from_scan: null, crops: [], keypoints: null, regions: null };
  for (const edit of edits) {
    if (edit.edit === "align") result.body_from_scan = edit.body_from_scan;
    else if (edit.edit === "crop") result.crops.push(cropOf(edit));
    else if (edit.edit === "keypoints") result.keypoints = edit.keypoints;
    else if (edit.edit === "regions") result.regions = edit.regions;
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
