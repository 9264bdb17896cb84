// A walk through the page as a new user takes it, kept as frames under build/benchmark/walk, to be looked at: on a
// desktop, a tablet and a phone, in both themes.
import { mkdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { describe } from "vitest";
import { editJoints } from "../e2e/editing";
import { openSample, PATIENCE_MS, root, test, verdict } from "../e2e/harness";

const FRAMES = join(root, "build/benchmark/walk");
const SCREENS = [
  ["desktop", 1280, 720, "light", false],
  ["tablet", 820, 1180, "dark", true],
  ["phone", 390, 844, "light", true],
] as const;
/** For what is drawn after the page itself. */
const SETTLE_MS = 700;

/** Keeps numbered frames of a page. */
function camera(page: Page, folder: string): (name: string) => Promise<void> {
  let count = 0;
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  return async (name) => {
    count += 1;
    await page.waitForTimeout(SETTLE_MS);
    await page.screenshot({ path: join(folder, `${String(count).padStart(2, "0")}-${name}.png`) });
  };
}

async function edit(page: Page, frame: (name: string) => Promise<void>): Promise<void> {
  await frame("start");
  await openSample(page);
  await frame("opened");
  await page.keyboard.press("r");
  await verdict(page);
  await frame("results");
  await editJoints(page);
  await frame("editor-joints");
  await page.getByRole("button", { name: "Align", exact: true }).first().click();
  await frame("editor-align");
  await page.getByRole("button", { name: "Cut away", exact: true }).click();
  await frame("editor-cut");
  await page.getByRole("button", { name: "Done", exact: true }).click();
}

async function learn(page: Page, frame: (name: string) => Promise<void>): Promise<void> {
  await page.getByRole("button", { name: "Learn", exact: true }).click();
  await frame("learn-align");
  await page.getByRole("button", { name: "2. Look at it" }).click();
  await frame("learn-see");
  await page.getByRole("button", { name: "4. Fit it" }).click();
  await page.getByRole("button", { name: "Fit", exact: true }).click();
  await page.getByText("Nothing is changed").waitFor({ timeout: PATIENCE_MS });
  await frame("learn-fit");
  await page.getByLabel("Iteration", { exact: true }).focus();
  await page.keyboard.press("Home");
  await frame("learn-fit-begin");
  await page.getByRole("button", { name: "3. Pose a body" }).click();
  await frame("learn-pose");
  await page.getByRole("button", { name: "5. Judge" }).click();
  await frame("learn-judge");
  await page.getByRole("button", { name: "Body", exact: true }).click();
  await page.getByText("Standing height").waitFor({ timeout: PATIENCE_MS });
  await frame("body");
}

async function batch(page: Page, frame: (name: string) => Promise<void>): Promise<void> {
  await page.getByRole("button", { name: "Batch" }).click();
  await frame("batch-empty");
  await page.getByLabel("Scans for the batch").setInputFiles([`${root}/models/generated/sample.ply`]);
  const broken = {
    name: "broken.ply",
    mimeType: "model/ply",
    buffer: Buffer.from("ply\nformat ascii 1.0\n"),
  };
  await page.getByLabel("Scans for the batch").setInputFiles(broken);
  await frame("batch-waiting");
  await page.getByRole("button", { name: "Start", exact: true }).click();
  await page.getByText(/2 scans: (?!.*to do)/).waitFor({ timeout: PATIENCE_MS });
  await frame("batch-done");
  await page.getByRole("button", { name: "sample", exact: true }).click();
  await frame("batch-one");
}

describe("a walk", () => {
  for (const [name, width, height, colorScheme, hasTouch] of SCREENS)
    test(`on a ${name}`, async ({ browser, site }) => {
      const context = await browser.newContext({ viewport: { width, height }, colorScheme, hasTouch });
      try {
        const page = await context.newPage();
        await page.goto(site.url);
        await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
        const frame = camera(page, join(FRAMES, name));
        await edit(page, frame);
        await learn(page, frame);
        await batch(page, frame);
      } finally {
        await context.close();
      }
    });
});
