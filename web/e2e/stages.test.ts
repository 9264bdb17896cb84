import { execFileSync } from "node:child_process";
import { readdirSync } from "node:fs";
import type { Page } from "playwright-core";
import { describe, expect } from "vitest";
import type { Registration } from "../src/core/types";
import { downloaded, openSample, PATIENCE_MS, root, test, verdict } from "./harness";

const STAGES = ["Align", "Keypoints", "Pose", "Register"];

/** State of each stage as the rail says it to a screen reader. */
async function states(page: Page): Promise<Record<string, string>> {
  const said = STAGES.map(async (name) => {
    const text = await page.locator("nav .stage", { hasText: name }).innerText();
    return [name, text.split(",")[1]?.trim() ?? ""];
  });
  return Object.fromEntries(await Promise.all(said));
}

/** Waits until nothing is under way. */
async function idle(page: Page): Promise<void> {
  await page.locator(".progress").waitFor({ state: "detached", timeout: PATIENCE_MS });
}

/** Runs the stage whose panel is shown, which is not done yet. */
async function runStage(page: Page): Promise<void> {
  await page.keyboard.press("s");
  await page.locator("nav .stage.done[aria-current]").waitFor({ timeout: PATIENCE_MS });
  await idle(page);
}

/** The result but for its times. */
async function result(page: Page): Promise<string> {
  const json = JSON.parse((await downloaded(page, "registration.json")).toString()) as Registration;
  return JSON.stringify({ ...json, timing_ms: null });
}

const panel = (page: Page) => page.locator("aside");

describe("the stages one by one", () => {
  test("each shows what it found, and together they give what one button gives", async ({ page }) => {
    await openSample(page);
    await page.keyboard.press("2");
    await runStage(page);
    expect(await panel(page).innerText()).toMatch(
      /Unit\s+mm\s+Up\s+\+Z\s+Front\s+[−+][XY]\s+Height of the scan\s+1\.\d\d m/,
    );
    expect(await states(page)).toEqual({
      Align: "done",
      Keypoints: "not done",
      Pose: "not done",
      Register: "not done",
    });

    await page.keyboard.press("3");
    await runStage(page);
    expect(await page.locator(".views canvas").count()).toBe(8);
    expect(await panel(page).locator("tbody tr").count()).toBe(22);
    await page.keyboard.press("4");
    await runStage(page);
    expect(await panel(page).locator("tbody tr").count()).toBe(24);
    expect((await states(page)).Register).toBe("not done");
    await page.keyboard.press("5");
    await runStage(page);
    await page.keyboard.press("6");
    expect(await verdict(page)).toBe("OK");
    const stepped = await result(page);

    await page.reload();
    await openSample(page);
    expect(await states(page)).toEqual(Object.fromEntries(STAGES.map((name) => [name, "not done"])));
    await page.keyboard.press("r");
    await verdict(page);
    expect(await result(page)).toBe(stepped);
  });

  test("a change makes stale what depends on it, and nothing else", async ({ page }) => {
    await openSample(page);
    await page.keyboard.press("r");
    await verdict(page);
    const before = await result(page);

    await page.keyboard.press("4");
    await page.getByRole("radio", { name: "Female" }).check({ force: true });
    await page.getByText("out of date").first().waitFor();
    await idle(page);
    expect(await states(page)).toEqual({
      Align: "done",
      Keypoints: "done",
      Pose: "out of date",
      Register: "out of date",
    });
    await page.keyboard.press("6");
    expect(await page.locator(".verdict").count()).toBe(0);

    await page.keyboard.press("3");
    await page.getByRole("radio", { name: "2, front and side" }).check({ force: true });
    await idle(page);
    expect((await states(page)).Keypoints).toBe("out of date");
    await runStage(page);
    expect(await page.locator(".views canvas").count()).toBe(2);

    await page.keyboard.press("2");
    await page.getByRole("radio", { name: "cm", exact: true }).check({ force: true });
    await page.getByText("is the unit right?").waitFor({ timeout: PATIENCE_MS });
    expect(await states(page)).toMatchObject({ Align: "done", Keypoints: "out of date" });

    // Back to where it was: the same result.
    await page
      .getByRole("group", { name: "Unit" })
      .getByRole("radio", { name: "Auto" })
      .check({ force: true });
    await idle(page);
    await page.keyboard.press("3");
    await page.getByRole("radio", { name: "8, all round" }).check({ force: true });
    await page.keyboard.press("4");
    await page.getByRole("radio", { name: "Neutral" }).check({ force: true });
    await idle(page);
    await page.keyboard.press("r");
    await verdict(page);
    expect(await result(page)).toBe(before);
  });
});

