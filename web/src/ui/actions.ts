// What the user can do. Each action leaves the state consistent, whether it ends, fails or is cancelled.
import { batch } from "@preact/signals";
import { CoreClient } from "../core/client";
import { isolated, offlineReady } from "../core/isolation";
import { CoreError, type OutputFile, type Settings, type Stage } from "../core/types";
import { save, zipped } from "../result/download";
import * as state from "./state";

/** Time that a run has to obey a cancel before its worker is ended. */
const CANCEL_GRACE_MS = 150;
const MAX_THREADS = 8;

const client = new CoreClient(
  () => new Worker(new URL("../worker/core.worker.ts", import.meta.url), { type: "module", name: "core" }),
);
client.onProgress = (progress) => {
  state.progress.value = progress;
};

let opened: { file: Blob; name: string } | null = null;
/** Whether the worker alive holds the scan. */
let scanIsInCore = false;

export function threadsWanted(): number {
  if (!isolated() || new URLSearchParams(location.search).get("threads") === "1") return 1;
  return Math.min(navigator.hardwareConcurrency || 2, MAX_THREADS);
}

async function ensureCore(): Promise<void> {
  if (client.alive && state.core.value) return;
  scanIsInCore = false;
  await offlineReady();
  state.core.value = await client.call("start", { base: document.baseURI, threads: threadsWanted() });
}

/** Puts the opened file into a worker that does not hold it (yet, or any more). */
async function ensureScan(): Promise<void> {
  await ensureCore();
  if (scanIsInCore || !opened) return;
  state.scan.value = await client.call("open", opened);
  scanIsInCore = true;
}

/** Runs `work` as the stage's; keeps busy, progress and problem right. */
async function working(stage: Stage, work: () => Promise<void>): Promise<void> {
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
    state.problem.value = { stage, error: known };
  } finally {
    batch(() => {
      state.busy.value = null;
      state.progress.value = null;
    });
  }
}

export async function openFile(file: Blob, name: string): Promise<void> {
  if (state.busy.value) return;
  batch(() => {
    state.scan.value = null;
    state.result.value = null;
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

/** Registers the opened scan and shows the result. */
export async function register(show: Stage = "results"): Promise<void> {
  if (!state.scan.value) return;
  state.result.value = null;
  await working("register", async () => {
    await ensureScan();
    state.result.value = await client.call("run", { settings: state.settings.value });
    state.stage.value = show;
  });
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
  }, grace);
}

/** Changes settings. A result that they would change is found anew, the stage on show stays. */
export function change(settings: Partial<Settings>): void {
  if (state.busy.value) return;
  state.settings.value = { ...state.settings.value, ...settings };
  if (state.result.value) void register(state.stage.value);
}

async function files(): Promise<OutputFile[]> {
  return client.call("files", { format: "ply" });
}

export async function download(name: string): Promise<void> {
  const file = (await files()).find((each) => each.name === name);
  if (file) save(file.name, file.data);
}

export async function downloadAll(): Promise<void> {
  const scan = state.result.value?.registration.scan.file ?? "scan";
  const zip = await zipped(scan, await files());
  save(zip.name, zip.data);
}

/** Bytes that the core holds, for tests and the About box. */
export function memory(): Promise<{ heap: number }> {
  return client.call("memory", {});
}
