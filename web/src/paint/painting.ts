// What the user can do in the painter. Strokes are commands with undo; what they come to is one edit of the project.
import { batch } from "@preact/signals";
import type { RegionSet } from "../core/edits";
import { edited } from "../editor/state";
import { save, stem } from "../result/download";
import { displayName } from "../result/format";
import { askEditor } from "../ui/actions";
import { scan } from "../ui/state";
import * as work from "./labels";
import type { PaintCamera, Side, Stroke } from "./requests";
import * as state from "./state";

function fail(error: unknown): void {
  state.trouble.value = error instanceof Error ? error.message : String(error);
}

function changed(): void {
  state.revision.value += 1;
}

/** Takes a command that has been carried out on the labels. */
function push(command: work.Command): void {
  batch(() => {
    state.trouble.value = "";
    state.done.value = [...state.done.value, command];
    state.undone.value = [];
    if (command.pairs) setPairs(command.pairs.after);
    changed();
  });
}

function setPairs(pairs: readonly work.Pair[]): void {
  state.pairs.value = pairs;
  if (!pairs.some(({ id }) => id === state.selected.value)) state.selected.value = pairs.at(-1)?.id ?? 0;
}

/** The last stroke, once it is there. */
export async function undo(): Promise<void> {
  if (drawn) return;
  await settled();
  const command = state.done.value.at(-1);
  if (!command) return;
  batch(() => {
    work.undo(state.labels.value, command);
    state.done.value = state.done.value.slice(0, -1);
    state.undone.value = [command, ...state.undone.value];
    if (command.pairs) setPairs(command.pairs.before);
    changed();
  });
}

export async function redo(): Promise<void> {
  if (drawn) return;
  await settled();
  const command = state.undone.value[0];
  if (!command) return;
  batch(() => {
    work.redo(state.labels.value, command);
    state.done.value = [...state.done.value, command];
    state.undone.value = state.undone.value.slice(1);
    if (command.pairs) setPairs(command.pairs.after);
    changed();
  });
}

/** Forgets everything: another scan or body model. */
export function forget(): void {
  strokes = [];
  drawn = null;
  batch(() => {
    state.scanMesh.value = null;
    state.templateMesh.value = null;
    start(0, 0);
    state.given.value = null;
    state.trouble.value = "";
  });
}

function start(scanVertices: number, templateVertices: number): void {
  state.labels.value = work.emptyLabels(scanVertices, templateVertices);
  state.done.value = [];
  state.undone.value = [];
  setPairs([]);
  changed();
}

/** Shows scan and template as the edits leave them. The body must be posed. @throws CoreError */
export async function open(): Promise<void> {
  const scanMesh = await askEditor({ do: "paint_scan", crops: edited.value.crops });
  const templateMesh = await askEditor({ do: "paint_template", stance: state.stance.value });
  const { regions } = edited.value;
  batch(() => {
    const fits =
      state.scanMesh.value?.sha256 === scanMesh.sha256 &&
      state.templateMesh.value?.sha256 === templateMesh.sha256;
    state.scanMesh.value = scanMesh;
    state.templateMesh.value = templateMesh;
    state.trouble.value = "";
    // What was painted before is still there, unless the project says otherwise by now.
    if (fits && regions === state.given.value) return;
    start(scanMesh.vertices, templateMesh.vertices);
    if (regions) {
      const { pairs } = work.replaced([], state.labels.value, regions, "");
      setPairs(pairs!.after);
      changed();
    }
    state.given.value = regions;
  });
}

export async function setStance(stance: "posed" | "rest"): Promise<void> {
  try {
    const mesh = await askEditor({ do: "paint_template", stance });
    batch(() => {
      state.stance.value = stance;
      state.templateMesh.value = mesh;
    });
  } catch (error) {
    fail(error);
  }
}

/** What is painted, for the project and the registration; undefined: as they have it already. */
export function toHandOver(): RegionSet | null | undefined {
  const [scanMesh, templateMesh] = [state.scanMesh.value, state.templateMesh.value];
  if (!scanMesh || !templateMesh) return undefined;
  const hashes = { scan_sha256: scanMesh.sha256, model_sha256: templateMesh.sha256 };
  const regions = work.regionsOf(state.pairs.value, state.labels.value, hashes);
  if (JSON.stringify(regions) === JSON.stringify(state.given.value)) return undefined;
  state.given.value = regions;
  return regions;
}

/* ---- strokes: the core is asked one thing at a time; who paints faster is not kept waiting ---- */

interface Running {
  readonly work: work.Brushwork;
  readonly label: number;
  readonly title: string;
  readonly camera: PaintCamera;
  /** still to be asked */
  readonly requests: Stroke[];
  ended: boolean;
}
/** In the order in which they were begun; the first is at work. */
let strokes: Running[] = [];
/** The one that the pointer draws. */
let drawn: Running | null = null;
let working: Promise<void> | null = null;

/** A pair to paint: the chosen one, or the first. */
function target(): work.Pair {
  if (state.pairs.value.length === 0) addPair();
  const pairs = state.pairs.value;
  return pairs.find(({ id }) => id === state.selected.value) ?? pairs[0]!;
}

/** @param erase for this stroke, whatever is chosen */
function begin(side: Side, camera: PaintCamera, erase: boolean): Running {
  const wipes = erase || state.erasing.value;
  const pair = wipes ? null : target();
  const on = side === "scan" ? "the scan" : "the body";
  const begun: Running = {
    work: new work.Brushwork(state.labels.value, side),
    label: pair?.id ?? 0,
    title: pair ? `Paint ${pair.name} on ${on}` : `Erase on ${on}`,
    camera,
    requests: [],
    ended: false,
  };
  strokes.push(begun);
  return begun;
}

