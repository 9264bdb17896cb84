// What the user can do in the editor. Every change is an edit that can be undone, saved and replayed.
import { batch, effect, untracked } from "@preact/signals";
import type { Crop, KeypointSet } from "../core/edits";
import { CoreError, type CoreStage, type Matrix, type Vec3 } from "../core/types";
import * as painting from "../paint/painting";
import { save, stem } from "../result/download";
import { displayName } from "../result/format";
import { askEditor, change, register, run } from "../ui/actions";
import * as page from "../ui/state";
import { EMPTY, edits, made, redone, type Step, undone } from "./history";
import type { Edit, EditorRequest, JointChanges } from "./requests";
import { type Joint, limbOf } from "./skeleton";
import * as state from "./state";

/** Vertices of the scan while something is dragged. */
const COARSE = 5000;
/** Label of the edit that takes the found keypoints over. */
const FOUND = "As found";

/** What each tool starts from. */
const NEEDED: Record<state.Tool, CoreStage> = {
  joints: "keypoints",
  align: "align",
  cut: "align",
  paint: "pose",
};

function fail(error: unknown): void {
  if (error instanceof CoreError && error.code === "cancelled") return;
  state.trouble.value = error instanceof Error ? error.message : String(error);
}

function push(step: Step): void {
  batch(() => {
    state.trouble.value = "";
    state.history.value = made(state.history.value, step);
  });
}

export function undo(): void {
  state.history.value = undone(state.history.value);
}

export function redo(): void {
  state.history.value = redone(state.history.value);
}

/** Forgets everything: another scan was opened. */
export function forget(): void {
  batch(() => {
    state.tool.value = null;
    state.history.value = EMPTY;
    state.base.value = null;
    state.preview.value = null;
    state.rest.value = null;
    state.coarse.value = null;
    state.dragged.value = null;
    state.trouble.value = "";
    painting.forget();
  });
}

effect(() => {
  if (page.scan.value === null) untracked(forget);
});

export async function open(tool: state.Tool): Promise<void> {
  const needed = NEEDED[tool];
  try {
    await painting.settled();
    takePainting();
    if (!state.base.value || (tool === "joints" && state.base.value.found.length === 0)) {
      if (state.base.value) await apply();
      if (!page.found.value[needed]) await run(needed, page.stage.value);
      const { align, keypoints } = page.found.value;
      if (!align || (tool === "joints" && !keypoints)) return;
      state.base.value = { body_from_scan: align.body_from_scan, found: keypoints?.joints ?? [] };
    }
    if (tool === "joints" && !state.edited.value.keypoints) {
      const { body_from_scan } = state.base.value;
      const { keypoints } = await askEditor({ do: "found_keypoints", body_from_scan });
      push({ edit: "keypoints", keypoints, label: FOUND });
    }
    if (tool === "paint") {
      await apply();
      if (!page.found.value.pose) await run("pose", page.stage.value);
      if (!page.found.value.pose) return;
      await painting.open();
    }
    state.tool.value = tool;
  } catch (error) {
    fail(error);
  }
}

export function close(): void {
  takePainting();
  state.tool.value = null;
}

/** What was painted becomes one edit. */
function takePainting(): void {
  if (state.tool.value !== "paint") return;
  const regions = painting.toHandOver();
  if (regions === undefined) return;
  const count = regions?.pairs.length ?? 0;
  const label = count === 0 ? "No regions" : count === 1 ? "Paint 1 region" : `Paint ${count} regions`;
  push({ edit: "regions", regions, label });
}

/** Joints that were placed by hand. */
export function touched(): ReadonlySet<string> {
  let names = new Set<string>();
  for (const edit of state.history.value.done) {
    if (edit.edit === "joints") for (const name of Object.keys(edit.joints)) names.add(name);
    if (edit.edit === "keypoints")
      names = new Set(edit.label === FOUND ? [] : Object.keys(edit.keypoints?.joints ?? {}));
  }
  return names;
}

/** Edits that change something: keypoints as they were found are left to be found again. */
function effective(): Edit[] {
  const all = edits(state.history.value.done);
  return touched().size > 0 ? all : all.filter(({ edit }) => edit !== "keypoints" && edit !== "joints");
}

