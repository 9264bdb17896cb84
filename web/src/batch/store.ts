// Results that outlive the page, on this computer alone and only when asked for (IndexedDB). Scans are not kept.
import { signal } from "@preact/signals";
import { CoreError, type ErrorCode } from "../core/types";
import * as queue from "./queue";

const DATABASE = "vitruvian-batch";
const STORE = "results";
const WANTED = "vitruvian-batch-keep";

interface Kept {
  folder: string;
  name: string;
  bytes: number;
  settings: queue.Item["settings"];
  picture: Blob | null;
  outcome: queue.Outcome | null;
  error: { code: ErrorCode; message: string } | null;
}

/** Whether results are kept. */
export const keeping = signal(wanted());
/** Results that are kept by now. */
export const keptCount = signal(0);
/** Why they cannot be, in plain words; empty when they can. */
export const keepingFailed = signal("");

function wanted(): boolean {
  try {
    return localStorage.getItem(WANTED) !== null;
  } catch {
    return false;
  }
}

function database(): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    const opening = indexedDB.open(DATABASE, 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore(STORE, { keyPath: "folder" });
    opening.onsuccess = () => resolve(opening.result);
    opening.onerror = () => reject(opening.error);
  });
}

/** Runs one request in a transaction of its own. */
async function ask<T>(
  mode: IDBTransactionMode,
  request: (store: IDBObjectStore) => IDBRequest<T>,
): Promise<T> {
  const opened = await database();
  try {
    return await new Promise<T>((resolve, reject) => {
      const transaction = opened.transaction(STORE, mode);
      const asked = request(transaction.objectStore(STORE));
      transaction.oncomplete = () => resolve(asked.result);
      transaction.onabort = () => reject(transaction.error);
    });
  } finally {
    opened.close();
  }
}

async function attempt(work: () => Promise<void>): Promise<void> {
  try {
    await work();
    keepingFailed.value = "";
  } catch (error) {
    keepingFailed.value = `The results could not be kept: ${error instanceof Error ? error.message : error}`;
  }
}

async function keptForm({
  folder,
  name,
  bytes,
  settings,
  picture,
  outcome,
  error,
}: queue.Item): Promise<Kept> {
  return {
    folder,
    name,
    bytes,
    settings,
    picture: picture ? await (await fetch(picture)).blob() : null,
    outcome,
    error: error && { code: error.code, message: error.message },
  };
}

/** Keeps what has become of a scan, when results are kept at all. */
export async function keepItem(id: number): Promise<void> {
  const item = queue.itemOf(id);
  if (!keeping.value || !item || (!item.outcome && !item.error)) return;
  const kept = await keptForm(item);
  await attempt(async () => {
    await ask("readwrite", (store) => store.put(kept));
    keptCount.value = await ask("readonly", (store) => store.count());
  });
}

export async function dropItem(folder: string): Promise<void> {
  if (!keeping.value) return;
  await attempt(async () => {
    await ask("readwrite", (store) => store.delete(folder));
  });
}

async function forget(): Promise<void> {
  await attempt(async () => {
    await ask("readwrite", (store) => store.clear());
  });
}

export async function dropAll(): Promise<void> {
  if (keeping.value) await forget();
}

/** Keeps all results there are and will be; or forgets them. */
export async function setKeeping(keep: boolean): Promise<void> {
  keeping.value = keep;
  try {
    if (keep) localStorage.setItem(WANTED, "1");
    else localStorage.removeItem(WANTED);
  } catch {
    // Without storage the choice lasts as long as the page.
  }
  if (!keep) {
    await forget();
    return;
  }
  for (const { id } of queue.items.value) await keepItem(id);
}

/** Brings the results of an earlier visit back into the queue, once. */
export async function restoreKept(): Promise<void> {
  if (!keeping.value || queue.items.value.length > 0) return;
  await attempt(async () => {
    const kept = (await ask("readonly", (store) => store.getAll())) as Kept[];
    queue.restore(
      kept.map(({ picture, error, ...item }) => ({
        ...item,
        file: null,
        status: item.outcome ? "done" : "error",
        picture: picture && URL.createObjectURL(picture),
        error: error && new CoreError(error.code, error.message),
      })),
    );
  });
}
