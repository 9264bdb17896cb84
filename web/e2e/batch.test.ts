import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { unzipSync } from "fflate";
import type { BrowserContext, Page } from "playwright-core";
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
      payload("not-meant.ply", SAMPLE),
      payload("broken.ply", BROKEN),
      payload("notes.docx", Buffer.from("PK\u0003\u0004 not a scan")),
    ]);
}

/** Drops a folder from the disk, as a file manager does. */
async function dropFolder(context: BrowserContext, page: Page, folder: string): Promise<void> {
  const browser = await context.newCDPSession(page);
  const data = { items: [], files: [folder], dragOperationsMask: 1 };
  for (const type of ["dragEnter", "dragOver", "drop"] as const)
    await browser.send("Input.dispatchDragEvent", { type, x: 400, y: 400, data });
  await browser.detach();
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
    context,
  }) => {
    const folder = mkdtempSync(join(tmpdir(), "vitruvian-batch-"));
    mkdirSync(join(folder, "more"));
    writeFileSync(join(folder, "more", "first.ply.gz"), gzipSync(SAMPLE));
    writeFileSync(join(folder, "read.me"), "no scan, so left out");
    await addScans(page);
    await dropFolder(context, page, folder);
    await page.getByText("5 scans:").waitFor();
    const row = (name: string) => page.getByRole("listitem").filter({ hasText: name });
    await page.getByRole("button", { name: "not-meant" }).click();
    await page.getByRole("button", { name: "Remove", exact: true }).click();
    expect(await page.getByRole("listitem").count()).toBe(4);

    // Paused at once: the scan at work ends, the others wait for what it found.
    await page.getByRole("button", { name: "Start", exact: true }).click();
    await page.getByRole("button", { name: "Pause" }).click();
    await page.getByText("4 scans: 3 to do, 1 ok").waitFor({ timeout: PATIENCE_MS });
    await page.getByRole("button", { name: "first", exact: true }).click();
    await page.getByLabel("Start all other scans from this body").check();
    await page.getByRole("button", { name: "first-2" }).click();
    await page.getByLabel("Other settings for this scan than for all").check();
    await page.getByRole("radio", { name: "Female" }).check({ force: true });
    await page.getByRole("button", { name: "Close" }).click();
    await page.getByRole("button", { name: "Go on" }).click();
    await page.getByText(/4 scans: (?!.*to do)/).waitFor({ timeout: 2 * PATIENCE_MS });
    await page.getByRole("button", { name: "broken" }).click();
    await page.getByRole("button", { name: "Run again" }).click();
    await page.getByText("4 scans: 1 to do").waitFor();
    await page.getByRole("button", { name: "Close" }).click();
    await page.getByRole("button", { name: "Go on" }).click();
    await page.getByText(/4 scans: (?!.*to do)/).waitFor({ timeout: PATIENCE_MS });
    expect(await row("broken.ply").innerText()).toMatch(/Not registered[\s\S]*damaged or incomplete/);
    expect(await row("first.ply,").innerText()).toMatch(/OK/);
    expect(await row("notes.docx").innerText()).toMatch(/Not registered[\s\S]*cannot be read/);
    expect(await row("first.ply,").locator("img").count()).toBe(1);

    const table = rows((await downloaded(page, "Table as CSV")).toString());
    expect([...table.keys()]).toEqual(["scan", "first", "broken", "notes", "first-2"]);
    expect(table.get("broken")!.slice(0, 3)).toEqual(["broken", "error", "NA"]);
    const zip = unzipSync(await downloaded(page, "All results as ZIP"));
    const written = [
      ...["registration.json", "registered.ply", "errors.csv"],
      ...["measurements.json", "measurements.csv"],
    ];
    expect(Object.keys(zip)).toEqual([
      ...["first", "first-2"].flatMap((folder) => written.map((file) => `${folder}/${file}`)),
      "batch.csv",
      "measurements.csv",
    ]);
    const text = (name: string) => new TextDecoder().decode(zip[name]);
    const registrationOf = (folder: string): Registration => JSON.parse(text(`${folder}/registration.json`));
    for (const folder of ["first", "first-2"]) {
      const json = registrationOf(folder);
      expect(json.verdict.status).toBe("ok");
      expect(Number(table.get(folder)![3])).toBeCloseTo(json.surface_error!.surface_all.mean_mm!, 3);
    }

    const [started, first] = [registrationOf("first-2"), registrationOf("first")];
    expect(first.settings.init).toBe("auto");
    expect(started.settings).toMatchObject({ init: "file", gender: "female" });
    expect(started.settings.start).toMatchObject({ pose: first.parameters!.pose });
    // One row a measurement, as many as in the single tables.
    const lines = (name: string) => text(name).trimEnd().split("\n").slice(1);
    expect(lines("measurements.csv")).toEqual(
      ["first", "first-2"].flatMap((folder) =>
        lines(`${folder}/measurements.csv`).map((line) => `${folder},${line}`),
      ),
    );
    expect(lines("first/measurements.csv").length).toBeGreaterThan(60);

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
