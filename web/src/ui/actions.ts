// What the user can do. Each action leaves the state consistent, whether it ends, fails or is cancelled.
import { batch } from "@preact/signals";
import { CoreClient } from "../core/client";
import { isolated, offlineReady } from "../core/isolation";
import type { Measurements, Section } from "../core/measurements";
import type { Calls, Kind } from "../core/messages";
import {
  CoreError,
  type CoreStage,
  kCoreStages,
  type OutputFile,
  type Settings,
  type Stage,
} from "../core/types";
import type { AnswerTo, EditorRequest } from "../editor/requests";
import * as own from "../models/own";
import { save, zipped } from "../result/download";
import * as energy from "./energy";
import * as state from "./state";

/** Time that a run has to obey a cancel before its worker is ended. */
const CANCEL_GRACE_MS = 120;
const MAX_THREADS = 8;

const client = new CoreClient(
  () => new Worker(new URL("../worker/core.worker.ts", import.meta.url), { type: "module", name: "core" }),
);
client.onProgress = (progress) => {
  state.progress.value = progress;
  if (progress.energies) energy.add(progress.energies);
};

let opened: { file: Blob; name: string } | null = null;
/** Whether the worker alive holds the scan. */
let scanIsInCore = false;

export function threadsWanted(): number {
  if (!isolated()) return 1;
  // ?threads=N, for measuring and for machines that should keep cores for something else.
  const limit = Number(new URLSearchParams(location.search).get("threads")) || MAX_THREADS;
  return Math.max(1, Math.min(navigator.hardwareConcurrency || 2, MAX_THREADS, limit));
}

async function ensureCore(): Promise<void> {
  if (client.alive && state.core.value) return;
  scanIsInCore = false;
  await offlineReady();
  state.core.value = await client.call("start", { base: document.baseURI, threads: threadsWanted() });
  await own.sendAgain(client);
}

/** Puts the opened file into a worker that does not hold it (yet, or any more). */
async function ensureScan(): Promise<void> {
  await ensureCore();
  if (scanIsInCore || !opened) return;
  const scan = await client.call("open", opened);
  scanIsInCore = true;
  await configure();
  // Shown only now: who sees it may ask for the next thing at once.
  state.scan.value = scan;
}

/** Hands the settings to the core; what they make wrong is dropped and marked as stale. */
async function configure(): Promise<void> {
  const holding = await client.call("configure", { settings: state.settings.value });
  keep(kCoreStages.slice(0, holding));
}

/** Drops the findings of the stages that do not hold any more. */
function keep(holding: readonly CoreStage[]): void {
  const dropped = kCoreStages.filter((name) => state.found.value[name] && !holding.includes(name));
  if (dropped.length === 0) return;
  batch(() => {
    const kept = holding.map((name) => [name, state.found.value[name]]);
    state.found.value = { ...state.NOTHING, ...Object.fromEntries(kept) };
    state.stale.value = new Set([...state.stale.value, ...dropped]);
  });
}

function dropAll(): void {
  batch(() => {
    state.found.value = state.NOTHING;
    state.stale.value = new Set();
  });
}

/** Settings on their way to the core, and what they ask for at once: short, so that what is asked for meanwhile waits. */
let settling: Promise<void> = Promise.resolve();

/** Runs `work` as the stage's, after settings that are on their way; keeps busy, progress and problem right. */
async function working(stage: Stage, work: () => Promise<void>): Promise<void> {
  await settling;
  await occupied(stage, work);
}

async function occupied(stage: Stage, work: () => Promise<void>): Promise<void> {
  if (state.busy.value) return;
  batch(() => {
    state.busy.value = { stage, since: performance.now() };
    state.progress.value = null;
    state.problem.value = null;
  });
  try {
    await work();
  } catch (error) {
    const known = error instanceof CoreError ? error : new CoreError("internal", String(error));
    if (!client.alive) state.core.value = null;
    // Next to where it happened; a stop, where the user is.
    const at = known.code === "cancelled" ? state.stage.peek() : (state.stageAtWork.peek() ?? stage);
    state.problem.value = { stage: at, error: known };
  } finally {
    batch(() => {
      state.busy.value = null;
      state.progress.value = null;
    });
  }
}

/** Does something with the core as work of a stage; what it makes wrong of the findings is dropped. */
export async function withCore(stage: Stage, work: (client: CoreClient) => Promise<void>): Promise<void> {
  await working(stage, async () => {
    await ensureCore();
    await work(client);
    if (scanIsInCore) await configure();
  });
}

export async function openFile(file: Blob, name: string): Promise<void> {
  if (state.busy.value) return;
  batch(() => {
    state.scan.value = null;
    // What was done by hand belongs to the scan before.
    const edits = { body_from_scan: null, crops: null, keypoints: null, regions: null };
    state.settings.value = { ...state.settings.value, ...edits };
    dropAll();
    state.stage.value = "scan";
  });
  scanIsInCore = false;
  opened = null;
  await working("scan", async () => {
    opened = { file, name };
    await ensureScan();
  });
  if (!state.scan.value) opened = null;
}

