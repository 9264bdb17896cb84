import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { describe, expect } from "vitest";
import type { Registration } from "../src/core/types";
import {
  apart,
  choose,
  drag,
  editJoints,
  exportedJoints,
  FlatView,
  open,
  type Places,
  replayed,
  result,
  touch,
  transformed,
} from "./editing";
import { downloaded, PATIENCE_MS, root, test, verdict } from "./harness";
import { noisy, scanOfModel, twoPeople } from "./scans";

/** Sitting with the arms crossed before the chest: 24 joints, axis-angle. */
const ARMS_CROSSED = [
  ...[0, 0, 0, -1.78, -0.09, 0.29, -1.8, -0.07, -0.29, 0.06, 0.01, 0, 2.14, 0, 0, 1.92, 0, 0, 0.02, 0, 0],
  ...[0.44, 0.07, 0.19, -0.25, -0.09, -0.07, 0.02, 0, 0, -0.01, 0, 0, -0.16, 0, 0, 0.07, -0.19, -0.14],
  ...[0, -0.07, 0.12, -0.01, 0.09, -0.17, 0.04, -0.12, -0.08, -0.12, -1.51, 1.63, -0.27, 1.84, -1.36],
  ...[0.28, -1.82, 0.38, -0.04, 1.77, 0.05, 0.92, 0.17, -0.42, -0.14, 0.14, 0.45, 0, 0, 0, 0, 0, 0],
];
/** What a hand that means to hit a place misses it by. */
const HAND_M = 0.02;

async function registerEdited(page: Page): Promise<Registration> {
  await page.getByRole("button", { name: "Register with these edits" }).click();
  await page.locator(".editor").waitFor({ state: "detached", timeout: PATIENCE_MS });
  await page.locator(".progress").waitFor({ state: "detached", timeout: PATIENCE_MS });
  await verdict(page);
  return result(page);
}

async function savedProject(page: Page, folder: string): Promise<string> {
  await editJoints(page);
  const file = join(folder, "saved.project.json");
  writeFileSync(file, await downloaded(page, "Save project"));
  return file;
}

function distance(a: Places[string], b: Places[string]): number {
  return Math.hypot(...a.map((value, k) => value - b[k]!));
}

function json(name: string, buffer: Buffer) {
  return { name, buffer, mimeType: "application/json" };
}

const withoutTimes = (text: string) => text.replace(/"timing_ms":\s*\{[^}]*\}/, "");

