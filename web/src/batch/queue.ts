// The batch: scans waiting, at work and done. Results are kept compressed, never as live meshes.
import { computed, signal } from "@preact/signals";
import type { StartBody } from "../core/edits";
import { type CoreError, defaultSettings, type Registration, type Settings } from "../core/types";
import { stem } from "../result/download";

export type ItemStatus = "waiting" | "working" | "done" | "error";

/** What is kept of a registration. */
export interface Outcome {
  verdict: Registration["verdict"];
  /** null where there is none, as in a failed registration */
  mean_mm: number | null;
  p95_mm: number | null;
  /** of scan points to the body */
  scan_p95_mm: number | null;
  seconds: number;
  /** for scans that start from this one; null when failed */
  start: StartBody | null;
  /** what the command line writes, as a ZIP */
  files: Blob;
}

export interface Item {
  id: number;
  /** the file's name, without folders */
  name: string;
  /** folder in the results: the name without .gz and one extension, made unique in the batch */
  folder: string;
  bytes: number;
  /** null: only the result was kept from an earlier visit */
  file: Blob | null;
  status: ItemStatus;
  /** of this scan alone; null: as for all */
  settings: Settings | null;
  /** the scan, then the registered body: addresses of pictures */
  picture: string | null;
  outcome: Outcome | null;
  error: CoreError | null;
}

export const items = signal<readonly Item[]>([]);
/** For every scan without settings of its own. */
export const settingsForAll = signal<Settings>(defaultSettings);
/** The scan whose registration the others start from. */
export const startFrom = signal<number | null>(null);
/** Whether the queue is being worked. */
export const running = signal(false);
export const selected = signal<number | null>(null);
/** The scan that is open in the main view, to be put back. */
export const opened = signal<number | null>(null);

export const counts = computed(() => {
  const of = (test: (item: Item) => boolean) => items.value.filter(test).length;
  return {
    all: items.value.length,
    left: of(({ status }) => status === "waiting" || status === "working"),
    ok: of(({ outcome }) => outcome?.verdict.status === "ok"),
    doubtful: of(({ outcome }) => outcome?.verdict.status === "doubtful"),
    failed: of(({ outcome }) => outcome?.verdict.status === "failed"),
    errors: of(({ status }) => status === "error"),
  };
});

let nextId = 1;

function uniqueFolder(name: string, taken: ReadonlySet<string>): string {
  const wanted = stem(name);
  let folder = wanted;
  for (let n = 2; taken.has(folder); ++n) folder = `${wanted}-${n}`;
  return folder;
}

/** Adds files at the end. One whose result was kept takes its file back instead. */
export function add(files: readonly File[]): void {
  const list = [...items.value];
  for (const file of files) {
    const kept = list.findIndex(
      (item) => item.file === null && item.name === file.name && item.bytes === file.size,
    );
    if (kept >= 0) {
      list[kept] = { ...list[kept]!, file };
      continue;
    }
    const taken = new Set(list.map(({ folder }) => folder));
    list.push({
      id: nextId++,
      name: file.name,
      folder: uniqueFolder(file.name, taken),
      bytes: file.size,
      file,
      status: "waiting",
      settings: null,
      picture: null,
      outcome: null,
      error: null,
    });
  }
  items.value = list;
}

/** Puts results of an earlier visit in front. */
export function restore(kept: readonly Omit<Item, "id">[]): void {
  items.value = [...kept.map((item) => ({ ...item, id: nextId++ })), ...items.value];
}

export function itemOf(id: number | null): Item | undefined {
  return items.value.find((item) => item.id === id);
}

export function update(id: number, change: Partial<Item>): void {
  items.value = items.value.map((item) => (item.id === id ? { ...item, ...change } : item));
}

/** Shows another picture; the one before is let go. */
export function setPicture(id: number, picture: Blob): void {
  const before = itemOf(id)?.picture;
  if (before) URL.revokeObjectURL(before);
  update(id, { picture: URL.createObjectURL(picture) });
}

export function remove(id: number): void {
  const item = itemOf(id);
  if (!item || item.status === "working") return;
  if (item.picture) URL.revokeObjectURL(item.picture);
  if (startFrom.value === id) startFrom.value = null;
  if (selected.value === id) selected.value = null;
  items.value = items.value.filter((each) => each.id !== id);
}

export function removeAll(): void {
  for (const { id } of items.value) remove(id);
}

/** Puts a scan back into the queue. */
export function again(id: number): void {
  const item = itemOf(id);
  if (item?.file && item.status !== "working") {
    update(id, { status: "waiting", outcome: null, error: null });
  }
}

/** What a scan is registered with. */
export function settingsOf(item: Item): Settings {
  const settings = item.settings ?? settingsForAll.value;
  const start = startFrom.value === item.id ? null : (itemOf(startFrom.value)?.outcome?.start ?? null);
  return start ? { ...settings, init: "file", start } : settings;
}
