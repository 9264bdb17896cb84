import type { OutputFile, Registration } from "../core/types";
import type { Outcome } from "./queue";

/** What the batch keeps of a registration and its files. */
export async function outcomeOf(
  registration: Registration,
  files: readonly OutputFile[],
  seconds: number,
): Promise<Outcome> {
  const { verdict, surface_error, parameters, model } = registration;
  return {
    verdict,
    mean_mm: surface_error?.surface_all.mean_mm ?? null,
    p95_mm: surface_error?.surface_all.p95_mm ?? null,
    scan_p95_mm: surface_error?.scan_to_model.p95_mm ?? null,
    seconds,
    start: parameters && { ...withoutOffsets(parameters), model_sha256: model.sha256 },
    files: await packed(files),
  };
}

function withoutOffsets({ offsets: _, ...parameters }: NonNullable<Registration["parameters"]>) {
  return parameters;
}

async function packed(files: readonly OutputFile[]): Promise<Blob> {
  const { zipSync } = await import("fflate");
  const entries = Object.fromEntries(files.map(({ name, data }) => [name, data]));
  const zip = zipSync(entries, { level: 6, mtime: new Date(2026, 0, 1) });
  return new Blob([zip as BlobPart], { type: "application/zip" });
}
