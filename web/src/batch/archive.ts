// All results as one ZIP. Written piece by piece: the browser may put a Blob's parts on disk.

import type { Item } from "./queue";
import { batchCsv, measurementsCsv } from "./table";

/** A folder a scan, with what the command line writes there, and the tables: of the scans, of all their measurements. */
export async function archive(items: readonly Item[]): Promise<Blob> {
  const { Zip, ZipDeflate, unzipSync } = await import("fflate");
  const parts: Blob[] = [];
  const zip = new Zip((error, chunk) => {
    if (error) throw error;
    parts.push(new Blob([chunk as BlobPart]));
  });
  const add = (name: string, data: Uint8Array) => {
    const entry = new ZipDeflate(name, { level: 6 });
    entry.mtime = new Date(2026, 0, 1);
    zip.add(entry);
    entry.push(data, true);
  };
  const measured: [string, string][] = [];
  for (const { folder, outcome } of items) {
    if (!outcome) continue;
    const files = unzipSync(new Uint8Array(await outcome.files.arrayBuffer()));
    for (const [name, data] of Object.entries(files)) add(`${folder}/${name}`, data);
    const table = files["measurements.csv"];
    if (table) measured.push([folder, new TextDecoder().decode(table)]);
  }
  add("batch.csv", new TextEncoder().encode(batchCsv(items)));
  if (measured.length > 0) add("measurements.csv", new TextEncoder().encode(measurementsCsv(measured)));
  zip.end();
  return new Blob(parts, { type: "application/zip" });
}
