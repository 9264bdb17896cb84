// Files out of what was dropped: single ones, and all scans in folders.

/** Formats that the core reads, also gzipped. */
const SCAN = /\.(ply|obj|stl|off|glb|gltf|xyz|pts|txt|asc|pcd)(\.gz)?$/i;

export function isScanName(name: string): boolean {
  return SCAN.test(name) && !name.startsWith(".");
}

function fileOf(entry: FileSystemFileEntry): Promise<File> {
  return new Promise((resolve, reject) => entry.file(resolve, reject));
}

/** All entries of a folder; the browser hands them out in portions. */
async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    const portion = await new Promise<FileSystemEntry[]>((resolve, reject) =>
      reader.readEntries(resolve, reject),
    );
    if (portion.length === 0) return all;
    all.push(...portion);
  }
}

async function walk(entry: FileSystemEntry, inFolder: boolean): Promise<File[]> {
  if (entry.isFile) {
    // What lies in a folder beside the scans is not meant.
    if (inFolder && !isScanName(entry.name)) return [];
    return [await fileOf(entry as FileSystemFileEntry)];
  }
  const files: File[] = [];
  const inside = await entriesOf(entry as FileSystemDirectoryEntry);
  inside.sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
  for (const each of inside) files.push(...(await walk(each, true)));
  return files;
}

/** What was dropped, folders with all that is below them, in order of names. Call it within the event: later the list is empty. */
export function droppedFiles(transfer: DataTransfer): Promise<File[]> {
  const plain = [...transfer.files];
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.() ?? null);
  if (!entries.some((entry) => entry?.isDirectory)) return Promise.resolve(plain);
  return Promise.all(entries.flatMap((entry) => (entry ? [walk(entry, false)] : []))).then((lists) =>
    lists.flat(),
  );
}

/** Whether several files or a folder were dropped. */
export function isPile(transfer: DataTransfer): boolean {
  return (
    transfer.files.length > 1 ||
    [...transfer.items].some((item) => item.webkitGetAsEntry?.()?.isDirectory === true)
  );
}

/** Of a picked folder: the scans in it. */
export function scansAmong(files: Iterable<File>): File[] {
  return [...files]
    .filter(({ name }) => isScanName(name))
    .sort((a, b) => a.webkitRelativePath.localeCompare(b.webkitRelativePath, "en", { numeric: true }));
}