/** Hands the edits to the registration; stages that they change become out of date. */
export async function apply(): Promise<void> {
  const { body_from_scan, crops, keypoints, regions } = state.edited.value;
  const settings = page.settings.value;
  const wanted = {
    body_from_scan,
    crops: crops.length > 0 ? crops : null,
    keypoints: touched().size > 0 ? keypoints : null,
    regions,
  };
  const had = {
    body_from_scan: settings.body_from_scan ?? null,
    crops: settings.crops ?? null,
    keypoints: settings.keypoints ?? null,
    regions: settings.regions ?? null,
  };
  // A transform says units, up and front itself.
  const placed = body_from_scan ? ({ units: "auto", up: "auto", front: "auto" } as const) : {};
  if (JSON.stringify(wanted) === JSON.stringify(had)) return;
  await change({ ...wanted, ...placed });
}

export async function registerEdited(): Promise<void> {
  await painting.settled();
  close();
  await apply();
  await register();
}

/* ---- the live preview: one question at a time, the latest wins ---- */

type PreviewRequest = Extract<EditorRequest, { do: "preview" }>;
let asking: Promise<void> | null = null;
let next: PreviewRequest | null = null;
let times: number[] = [];

function ask(request: PreviewRequest): void {
  next = request;
  asking ??= answerAll().finally(() => {
    asking = null;
  });
}

async function answerAll(): Promise<void> {
  while (next) {
    const request = next;
    next = null;
    try {
      const asked = performance.now();
      const answer = await askEditor(request);
      const now = performance.now();
      times = [...times.filter((time) => now - time < 1000), now];
      batch(() => {
        state.preview.value = {
          body: answer.body,
          joints: answer.joints,
          errorMm: answer.error_mm,
          rate: times.length,
          workMs: answer.work_ms,
          answerMs: now - asked,
        };
        if (request.sight && answer.moved && state.dragged.value)
          state.dragged.value = moved(request.sight.joint as Joint, answer.moved, state.dragged.value);
      });
    } catch (error) {
      fail(error);
      return;
    }
  }
}

/** Poses the body by the keypoints as they are. @param anew from the start */
export function refresh(anew = false): void {
  const body_from_scan = state.bodyFromScan.value;
  const keypoints = state.edited.value.keypoints;
  if (!body_from_scan || !keypoints || page.busy.value) return;
  ask({ do: "preview", keypoints, body_from_scan, ...(anew ? { anew } : {}) });
}

/* ---- joints ---- */

/** A joint at a place, its limb with it when limbs move as a whole. */
function moved(joint: Joint, position: Vec3, keypoints: KeypointSet): KeypointSet {
  const before = keypoints.joints[joint]?.position;
  const joints = { ...keypoints.joints, [joint]: { position, confidence: 1 } };
  if (state.wholeLimb.value && before) {
    for (const name of limbOf(joint)) {
      const other = keypoints.joints[name];
      if (name === joint || !other || state.locked.value.has(name)) continue;
      const [x, y, z] = other.position;
      const shifted: Vec3 = [
        x + position[0] - before[0],
        y + position[1] - before[1],
        z + position[2] - before[2],
      ];
      joints[name] = { position: shifted, confidence: 1 };
    }
  }
  return { frame: "scan", joints };
}

/** @param sight line of sight through the pointer, scan frame; null: the joint stays where it is put */
export function drag(joint: Joint, position: Vec3, sight: { origin: Vec3; direction: Vec3 } | null): void {
  const body_from_scan = state.bodyFromScan.value;
  const keypoints = state.keypoints.value;
  if (!body_from_scan || !keypoints || state.locked.value.has(joint)) return;
  state.dragged.value = moved(joint, position, keypoints);
  ask({
    do: "preview",
    keypoints: state.dragged.value,
    body_from_scan,
    ...(sight && state.snaps.value ? { sight: { joint, ...sight } } : {}),
  });
}

/** The drag becomes an edit. */
export async function drop(joint: Joint): Promise<void> {
  await asking;
  const before = state.edited.value.keypoints;
  const after = state.dragged.value;
  if (!before || !after) return;
  const joints: JointChanges = {};
  for (const [name, placed] of Object.entries(after.joints))
    if (placed !== before.joints[name]) joints[name] = placed;
  batch(() => {
    state.dragged.value = null;
    if (Object.keys(joints).length > 0)
      push({ edit: "joints", joints, label: `Move ${displayName(joint).toLowerCase()}` });
  });
  refresh();
}

