import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { unzipSync } from "fflate";
import { describe, expect } from "vitest";
import type { Registration } from "../src/core/types";
import { downloaded, openSample, PATIENCE_MS, pick, root, serve, test, verdict } from "./harness";

const SAMPLE = `${root}/models/generated/sample.ply`;
const CLI = `${root}/build/native/vitruvian`;
const JOINT_TOLERANCE_MM = 0.5;
const MEAN_TOLERANCE_MM = 0.05;
const CANCEL_MS = 200;

/** The command line's own result on the sample scan. */
function nativeFolder(): string {
  const out = mkdtempSync(join(tmpdir(), "vitruvian-e2e-"));
  execFileSync(CLI, ["register", SAMPLE, "--out", out, "--quiet"]);
  return join(out, "sample");
}

describe("registering the sample scan", () => {
  test("ends with verdict ok, and gives what the command line gives", async ({ page }) => {
    await openSample(page);
    await page.keyboard.press("r");
    expect(await verdict(page)).toBe("OK");
    expect(await page.locator("table.errors tbody tr").count()).toBe(25);

    const zip = unzipSync(await downloaded(page, "All as ZIP"));
    expect(Object.keys(zip).sort()).toEqual(
      ["errors.csv", "registered.ply", "registration.json"].map((n) => `sample/${n}`),
    );
    const page_ = JSON.parse(new TextDecoder().decode(zip["sample/registration.json"])) as Registration;
    const folder = nativeFolder();
    const native = JSON.parse(readFileSync(join(folder, "registration.json"), "utf8")) as Registration;
    expect(Object.keys(page_)).toEqual(Object.keys(native));
    expect(page_.scan).toEqual(native.scan);
    expect(page_.model).toEqual(native.model);
    expect(page_.verdict.status).toBe(native.verdict.status);
    const distances = native.joints.map(({ body_m }, i) => {
      const other = page_.joints[i]!.body_m;
      return 1000 * Math.hypot(...body_m.map((value, axis) => value - other[axis]!));
    });
    expect(Math.max(...distances)).toBeLessThan(JOINT_TOLERANCE_MM);
    for (const measure of ["all", "surface_all"] as const) {
      const [a, b] = [page_.surface_error![measure].mean_mm!, native.surface_error![measure].mean_mm!];
      expect(Math.abs(a - b)).toBeLessThan(MEAN_TOLERANCE_MM);
    }
    const csv = (bytes: Uint8Array) => new TextDecoder().decode(bytes).split("\n");
    expect(csv(zip["sample/errors.csv"]!)[0]).toBe(csv(readFileSync(join(folder, "errors.csv")))[0]);
    const header = (bytes: Uint8Array) =>
      new TextDecoder().decode(bytes.subarray(0, 400)).split("end_header")[0];
    expect(header(zip["sample/registered.ply"]!)).toBe(header(readFileSync(join(folder, "registered.ply"))));
    expect((await downloaded(page, "registered.glb")).toString("latin1", 0, 4)).toBe("glTF");
    expect((await downloaded(page, "registered.obj")).toString()).toMatch(/^v .*\n/m);
  });

  test("shows every stage, and the view's options", async ({ page }) => {
    await openSample(page);
    await page.getByRole("button", { name: "Register R" }).click();
    await verdict(page);
    await page.keyboard.press("3");
    expect(await page.locator(".views canvas").count()).toBe(8);
    await page.keyboard.press("2");
    expect(await page.locator("aside").innerText()).toMatch(/Unit\s+mm/);
    await page.keyboard.press("6");
    for (const name of ["Split view", "Wireframe", "Error colours"]) await page.getByLabel(name).click();
    expect(await page.locator(".legend").count()).toBe(0);
  });

  test("takes a unit by hand", async ({ page }) => {
    await openSample(page);
    await page.keyboard.press("2");
    await page.getByRole("radio", { name: "cm", exact: true }).check({ force: true });
    await page.keyboard.press("r");
    await page.locator(".verdict").waitFor({ timeout: PATIENCE_MS });
    expect(await page.locator(".verdict strong").innerText()).not.toBe("OK");
    await page.keyboard.press("2");
    await page.getByText("is the unit right?").waitFor();
  });

  test("stops at once when cancelled, and runs again", async ({ page }) => {
    await openSample(page);
    await page.keyboard.press("r");
    await page
      .getByText(/Fitting|Drawing|Finding keypoints/)
      .first()
      .waitFor({ timeout: PATIENCE_MS });
    const took = await page.evaluate(async () => {
      const begin = performance.now();
      (document.querySelector(".progress button") as HTMLElement).click();
      while (document.querySelector(".progress")) await new Promise((done) => setTimeout(done, 5));
      return performance.now() - begin;
    });
    expect(took).toBeLessThan(CANCEL_MS);
    await page.getByText("Stopped.").waitFor();
    await page.keyboard.press("r");
    expect(await verdict(page)).toBe("OK");
  });
});

describe("without network or threads", () => {
  test("registers after a reload with the server gone", async ({ page, seen }) => {
    const passing = await serve();
    await page.goto(passing.url);
    await openSample(page);
    await page.keyboard.press("r");
    expect(await verdict(page)).toBe("OK");
    await passing.close();
    await page.reload();
    await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
    expect(existsSync(SAMPLE)).toBe(true);
    await pick(page, SAMPLE);
    await page.getByText("Vertices", { exact: true }).waitFor({ timeout: PATIENCE_MS });
    await page.keyboard.press("r");
    expect(await verdict(page)).toBe("OK");
    seen.requests.length = 0;
    seen.complaints.length = 0;
  });

  test("registers on one thread", async ({ page, seen, site }) => {
    await page.goto(`${site.url}?threads=1`);
    await openSample(page);
    await page.getByText("does not allow threads").waitFor();
    await page.keyboard.press("r");
    expect(await verdict(page)).toBe("OK");
    expect(seen.requests.some((url) => url.includes("/wasm/threads/"))).toBe(false);
  });
});
