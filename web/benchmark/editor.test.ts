// How fast the posed body follows a dragged joint: the core's inverse kinematics alone, with the way to and from its
// worker, and what of it is seen. Figures count only on a machine that does nothing else.
import type { Page } from "playwright-core";
import { describe, expect } from "vitest";
import { choose, editJoints } from "../e2e/editing";
import { openSample, PATIENCE_MS, test } from "../e2e/harness";

const DRAG_MS = 4000;
const LEAST_RATE = 10;

interface Pace {
  rates: number[];
  work: number[];
  answer: number[];
  frames: number;
}

const median = (values: number[]) => [...values].sort((a, b) => a - b)[values.length >> 1]!;

/** Notes every preview and every frame of the page from now on. */
async function watchPace(page: Page): Promise<void> {
  await page.evaluate(() => {
    const pace: Pace = { rates: [], work: [], answer: [], frames: 0 };
    const said = document.querySelector<HTMLElement>("[data-rate]")!;
    new MutationObserver(() => {
      pace.rates.push(Number(said.dataset.rate));
      pace.work.push(Number(said.dataset.workMs));
      pace.answer.push(Number(said.dataset.answerMs));
    }).observe(said, { attributes: true, attributeFilter: ["data-answer-ms"] });
    const frame = () => {
      pace.frames += 1;
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
    Object.assign(window, { pace });
  });
}

describe("the editor", () => {
  test("poses the body at least ten times a second while a joint is dragged", async ({ page }) => {
    await openSample(page);
    await page.keyboard.press("3");
    await editJoints(page);
    for (const pane of ["front", "free"] as const) {
      const [x, y] = await choose(page, "left_wrist", pane);
      await watchPace(page);
      await page.mouse.move(x, y);
      await page.mouse.down();
      const begin = performance.now();
      for (let i = 0; performance.now() - begin < DRAG_MS; ++i)
        await page.mouse.move(x + 25 * Math.sin(i / 9), y - 25 * (1 - Math.cos(i / 13)));
      const pace = await page.evaluate(() => (window as unknown as { pace: Pace }).pace);
      const seconds = (performance.now() - begin) / 1000;
      await page.mouse.up();
      const rate = pace.work.length / seconds;
      console.log(
        `${pane}: ${rate.toFixed(1)} previews/s, core ${median(pace.work).toFixed(1)} ms, ` +
          `question to answer ${median(pace.answer).toFixed(1)} ms, ${(pace.frames / seconds).toFixed(1)} frames/s`,
      );
      await page.getByRole("button", { name: "Undo" }).click({ timeout: PATIENCE_MS });
      expect(rate).toBeGreaterThan(LEAST_RATE);
    }
  });
});
