// Works the queue, one scan after the other, with the page's one core.
import { effect } from "@preact/signals";
import type { CoreClient } from "../core/client";
import { CoreError, type ResultData, type Settings } from "../core/types";
import { borrowCore, change, openFile, run } from "../ui/actions";
import { mode } from "../ui/mode";
import * as page from "../ui/state";
import { outcomeOf } from "./outcome";
import type { Pictures } from "./picture";
import * as queue from "./queue";
import { keepItem } from "./store";

let pictures: Promise<Pictures | null> | null = null;

/** null where the browser has no WebGL: the batch works without pictures. */
function thePictures(): Promise<Pictures | null> {
  pictures ??= import("./picture").then(({ createPictures }) => createPictures()).catch(() => null);
  return pictures;
}

async function show(id: number, draw: (pictures: Pictures) => Promise<Blob>): Promise<void> {
  const available = await thePictures();
  const picture = available && (await draw(available).catch(() => null));
  if (picture) queue.setPicture(id, picture);
}

/** Resolves when nothing else uses the core. */
function coreIsFree(): Promise<void> {
  return new Promise((resolve) => {
    let stop = () => {};
    stop = effect(() => {
      if (page.busy.value) return;
      resolve();
      queueMicrotask(() => stop());
    });
  });
}

/** Works until nothing waits or pause() is called. A scan that fails does not stop the rest. */
export async function start(): Promise<void> {
  if (queue.running.value) return;
  queue.running.value = true;
  while (queue.running.value) {
    await coreIsFree();
    const next = queue.items.value.find(({ status, file }) => status === "waiting" && file !== null);
    if (!next || !queue.running.value) break;
    await work(next);
  }
  queue.running.value = false;
}

/** No further scan is begun; the one at work ends. */
export function pause(): void {
  queue.running.value = false;
}

async function work(item: queue.Item): Promise<void> {
  queue.update(item.id, { status: "working", error: null, outcome: null });
  try {
    await borrowCore((client) => register(client, item));
  } catch (error) {
    const known = error instanceof CoreError ? error : new CoreError("internal", String(error));
    if (known.code === "cancelled") {
      // Stopped by the user, who wants the rest to wait too.
      queue.running.value = false;
      queue.update(item.id, { status: "waiting" });
      return;
    }
    queue.update(item.id, { status: "error", error: known });
  }
  await keepItem(item.id);
}

async function register(client: CoreClient, item: queue.Item): Promise<void> {
  const begin = performance.now();
  const settings = queue.settingsOf(item);
  const scan = await client.call("open", { file: item.file!, name: item.name });
  await show(item.id, (draw) => draw.scan(scan));
  await client.call("configure", { settings });
  const { register } = await client.call("run", { until: "register", again: false });
  if (!register) throw new CoreError("internal", "the registration ended without a result");
  await finish(item.id, client, register, (performance.now() - begin) / 1000);
}

async function finish(id: number, client: CoreClient, result: ResultData, seconds: number): Promise<void> {
  const files = await client.call("files", { format: "ply" });
  // Of a failed registration there is no body to measure.
  if (result.registration.verdict.status !== "failed")
    files.push(...(await client.call("measuredFiles", { format: "measurements" })));
  if (result.vertexErrorMm.length > 0) {
    await show(id, (draw) => draw.body(result.body, result.vertexErrorMm));
  }
  const outcome = await outcomeOf(result.registration, files, seconds);
  queue.update(id, { status: "done", outcome, error: null });
}

/** The main view's own settings, while a scan of the batch is open in it. */
let settingsBefore: Settings | null = null;

/** Opens a scan in the main view, registered anew if it was, to be looked at and mended. */
export async function openInView(id: number): Promise<void> {
  const item = queue.itemOf(id);
  if (!item?.file || item.status === "working") return;
  pause();
  await coreIsFree();
  settingsBefore ??= page.settings.value;
  page.settings.value = queue.settingsOf(item);
  queue.opened.value = id;
  mode.value = "scan";
  await openFile(item.file, item.name);
  if (page.scan.value && item.outcome) await run("register", "results");
}

/** Takes the main view's result, however it came about, as that of the opened scan. */
export async function putBack(): Promise<void> {
  const id = queue.opened.value;
  const result = page.result.value;
  if (id === null || !result) return;
  const seconds = (result.registration.timing_ms.total ?? 0) / 1000;
  queue.update(id, { settings: page.settings.value });
  await borrowCore((client) => finish(id, client, result, seconds), "keep");
  await keepItem(id);
  leave();
}

/** Back to the batch without taking anything. */
export function leave(): void {
  queue.selected.value = queue.opened.value;
  queue.opened.value = null;
  mode.value = "batch";
  if (!settingsBefore) return;
  page.settings.value = settingsBefore;
  settingsBefore = null;
  void change({});
}
