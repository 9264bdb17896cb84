// The user's model files kept on this computer, when asked for: in the browser's private file system, which no site but
// this one can read.
import { files, info, learnt, type OwnFile } from "./own";
import { kModelKinds, type ModelKind, type ModelsInfo } from "./types";

const FOLDER = "models";
const INDEX = "index.json";
const WANTED = "vitruvian-models-kept";

interface Index {
  files: { kind: ModelKind; name: string }[];
  info: ModelsInfo;
  /** own.learnt */
  learnt: [sha256: string, text: string][];
}

/** Whether models were kept at an earlier visit. */
export function wanted(): boolean {
  try {
    return localStorage.getItem(WANTED) !== null;
  } catch {
    return false;
  }
}

async function write(folder: FileSystemDirectoryHandle, name: string, content: Blob | string): Promise<void> {
  const stream = await (await folder.getFileHandle(name, { create: true })).createWritable();
  await stream.write(content);
  await stream.close();
}

/** Keeps the files in use. @throws what the browser throws, out of space for one */
export async function keep(): Promise<void> {
  await forget();
  const made = info.peek();
  if (!made) return;
  const root = await navigator.storage.getDirectory();
  const folder = await root.getDirectoryHandle(FOLDER, { create: true });
  for (const { kind, file } of files.peek()) await write(folder, fileName(kind), file);
  const index: Index = {
    files: files.peek().map(({ kind, name }) => ({ kind, name })),
    info: made,
    learnt: [...learnt],
  };
  await write(folder, INDEX, JSON.stringify(index));
  localStorage.setItem(WANTED, "1");
}

/** Removes what was kept. */
export async function forget(): Promise<void> {
  localStorage.removeItem(WANTED);
  const root = await navigator.storage.getDirectory();
  await root.removeEntry(FOLDER, { recursive: true }).catch((error: DOMException) => {
    if (error.name !== "NotFoundError") throw error;
  });
}

/** What was kept. @throws when it is not there or damaged */
export async function restored(): Promise<Omit<Index, "files"> & { files: OwnFile[] }> {
  const root = await navigator.storage.getDirectory();
  const folder = await root.getDirectoryHandle(FOLDER);
  const read = async (name: string) => (await folder.getFileHandle(name)).getFile();
  const index = JSON.parse(await (await read(INDEX)).text()) as Index;
  const found: OwnFile[] = [];
  for (const { kind, name } of index.files) {
    // A copy: what is kept is replaced while it is in use.
    const file = new Blob([await (await read(fileName(kind))).arrayBuffer()]);
    found.push({ kind, name, file });
  }
  return { files: found, info: index.info, learnt: index.learnt };
}

function fileName(kind: ModelKind): string {
  return `model-${kModelKinds.indexOf(kind)}`;
}
