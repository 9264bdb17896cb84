import type { OutputFile } from "../core/types";

/** Hands bytes to the browser's download. */
export function save(name: string, data: Uint8Array | Blob): void {
  const url = URL.createObjectURL(data instanceof Blob ? data : new Blob([data as BlobPart]));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  // The download reads the blob after this task.
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** One ZIP with a folder named as the command line names it: the scan's name without .gz and one extension. */
export async function zipped(scanFile: string, files: OutputFile[]): Promise<OutputFile> {
  const { zipSync } = await import("fflate");
  const folder = stem(scanFile);
  const entries = Object.fromEntries(files.map(({ name, data }) => [`${folder}/${name}`, data]));
  return { name: `${folder}.zip`, data: zipSync(entries, { level: 6, mtime: new Date(2026, 0, 1) }) };
}

export function stem(file: string): string {
  return file.replace(/\.gz$/i, "").replace(/\.[^.]+$/, "") || file;
}
