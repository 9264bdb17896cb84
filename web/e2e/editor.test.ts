import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { describe, expect } from "vitest";
import type { Registration } from "../src/core/types";
import { downloaded, PATIENCE_MS, pick, root, test, verdict } from "./harness";

const CLI = `${root}/build/native/vitruvian`;

/** The sample twice, one above the other: an automatic registration cannot tell whom to take. */
function twoPeople(): Buffer {
  const file = readFileSync(`${root}/models/generated/sample.ply`);
  const end = file.indexOf("end_header\n") + "end_header\n".length;
  const header = file.subarray(0, end).toString();
  const count = (element: string) => Number(new RegExp(`element ${element} (\\d+)`).exec(header)![1]);
  const [vertices, faces] = [count("vertex"), count("face")];
  // Three floats and three bytes a vertex; a byte and three integers a face.
  const points = file.subarray(end, end + 15 * vertices);
  const triangles = file.subarray(end + 15 * vertices);
  const other = Buffer.from(points);
  for (let i = 0; i < vertices; ++i) other.writeFloatLE(points.readFloatLE(15 * i + 8) + 2000, 15 * i + 8);
  const others = Buffer.from(triangles);
  for (let i = 0; i < faces; ++i)
    for (let k = 0; k < 3; ++k) {
      const at = 13 * i + 1 + 4 * k;
      others.writeInt32LE(triangles.readInt32LE(at) + vertices, at);
    }
  const twice = header
    .replace(`vertex ${vertices}`, `vertex ${2 * vertices}`)
    .replace(`face ${faces}`, `face ${2 * faces}`);
  return Buffer.concat([Buffer.from(twice), points, other, triangles, others]);
}

async function drag(page: Page, path: [number, number][]): Promise<void> {
  await page.mouse.move(...path[0]!);
  await page.mouse.down();
  for (const point of path.slice(1)) await page.mouse.move(...point, { steps: 3 });
  await page.mouse.up();
}

async function result(page: Page): Promise<Registration> {
  return JSON.parse((await downloaded(page, "registration.json")).toString());
}

describe("the editor", () => {
  test("cuts a second person away and its project gives the same on the command line", async ({ page }) => {
    const folder = mkdtempSync(join(tmpdir(), "vitruvian-editor-"));
    const scan = join(folder, "two.ply");
    writeFileSync(scan, twoPeople());
    await pick(page, scan);
    await page.getByText("Vertices", { exact: true }).waitFor({ timeout: PATIENCE_MS });
    await page.keyboard.press("r");
    expect(await verdict(page)).not.toBe("OK");

    await page.keyboard.press("1");
    await page.getByRole("button", { name: "Cut away…" }).click();
    const front = page.locator("[data-pane=front]");
    await front.waitFor({ timeout: PATIENCE_MS });
    const { x, y, width, height } = (await front.boundingBox())!;
    const [left, right, top, middle] = [x + 3, x + width - 3, y + 20, y + height / 2];
    await drag(page, [
      [left, middle],
      [right, middle],
      [right, top],
      [left, top],
      [left, middle],
    ]);
    await page.getByText("1 edit", { exact: true }).waitFor();
    await page.getByRole("button", { name: "Undo" }).click();
    await page.getByRole("button", { name: "Redo" }).click();
    await page.getByRole("button", { name: "Register with these edits" }).click();
    await page.locator(".editor").waitFor({ state: "detached", timeout: PATIENCE_MS });
    await page.locator(".progress").waitFor({ state: "detached", timeout: PATIENCE_MS });
    expect(await verdict(page)).toBe("OK");
    const inPage = await result(page);

    await page.getByRole("button", { name: "Edit the joints…" }).click();
    const arriving = page.waitForEvent("download");
    await page.getByRole("button", { name: "Save project" }).click({ timeout: PATIENCE_MS });
    const project = join(folder, "two.project.json");
    await (await arriving).saveAs(project);
    const out = join(folder, "out");
    expect(spawnSync(CLI, ["register", scan, "--out", out, "--quiet", "--project", project]).status).toBe(0);
    const replayed: Registration = JSON.parse(readFileSync(join(out, "two/registration.json"), "utf8"));
    expect(replayed.verdict.status).toBe(inPage.verdict.status);
    const millimetres = 1000 * inPage.scan.metres_per_unit;
    const apart = replayed.joints.map(({ scan }, i) =>
      Math.hypot(...inPage.joints[i]!.scan.map((value, k) => value - scan[k]!)),
    );
    expect(Math.max(...apart) * millimetres).toBeLessThan(0.5);
  });
});