export async function sides(from?: "left" | "right"): Promise<void> {
  const keypoints = state.edited.value.keypoints;
  if (!keypoints) return;
  try {
    const request = { do: "sides" as const, keypoints, locked: [...state.locked.value] };
    const { joints } = await askEditor(from ? { ...request, from } : request);
    const label = from ? `Mirror the ${from} side` : "Swap left and right";
    if (Object.keys(joints).length > 0) push({ edit: "joints", joints, label });
    refresh(true);
  } catch (error) {
    fail(error);
  }
}

function foundSet(): KeypointSet | null {
  const edit = state.history.value.done.find((each) => each.edit === "keypoints");
  return edit?.edit === "keypoints" ? edit.keypoints : null;
}

/** @param joint all of them when it is not given */
export function reset(joint?: Joint): void {
  const found = foundSet();
  if (joint) {
    const label = `Reset ${displayName(joint).toLowerCase()}`;
    push({ edit: "joints", joints: { [joint]: found?.joints[joint] ?? null }, label });
  } else {
    push({ edit: "keypoints", keypoints: found, label: FOUND });
  }
  refresh(true);
}

export function leaveOut(joint: Joint): void {
  push({ edit: "joints", joints: { [joint]: null }, label: `Leave ${displayName(joint).toLowerCase()} out` });
  refresh();
}

export function lock(joint: Joint): void {
  const locked = !state.locked.value.has(joint);
  push({
    edit: "lock",
    joint,
    locked,
    label: `${locked ? "Lock" : "Unlock"} ${displayName(joint).toLowerCase()}`,
  });
}

/* ---- how the scan lies, and what is cut away ---- */

export function align(body_from_scan: Matrix | null, label: string): void {
  push({ edit: "align", body_from_scan, label });
}

export function cut(crop: Crop): void {
  push({ edit: "crop", ...crop, label: crop.remove === "inside" ? "Cut away" : "Keep only" });
}

/** Draws the scan as the crops leave it. */
export async function showRest(): Promise<void> {
  const { crops } = state.edited.value;
  try {
    const rest = crops.length > 0 ? (await askEditor({ do: "cut", crops })).mesh : null;
    const coarse = (await askEditor({ do: "cut", crops, most_vertices: COARSE })).mesh;
    batch(() => {
      state.rest.value = rest;
      state.coarse.value = coarse;
    });
  } catch (error) {
    fail(error);
  }
}

/* ---- files ---- */

const text = (data: unknown) => new Blob([`${JSON.stringify(data, null, 1)}\n`]);
const name = () => stem(page.scan.value?.file ?? "scan");

export function exportKeypoints(): void {
  if (state.edited.value.keypoints) save(`${name()}.keypoints.json`, text(state.edited.value.keypoints));
}

export function exportAlignment(): void {
  if (state.bodyFromScan.value)
    save(`${name()}.alignment.json`, text({ body_from_scan: state.bodyFromScan.value }));
}

export async function importKeypoints(file: File): Promise<void> {
  const body_from_scan = state.bodyFromScan.value;
  if (!body_from_scan) return;
  try {
    const request = { text: await file.text(), name: file.name, body_from_scan };
    const { keypoints } = await askEditor({ do: "import_keypoints", ...request });
    push({ edit: "keypoints", keypoints, label: `From ${file.name}` });
    refresh(true);
  } catch (error) {
    fail(error);
  }
}

export async function saveProject(): Promise<void> {
  try {
    await painting.settled();
    takePainting();
    await apply();
    const { text } = await askEditor({ do: "save_project", edits: effective() });
    save(`${name()}.project.json`, new Blob([text]));
  } catch (error) {
    fail(error);
  }
}

export async function openProject(file: File): Promise<void> {
  try {
    const project = await askEditor({ do: "open_project", text: await file.text(), name: file.name });
    forget();
    await change(project.settings);
    state.history.value = { done: project.edits, undone: [] };
    await apply();
  } catch (error) {
    fail(error);
  }
}