describe("the editor", () => {
  test("cuts a second person away and its project gives the same on the command line", async ({ page }) => {
    const folder = mkdtempSync(join(tmpdir(), "vitruvian-editor-"));
    const sample = readFileSync(`${root}/models/generated/sample.ply`);
    const scan = await open(page, folder, "two.ply", twoPeople(sample, 2000));
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
    const inPage = await registerEdited(page);
    expect(inPage.verdict.status).toBe("ok");

    const project = await savedProject(page, folder);
    const { registration } = replayed(scan, project, join(folder, "out"));
    expect(registration.verdict.status).toBe("ok");
    expect(apart(registration, inPage)).toBeLessThan(0.5);
  });

  test("repairs crossed arms in a noisy scan by dragged joints, and so does the project", async ({
    page,
  }) => {
    const folder = mkdtempSync(join(tmpdir(), "vitruvian-editor-"));
    const { scan, joints } = scanOfModel(root, join(folder, "made"), ARMS_CROSSED, 1672, 6000);
    const file = await open(page, folder, "crossed.ply", noisy(scan, 0.008, 1));
    await page.keyboard.press("r");
    expect(await verdict(page)).not.toBe("OK");
    const before = await result(page);
    const truth: Places = Object.fromEntries(
      Object.entries(joints).map(([name, place]) => [
        name,
        transformed(before.alignment!.body_from_scan, place),
      ]),
    );

    await editJoints(page);
    // Places are meant, not the middle of whichever arm is in front.
    await page.getByLabel("Snap to the middle of the body").uncheck();
    const shown = async (): Promise<Places> =>
      Object.fromEntries(
        Object.entries(await exportedJoints(page)).map(([name, place]) => [
          name,
          transformed(before.alignment!.body_from_scan, place),
        ]),
      );
    const found = await shown();
    const arms = ["left_elbow", "right_elbow", "left_wrist", "right_wrist"];
    let edits = 1;
    for (const pane of ["front", "side"] as const) {
      const view = await FlatView.of(page, pane, found);
      for (const joint of arms) {
        const from = await choose(page, joint, pane);
        await drag(page, [from, view.pixel(truth[joint]!)]);
        edits += 1;
        await page.getByText(`${edits} edits`, { exact: true }).waitFor();
      }
    }
    const placed = await shown();
    for (const joint of arms)
      expect(Math.hypot(...placed[joint]!.map((v, k) => v - truth[joint]![k]!)), joint).toBeLessThan(HAND_M);
    const repaired = await registerEdited(page);
    expect(repaired.verdict).toMatchObject({ status: "ok", reasons: [] });
    expect(repaired.keypoints.find(({ joint }) => joint === "left_wrist")!.source).toBe("user");

    const project = await savedProject(page, folder);
    const [first, second] = ["a", "b"].map((out) => replayed(file, project, join(folder, out)));
    expect(first!.registration.verdict.status).toBe("ok");
    expect(apart(first!.registration, repaired)).toBeLessThan(0.5);
    expect(withoutTimes(second!.text)).toBe(withoutTimes(first!.text));
  });

  test("moves, mirrors, swaps, locks and resets joints, by keys, mouse and touch, and brings edits back from files", async ({
    page,
    context,
  }) => {
    // In metres, along Y; few vertices, so that three views are drawn quickly without a graphics card.
    const folder = mkdtempSync(join(tmpdir(), "vitruvian-editor-"));
    const { scan } = scanOfModel(root, join(folder, "made"), new Array(72).fill(0), 1, 6000);
    await open(page, folder, "standing.ply", scan);
    await page.keyboard.press("3");
    await editJoints(page);
    await page.getByLabel("Snap to the middle of the body").uncheck();
    const click = (name: string) => page.getByRole("button", { name, exact: true }).click();
    const edits = (count: number) => page.getByText(`${count} edit${count > 1 ? "s" : ""}`, { exact: true });
    const found = await exportedJoints(page);

    await choose(page, "right_wrist", "front");
    await page.locator("[data-pane=front]").focus();
    await page.keyboard.press("ArrowUp");
    await edits(2).waitFor();
    await page.keyboard.press("Shift+ArrowUp");
    await edits(3).waitFor();
    const nudged = await exportedJoints(page);
    expect(distance(nudged.right_wrist!, found.right_wrist!)).toBeCloseTo(0.011, 6);
    expect(nudged.right_wrist![1] - found.right_wrist![1]).toBeGreaterThan(0.0105);
    await page.keyboard.press("Control+z");
    await page.keyboard.press("Control+z");
    expect(await exportedJoints(page)).toEqual(found);

    const wrist = await choose(page, "left_wrist", "front");
    const aside: [number, number] = [wrist[0] - 30, wrist[1] - 40];
    await click("Lock");
    await drag(page, [wrist, aside]);
    expect(await exportedJoints(page)).toEqual(found);
    await click("Undo");
    await page.getByRole("button", { name: "Lock", exact: true }).waitFor();
    await touch(context, page, wrist, aside);
    await edits(2).waitFor();
    const touched = await exportedJoints(page);
    expect(distance(touched.left_wrist!, found.left_wrist!)).toBeGreaterThan(0.1);

    await page.getByLabel("Move the whole limb").check();
    const elbow = await choose(page, "right_elbow", "side");
    await drag(page, [elbow, [elbow[0] - 25, elbow[1] - 10]]);
    await edits(3).waitFor();
    const together = await exportedJoints(page);
    const shift = together.right_elbow!.map((value, k) => value - found.right_elbow![k]!);
    expect(Math.hypot(...shift)).toBeGreaterThan(0.05);
    together.right_wrist!.forEach((value, k) => {
      expect(value - found.right_wrist![k]!).toBeCloseTo(shift[k]!, 9);
    });

    await click("Reset joint");
    const reset = await exportedJoints(page);
    expect(reset.right_elbow).toEqual(found.right_elbow);
    expect(reset.right_wrist).toEqual(together.right_wrist);
    await click("Left limbs → right");
    await edits(5).waitFor();
    const mirrored = await exportedJoints(page);
    expect(distance(mirrored.right_wrist!, mirrored.right_elbow!)).toBeCloseTo(
      distance(touched.left_wrist!, touched.left_elbow!),
      9,
    );
    await click("Swap left and right");
    await edits(6).waitFor();
    const swapped = await exportedJoints(page);
    expect(swapped.left_wrist).toEqual(mirrored.right_wrist);
    expect(swapped.right_hip).toEqual(mirrored.left_hip);

    const keypoints = await downloaded(page, "Export keypoints");
    const project = await downloaded(page, "Save project");
    await click("Reset all");
    expect(await exportedJoints(page)).toEqual(found);
    await page.getByLabel("Import keypoints…").setInputFiles(json("swapped.keypoints.json", keypoints));
    await edits(8).waitFor();
    expect(await exportedJoints(page)).toEqual(swapped);
    await page.getByLabel("Open project…").setInputFiles(json("swapped.project.json", project));
    await page.locator(".editor").waitFor({ state: "detached" });
    await page.getByText("6 edits by hand").waitFor();
    await editJoints(page);
    expect(await exportedJoints(page)).toEqual(swapped);
  });
});
