import { readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { unzipSync } from "fflate";
import type { Page } from "playwright-core";
import { describe, expect } from "vitest";
import type { Registration } from "../src/core/types";
import { downloaded, PATIENCE_MS, root, test, verdict } from "./harness";

const SAMPLE = readFileSync(`${root}/models/generated/sample.ply`);
const BROKEN = Buffer.from("ply\nformat ascii 1.0\nelement vertex 4\n");

function payload(name: string, buffer: Buffer) {
  return { name, buffer, mimeType: "application/octet-stream" };
}

async function addScans(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Batch" }).click();
  await page
    .getByLabel("Scans for the batch")
    .setInputFiles([
      payload("first.ply", SAMPLE),
      payload("broken.ply", BROKEN),
      payload("notes.docx", Buffer.from("PK\u0003\u0004 not a scan")),
      payload("first.ply.gz", gzipSync(SAMPLE)),
    ]);
}

/** Rows of a table without commas inside its fields but in the last. */
function rows(csv: string): Map<string, string[]> {
  return new Map(
    csv
      .trimEnd()
      .split("\n")
      .map((line) => [line.split(",")[0]!, line.split(",")]),
  );
}

describe("a batch", () => {
  test("goes on after a broken scan, gives table and ZIP, and outlives a reload when asked", async ({
    page,
  }) => {
    await addScans(page);
    const row = (name: string) => page.getByRole("listitem").filter({ hasText: name });
    expect(await page.getByRole("listitem").count()).toBe(4);
    await page.getByRole("button", { name: "Start", exact: true }).click();
    await page.getByText(/4 scans: (?!.*to do)/).waitFor({ timeout: 2 * PATIENCE_MS });
    expect(await row("broken.ply").innerText()).toMatch(/Not registered[\s\S]*damaged or incomplete/);
    expect(await row("first.ply,").innerText()).toMatch(/OK/);
    expect(await row("notes.docx").innerText()).toMatch(/Not registered[\s\S]*cannot be read/);
    expect(await row("first.ply,").locator("img").count()).toBe(1);

    const table = rows((await downloaded(page, "Table as CSV")).toString());
    expect([...table.keys()]).toEqual(["scan", "first", "broken", "notes", "first-2"]);
    expect(table.get("broken")!.slice(0, 3)).toEqual(["broken", "error", "NA"]);
    const zip = unzipSync(await downloaded(page, "All results as ZIP"));
    const written = ["registration.json", "registered.ply", "errors.csv"];
    expect(Object.keys(zip)).toEqual([
      ...["first", "first-2"].flatMap((folder) => written.map((file) => `${folder}/${file}`)),
      "batch.csv",
    ]);
    for (const folder of ["first", "first-2"]) {
      const json = JSON.parse(new TextDecoder().decode(zip[`${folder}/registration.json`])) as Registration;
      expect(json.verdict.status).toBe("ok");
      expect(Number(table.get(folder)![3])).toBeCloseTo(json.surface_error!.surface_all.mean_mm!, 3);
    }

    await page.getByRole("button", { name: "first-2" }).click();
    await page.getByRole("button", { name: "Open", exact: true }).click();
    expect(await verdict(page)).toBe("OK");
    await page.getByRole("button", { name: "Put it back" }).click();
    expect(await row("first.ply.gz").innerText()).toMatch(/OK/);
    await page.getByRole("button", { name: "Close" }).click();

    await page.getByLabel("Keep results in this browser").check();
    await page.getByText("4 kept.").waitFor();
    await page.reload();
    await page.getByRole("button", { name: "Batch" }).click();
    await page.getByText("4 scans:").waitFor();
    expect(await row("first.ply,").innerText()).toMatch(/OK/);
    const kept = rows((await downloaded(page, "Table as CSV")).toString());
    expect(kept.get("first")).toEqual(table.get("first"));
    expect(kept.get("broken")).toEqual(table.get("broken"));
    await page.getByLabel("Keep results in this browser").uncheck();
    await page.reload();
    await page.getByRole("button", { name: "Batch" }).click();
    await page.getByText("Drop many scans").waitFor();
  });
});