export function beginBrush(side: Side, camera: PaintCamera, erase: boolean): void {
  if (!drawn) drawn = begin(side, camera, erase);
}

export function brushTo(x: number, y: number): void {
  const radius = state.radius.value;
  const last = drawn?.requests.at(-1);
  // The way since the last question goes into one; the first of the list may be asked already.
  if (last?.with === "brush" && last.radius === radius && drawn!.requests.length > 1) last.way.push([x, y]);
  else drawn?.requests.push({ with: "brush", radius, way: [...(last?.way.slice(-1) ?? []), [x, y]] });
  workOn();
}

/** The stroke becomes a command. */
export function endBrush(): void {
  if (drawn) drawn.ended = true;
  drawn = null;
  workOn();
}

/** Two fingers turn the view: what the first one painted was not meant. */
export function abandon(): void {
  if (!drawn) return;
  drawn.work.abandon();
  strokes = strokes.filter((each) => each !== drawn);
  drawn = null;
  changed();
}

/** A stroke that is known at once. */
export function strokeAtOnce(side: Side, camera: PaintCamera, request: Stroke, erase: boolean): void {
  if (drawn) return;
  const begun = begin(side, camera, erase);
  begun.requests.push(request);
  begun.ended = true;
  workOn();
}

function workOn(): void {
  working ??= workAll().finally(() => {
    working = null;
  });
}

async function workAll(): Promise<void> {
  for (let first = strokes[0]; first; first = strokes[0]) {
    const request = first.requests[0];
    if (request) {
      await touch(first, request);
      first.requests.shift();
    } else if (first.ended) {
      strokes.shift();
      const change = first.work.change();
      if (change) push({ label: first.title, changes: [change] });
    } else return;
  }
}

async function touch(running: Running, request: Stroke): Promise<void> {
  try {
    const { side } = running.work;
    const { vertices } = await askEditor({ do: "paint_pick", side, camera: running.camera, ...request });
    if (!strokes.includes(running)) return;
    running.work.paint(vertices, running.label);
    changed();
  } catch (error) {
    fail(error);
  }
}

/** Resolves when every stroke has become a command. */
export async function settled(): Promise<void> {
  while (working) await working;
}

/* ---- pairs ---- */

export function addPair(name?: string): void {
  const { value: before } = state.pairs;
  const id = work.nextId(before);
  if (id > work.MOST_PAIRS) return;
  const after = [...before, { id, name: name ?? `Region ${id}` }];
  push({ label: `Add ${after.at(-1)!.name}`, pairs: { before, after }, changes: [] });
  state.selected.value = id;
}

export function rename(id: number, name: string): void {
  const before = state.pairs.value;
  const old = before.find((pair) => pair.id === id);
  if (!old || !name || old.name === name) return;
  const after = before.map((pair) => (pair.id === id ? { id, name } : pair));
  push({ label: `Rename ${old.name} to ${name}`, pairs: { before, after }, changes: [] });
}

export function remove(id: number): void {
  const before = state.pairs.value;
  const name = before.find((pair) => pair.id === id)?.name;
  if (name === undefined || strokes.length > 0) return;
  const changes = work.SIDES.flatMap((side) => {
    const brush = new work.Brushwork(state.labels.value, side);
    brush.paint(work.verticesOf(state.labels.value, side, id), 0);
    return brush.change() ?? [];
  });
  const after = before.filter((pair) => pair.id !== id);
  push({ label: `Remove ${name}`, pairs: { before, after }, changes });
}

export function choose(step: number): void {
  const pairs = state.pairs.value;
  const at = pairs.findIndex(({ id }) => id === state.selected.value);
  const next = pairs[(at + step + pairs.length) % pairs.length];
  if (next) state.selected.value = next.id;
}

/** Pairs of the body's segments, of what is not painted yet. @param only one of them */
export async function suggest(only?: string): Promise<void> {
  await settled();
  try {
    const { names, scan, template } = await askEditor({ do: "paint_suggest" });
    const titles = names.map(displayName);
    const wanted = [...names.keys()].filter((i) => only === undefined || names[i] === only);
    const label = only ? `Suggest ${displayName(only)}` : "Suggest from the segments";
    push(work.suggested(state.pairs.value, state.labels.value, { scan, template }, titles, wanted, label));
  } catch (error) {
    fail(error);
  }
}

/* ---- files ---- */

export function exportFile(): void {
  const [scanMesh, templateMesh] = [state.scanMesh.value, state.templateMesh.value];
  if (!scanMesh || !templateMesh) return;
  const hashes = { scan_sha256: scanMesh.sha256, model_sha256: templateMesh.sha256 };
  const regions = work.regionsOf(state.pairs.value, state.labels.value, hashes);
  if (!regions) return;
  save(`${stem(scan.value?.file ?? "scan")}.regions.json`, new Blob([`${JSON.stringify(regions)}\n`]));
}

export async function importFile(file: File): Promise<void> {
  await settled();
  try {
    const { regions } = await askEditor({ do: "import_regions", text: await file.text(), name: file.name });
    push(work.replaced(state.pairs.value, state.labels.value, regions, `From ${file.name}`));
  } catch (error) {
    fail(error);
  }
}