interface Seen {
  dots: { x: number; y: number }[];
  /** side of the square that the network looked at, pixels of the picture */
  side: number;
}

/** Landmarks that the page's own worker sees in the pictures of the sample scan. */
function seenByPage(page: Page): Promise<Seen[]> {
  const worker = readdirSync(`${root}/web/dist/assets`).find((name) => name.startsWith("core.worker"));
  return page.evaluate(async (name) => {
    const worker = new Worker(new URL(`assets/${name}`, document.baseURI), { type: "module" });
    // biome-ignore lint/suspicious/noExplicitAny: runs in the page, where no types are
    const call = (kind: string, args: object): Promise<any> =>
      new Promise((resolve, reject) => {
        worker.onmessage = ({ data }) => {
          if ("progress" in data) return;
          if (data.ok) resolve(data.value);
          else reject(new Error(data.error.message));
        };
        worker.postMessage({ id: 1, kind, args });
      });
    const file = await (await fetch("models/sample.ply")).blob();
    await call("start", { base: document.baseURI, threads: 2 });
    await call("open", { file, name: "sample.ply" });
    const found = await call("run", { until: "keypoints", again: false });
    worker.terminate();
    /** The silhouette's larger extent, and a quarter of it round about. */
    const side = ({ width, rgb }: { width: number; rgb: Uint8Array }) => {
      let [left, right, top, bottom] = [Infinity, -1, Infinity, -1];
      for (let i = 0; i < rgb.length / 3; ++i) {
        if (rgb[3 * i] === rgb[0] && rgb[3 * i + 1] === rgb[1] && rgb[3 * i + 2] === rgb[2]) continue;
        const [x, y] = [i % width, Math.floor(i / width)];
        [left, right, top, bottom] = [
          Math.min(left, x),
          Math.max(right, x),
          Math.min(top, y),
          Math.max(bottom, y),
        ];
      }
      return 1.25 * (Math.max(right - left, bottom - top) + 1);
    };
    // biome-ignore lint/suspicious/noExplicitAny: as above
    return found.keypoints.views.map((view: any) => ({ dots: view.landmarks, side: side(view) }));
  }, worker);
}

describe("the keypoint networks", () => {
  test("see in the browser what they see natively", async ({ page }) => {
    const folders = [`${root}/models/generated`, `${root}/models`];
    const tool = `${root}/build/native/vitruvian-landmarks`;
    const native: number[][][] = JSON.parse(
      execFileSync(tool, [`${folders[0]}/sample.ply`, ...folders]).toString(),
    );
    const seen = await seenByPage(page);
    expect(seen.length).toBe(native.length);
    const differences = seen.flatMap(({ dots, side }, v) =>
      dots.map(({ x, y }, i) => (256 / side) * Math.hypot(x - native[v]![i]![0]!, y - native[v]![i]![1]!)),
    );
    differences.sort((a, b) => a - b);
    const worst = differences.at(-1)!;
    const middle = differences[differences.length >> 1]!;
    console.log(`median ${middle.toFixed(4)}, largest ${worst.toFixed(4)} px of the 256 px crop`);
    expect(worst).toBeLessThan(0.1);
  });
});