export async function openSample(): Promise<void> {
  if (state.busy.value) return;
  let sample: Blob | null = null;
  await working("scan", async () => {
    const response = await fetch(new URL("models/sample.ply", document.baseURI)).catch(() => null);
    if (!response?.ok) throw new CoreError("network", "models/sample.ply could not be loaded");
    sample = await response.blob();
  });
  if (sample) await openFile(sample, "sample.ply");
}

/** Works the opened scan up to a stage, and shows it. What is there already is not worked again, but for the stage itself. */
export async function run(until: CoreStage, show: Stage = until): Promise<void> {
  if (state.scan.value) await working(until, () => workUp(until, show));
}

async function workUp(until: CoreStage, show: Stage): Promise<void> {
  await ensureScan();
  const again = state.found.value[until] !== null;
  if (again) keep(kCoreStages.slice(0, kCoreStages.indexOf(until)));
  energy.clear();
  const found = await client.call("run", { until, again });
  batch(() => {
    state.found.value = found;
    state.stale.value = new Set([...state.stale.value].filter((name) => !found[name]));
    state.stage.value = show;
  });
}

/** Registers the opened scan and shows the result. */
export function register(): Promise<void> {
  return run("register", "results");
}

/**
 * Lends the core to other work than the main view's. Unless they are kept, the view's findings are out of date
 * afterwards. @throws what `work` throws, CoreError(internal) when the core is at work.
 */
export async function borrowCore<T>(
  work: (client: CoreClient) => Promise<T>,
  findings: "drop" | "keep" = "drop",
): Promise<T> {
  if (state.busy.value) throw new CoreError("internal", "the core is at work");
  batch(() => {
    state.busy.value = { stage: "register", since: performance.now() };
    state.progress.value = null;
  });
  try {
    await ensureCore();
    if (findings === "drop") {
      scanIsInCore = false;
      keep([]);
    }
    return await work(client);
  } catch (error) {
    // What is left of a core without memory would fail the next scan too.
    if (error instanceof CoreError && error.code === "out_of_memory") client.end();
    if (!client.alive) state.core.value = null;
    throw error;
  } finally {
    batch(() => {
      state.busy.value = null;
      state.progress.value = null;
    });
  }
}

/** Asks the core for something that it can tell at any time. @throws CoreError */
export async function ask<K extends Kind>(kind: K, args: Calls[K]["args"]): Promise<Calls[K]["result"]> {
  await ensureCore();
  return client.call(kind, args);
}

/** Asks the core one of the editors' questions about the opened scan. @throws CoreError */
export async function askEditor<R extends EditorRequest>(request: R): Promise<AnswerTo<R>> {
  await ensureScan();
  return (await client.call("edit", { request })) as AnswerTo<R>;
}

export function cancel(): void {
  if (!state.busy.value || !client.alive) return;
  const since = state.busy.value.since;
  if (threadsWanted() > 1) void client.call("cancel", {}).catch(() => {});
  const grace = threadsWanted() > 1 ? CANCEL_GRACE_MS : 0;
  setTimeout(() => {
    if (state.busy.value?.since !== since) return;
    client.end();
    state.core.value = null;
    scanIsInCore = false;
    keep([]);
  }, grace);
}

/** Changes settings. What they make wrong is dropped; a changed alignment is found anew at once, to be looked at. */
export async function change(settings: Partial<Settings>): Promise<void> {
  if (state.busy.value) return;
  state.settings.value = { ...state.settings.value, ...settings };
  if (!scanIsInCore) return;
  const aligned = state.found.value.align !== null;
  const stage = state.stage.value;
  settling = settling.then(async () => {
    await occupied(stage, configure);
    if (aligned && !state.found.value.align && !state.problem.value) {
      await occupied("align", () => workUp("align", state.stage.value));
    }
  });
  await settling;
}

const MESH_FORMATS = ["ply", "obj", "glb"] as const;

/** What the command line writes with `--format format`. */
async function files(format: (typeof MESH_FORMATS)[number] = "ply"): Promise<OutputFile[]> {
  return client.call("files", { format });
}

export async function download(name: string): Promise<void> {
  const format = MESH_FORMATS.find((each) => name.endsWith(`.${each}`));
  const file = (await files(format)).find((each) => each.name === name);
  if (file) save(file.name, file.data);
}

export async function downloadAll(): Promise<void> {
  const scan = state.result.value?.registration.scan.file ?? "scan";
  const failed = state.result.value?.registration.verdict.status === "failed";
  const zip = await zipped(scan, [...(await files()), ...(failed ? [] : await measuredFiles("all"))]);
  save(zip.name, zip.data);
}

/** Measures the result. @throws CoreError */
export function measure(): Promise<Measurements> {
  return client.call("measure", {});
}

export function profileOf(segment: string, count: number): Promise<Section[]> {
  return client.call("profile", { segment, count });
}

/** What `vitruvian measure` writes; see Calls. */
export function measuredFiles(format: string): Promise<OutputFile[]> {
  return client.call("measuredFiles", { format });
}

/** Bytes of memory that the core has, and uses; null when it was not started. */
export async function memory(): Promise<{ heap: number; inUse: number } | null> {
  if (!client.alive) return null;
  return client.call("memory", {});
}
