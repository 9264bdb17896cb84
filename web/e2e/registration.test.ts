import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { unzipSync } from "fflate";
import type { Browser, BrowserContext, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import type { Registration } from "../src/core/types";
import { launch, pick, root, type Site, serve, type Watch, watch } from "./harness";

const SAMPLE = `${root}/models/generated/sample.ply`;
const CLI = `${root}/build/native/vitruvian`;
const JOINT_TOLERANCE_MM = 0.5;
const MEAN_TOLERANCE_MM = 0.05;
const CANCEL_MS = 200;
/** A registration, on a machine that does other things too. */
const PATIENCE_MS = 120_000;

let browser: Browser;
let site: Site;
let context: BrowserContext;
let page: Page;
let seen: Watch;

beforeAll(async () => {
  browser = await launch();
  site = await serve();
});

afterAll(async () => {
  await browser?.close();
  await site?.close();
});

beforeEach(async () => {
  context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
  seen = watch(context);
  page = await context.newPage();
  await page.goto(site.url);
  await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
});

afterEach(async () => {
  expect(seen.complaints).toEqual([]);
  expect(seen.requests.filter((url) => !url.startsWith(site.url) && !url.startsWith("blob:"))).toEqual([]);
  await context.close();
});

async function openSample(): Promise<void> {
  await page.getByRole("button", { name: "Sample scan" }).click();
  await page.getByText("Vertices", { exact: true }).waitFor({ timeout: PATIENCE_MS });
}

async function verdict(): Promise<string> {
  await page.locator(".verdict").waitFor({ timeout: PATIENCE_MS });
  return page.locator(".verdict strong").innerText();
}

async function downloaded(button: string): Promise<Buffer> {
  const arriving = page.waitForEvent("download");
  await page.getByRole("button", { name: button }).click();
  return readFileSync(await (await arriving).path());
}

/** The command line's own result on the sample scan. */
function nativeFolder(): string {
  const out = mkdtempSync(join(tmpdir(), "vitruvian-e2e-"));
  execFileSync(CLI, ["register", SAMPLE, "--out", out, "--quiet"]);
  return join(out, "sample");
}

describe("registering the sample scan", () => {
  it("ends with verdict ok, and gives what the command line gives", async () => {
    await openSample();
    await page.keyboard.press("r");
    expect(await verdict()).toBe("OK");
    expect(await page.locator("table.errors tbody tr").count()).toBe(25);

    const zip = unzipSync(await downloaded("All as ZIP"));
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
  });

  it("shows every stage, and the view's options", async () => {
    await openSample();
    await page.getByRole("button", { name: "Register R" }).click();
    await verdict();
    await page.keyboard.press("3");
    expect(await page.locator(".views canvas").count()).toBe(8);
    await page.keyboard.press("2");
    expect(await page.locator("aside").innerText()).toMatch(/Unit\s+mm/);
    await page.keyboard.press("6");
    for (const name of ["Split view", "Wireframe", "Error colours"]) await page.getByLabel(name).click();
    expect(await page.locator(".legend").count()).toBe(0);
  });

  it("takes a unit by hand", async () => {
    await openSample();
    await page.keyboard.press("2");
    await page.getByRole("radio", { name: "cm", exact: true }).check({ force: true });
    await page.keyboard.press("r");
    await page.locator(".verdict").waitFor({ timeout: PATIENCE_MS });
    expect(await page.locator(".verdict strong").innerText()).not.toBe("OK");
    await page.keyboard.press("2");
    await page.getByText("is the unit right?").waitFor();
  });

  it("stops at once when cancelled, and runs again", async () => {
    await openSample();
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
    expect(await verdict()).toBe("OK");
  });
});

describe("without network or threads", () => {
  it("registers after a reload with the server gone", async () => {
    const passing = await serve();
    await page.goto(passing.url);
    await openSample();
    await page.keyboard.press("r");
    expect(await verdict()).toBe("OK");
    await passing.close();
    await page.reload();
    await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
    expect(existsSync(SAMPLE)).toBe(true);
    await pick(page, SAMPLE);
    await page.getByText("Vertices", { exact: true }).waitFor({ timeout: PATIENCE_MS });
    await page.keyboard.press("r");
    expect(await verdict()).toBe("OK");
    seen.requests.length = 0;
    seen.complaints.length = 0;
  });

  it("registers on one thread", async () => {
    await page.goto(`${site.url}?threads=1`);
    await openSample();
    await page.getByText("does not allow threads").waitFor();
    await page.keyboard.press("r");
    expect(await verdict()).toBe("OK");
    expect(seen.requests.some((url) => url.includes("/wasm/threads/"))).toBe(false);
  });
});
