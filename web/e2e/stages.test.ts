import type { Page } from "playwright-core";
import { describe, expect } from "vitest";
import type { Registration } from "../src/core/types";
import { downloaded, openSample, PATIENCE_MS, test, verdict } from "./harness";

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
