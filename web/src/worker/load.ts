import { CoreError } from "../core/types";

/** Fetches a file of this site, reporting the share that has arrived. @throws CoreError(network) */
export async function load(url: URL, onProgress: (fraction: number | null) => void): Promise<Uint8Array> {
  const name = url.pathname.split("/").pop();
  const response = await fetch(url).catch(() => null);
  if (!response?.ok || !response.body) {
    throw new CoreError("network", `${name} could not be loaded (${response?.status ?? "no connection"})`);
  }
  const total = Number(response.headers.get("Content-Length") ?? 0);
  const parts: Uint8Array[] = [];
  let size = 0;
  const reader = response.body.getReader();
  for (;;) {
    const { done, value } = await reader.read().catch(() => {
      throw new CoreError("network", `${name} stopped loading after ${size} bytes`);
    });
    if (done) break;
    parts.push(value);
    size += value.length;
    onProgress(total > 0 ? Math.min(size / total, 1) : null);
  }
  const bytes = new Uint8Array(size);
  let offset = 0;
  for (const part of parts) {
    bytes.set(part, offset);
    offset += part.length;
  }
  return bytes;
}
