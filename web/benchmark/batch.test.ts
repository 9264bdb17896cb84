// A batch of many scans, one of them broken, one of more than a million vertices: nothing may grow with the number.
// VITRUVIAN_BATCH=N takes another number of scans than 30.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { describe, expect } from "vitest";
import { downloaded, root, test } from "../e2e/harness";
import { scriptBytes } from "./memory";

const SCANS = Number(process.env.VITRUVIAN_BATCH ?? 30);
const SAMPLE = `${root}/models/generated/sample.ply`;
const PATIENCE_MS = 900_000;
/** Of what the page may keep of a scan: its files compressed, and its picture. */
const KEPT_BYTES = 1.5e6;

interface Mesh {
  positions: Float32Array;
  faces: Uint32Array;
}

function readSample(): Mesh {
  const file = readFileSync(SAMPLE);
  const header = file.subarray(0, file.indexOf("end_header\n") + 11);
  const [vertices, faces] = ["vertex", "face"].map((name) =>
    Number(new RegExp(`element ${name} (\\d+)`).exec(header.toString())![1]),
  ) as [number, number];
  const mesh = { positions: new Float32Array(3 * vertices), faces: new Uint32Array(3 * faces) };
  let at = header.length;
  for (let i = 0; i < vertices; ++i, at += 15)
    for (let k = 0; k < 3; ++k) mesh.positions[3 * i + k] = file.readFloatLE(at + 4 * k);
  for (let i = 0; i < faces; ++i, at += 13)
    for (let k = 0; k < 3; ++k) mesh.faces[3 * i + k] = file.readInt32LE(at + 1 + 4 * k);
  return mesh;
}

/** Every triangle in four. */
function subdivided({ positions, faces }: Mesh): Mesh {
  const points = [...positions];
  const middles = new Map<number, number>();
  const count = positions.length / 3;
  const middle = (a: number, b: number): number => {
    const edge = Math.min(a, b) * count + Math.max(a, b);
    let found = middles.get(edge);
    if (found === undefined) {
      found = points.length / 3;
      for (let k = 0; k < 3; ++k) points.push((positions[3 * a + k]! + positions[3 * b + k]!) / 2);
      middles.set(edge, found);
    }
    return found;
  };
  const fine = new Uint32Array(4 * faces.length);
  for (let i = 0; i < faces.length; i += 3) {
    const [a, b, c] = [faces[i]!, faces[i + 1]!, faces[i + 2]!];
    const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    fine.set([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], 4 * i);
  }
  return { positions: Float32Array.from(points), faces: fine };
}

function ply({ positions, faces }: Mesh, scale = 1): Buffer {
  const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${positions.length / 3}\nproperty float x\nproperty float y\nproperty float z\nelement face ${faces.length / 3}\nproperty list uchar int vertex_indices\nend_header\n`;
  const bytes = Buffer.alloc(header.length + 4 * positions.length + (13 * faces.length) / 3);
  bytes.write(header, "latin1");
  let at = header.length;
  for (const value of positions) at = bytes.writeFloatLE(scale * value, at);
  for (let i = 0; i < faces.length; i += 3) {
    at = bytes.writeUInt8(3, at);
    for (let k = 0; k < 3; ++k) at = bytes.writeInt32LE(faces[i + k]!, at);
  }
  return bytes;
}

async function finished(page: Page): Promise<number> {
  const text = await page.getByText(/\d+ scans: /).innerText();
  const left = /(\d+) to do/.exec(text)?.[1] ?? "0";
  return SCANS - Number(left);
}

describe("a batch", () => {
  test(`of ${SCANS} scans does not grow, and its table is right`, async ({ page }) => {
    const folder = mkdtempSync(join(tmpdir(), "vitruvian-batch-"));
    try {
      const sample = readSample();
      const large = subdivided(subdivided(sample));
      const names = Array.from({ length: SCANS }, (_, i) => `scan${String(i).padStart(2, "0")}.ply`);
      for (const [i, name] of names.entries()) {
        const path = join(folder, name);
        if (i === 1) writeFileSync(path, ply(large));
        else if (i === 2) writeFileSync(path, ply(sample).subarray(0, 500_000));
        else writeFileSync(path, ply(sample, 0.9 + (0.2 * i) / SCANS));
      }
      await page.getByRole("button", { name: "Batch" }).click();
      await page.getByLabel("Scans for the batch").setInputFiles(names.map((name) => join(folder, name)));
      await page.getByRole("button", { name: "Start", exact: true }).click();
      const memory: { done: number; page: number; worker: number }[] = [];
      for (const done of [3, Math.ceil(SCANS / 2), SCANS]) {
        await expect
          .poll(() => finished(page), { timeout: PATIENCE_MS, interval: 1000 })
          .toBeGreaterThanOrEqual(done);
        memory.push({ done, ...(await scriptBytes(page)) });
      }
      console.log(`\nlarge scan: ${large.positions.length / 3} vertices`);
      for (const { done, page, worker } of memory) {
        console.log(
          `  ${done} scans: page ${(page / 1e6).toFixed(1)} MB, worker ${(worker / 1e6).toFixed(1)} MB`,
        );
      }
      const table = (await downloaded(page, "Table as CSV")).toString();
      console.log(table);
      const rows = table.trimEnd().split("\n").slice(1);
      expect(rows).toHaveLength(SCANS);
      rows.forEach((row, i) => {
        expect(row).toMatch(
          i === 2 ? /^scan02,error,/ : new RegExp(`^scan${String(i).padStart(2, "0")},ok,`),
        );
      });
      const [first, , last] = memory as [(typeof memory)[0], unknown, (typeof memory)[0]];
      expect(last.worker).toBeLessThanOrEqual(1.1 * first.worker);
      expect(last.page - first.page).toBeLessThan(KEPT_BYTES * (SCANS - 3));
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
});
