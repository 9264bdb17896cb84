import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { afterAll, describe, expect } from "vitest";
import type { Registration } from "../src/core/types";
import { downloaded, drop, dropFiles, openSample, PATIENCE_MS, root, test, verdict } from "./harness";

/** The default body in the formats that users' files have. */
const folder = mkdtempSync(join(tmpdir(), "vitruvian-e2e-"));
execFileSync("/usr/bin/python3", [`${root}/tests/smpl/make_smpl_files.py`, folder, "own"]);
afterAll(() => rmSync(folder, { recursive: true }));
const path = (name: string) => join(folder, name);

/** Visits the page again, at its list of models. A key or a drop may come before the page listens, a click not. */
async function reload(page: Page): Promise<void> {
  await page.reload();
  await page.locator("nav .stage", { hasText: "Pose" }).click();
}

/** Lets the page find where landmarks lie on these bodies among what it kept: they are the default body's. */
async function keepLandmarks(page: Page, names: string[]): Promise<void> {
  const text = readFileSync(`${root}/models/landmarks.json`).toString();
  const learnt = names.map((name) => [
    createHash("sha256")
      .update(readFileSync(path(name)))
      .digest("hex"),
    text,
  ]);
  await page.evaluate(async (learnt) => {
    const folder = await (await navigator.storage.getDirectory()).getDirectoryHandle("models");
    const file = await folder.getFileHandle("index.json");
    const index = JSON.parse(await (await file.getFile()).text());
    const stream = await file.createWritable();
    await stream.write(JSON.stringify({ ...index, learnt }));
    await stream.close();
  }, learnt);
}

const section = (page: Page) => page.getByRole("region", { name: "Own model files" });

describe("a user's own body model", () => {
  test("is dropped, used, kept when asked, and forgotten", async ({ page }) => {
    const file = readFileSync(path("own_smpl.npz"));
    await drop(page, "own_smpl.npz", file);
    // Its landmarks are learnt now, once.
    await section(page)
      .getByText(/own_smpl.*\(smpl\): 6,799 vertices, 24 joints, 16 shape components/)
      .waitFor({ timeout: PATIENCE_MS });
    const keep = section(page).getByRole("checkbox");
    await keep.check();
    await section(page).getByText("Kept in this browser").waitFor();
    await reload(page);
    await section(page).getByText("own_smpl.npz").waitFor();
    expect(await keep.isChecked()).toBe(true);

    await page.keyboard.press("1");
    await openSample(page);
    await page.keyboard.press("r");
    expect(await verdict(page)).toBe("OK");
    const { model } = JSON.parse((await downloaded(page, "registration.json")).toString()) as Registration;
    expect(model).toMatchObject({
      family: "smpl",
      betas: 16,
      sha256: createHash("sha256").update(file).digest("hex"),
    });

    // A damaged one changes nothing.
    await drop(page, "cut.npz", file.subarray(0, file.length / 2));
    await page.getByText("A model file cannot be used.").waitFor({ timeout: PATIENCE_MS });
    await section(page).getByText("own_smpl.npz").waitFor();

    await section(page).getByRole("button", { name: "Bundled model again" }).click();
    await page.getByRole("radio", { name: "Neutral" }).waitFor({ state: "attached", timeout: PATIENCE_MS });
    await reload(page);
    await section(page).waitFor();
    expect(await section(page).getByText("own_smpl.npz").count()).toBe(0);
  });

  test("can be of every kind, and files that belong together come together or one by one", async ({
    page,
  }) => {
    const shows = (text: string) => section(page).getByText(text).waitFor({ timeout: PATIENCE_MS });
    /** Names of the files in use, each with its button. */
    const listed = () =>
      section(page)
        .getByRole("button", { name: /^Remove / })
        .evaluateAll((buttons) => buttons.map((button) => button.ariaLabel?.replace("Remove ", "")));

    await dropFiles(page, [path("own_vposer.ckpt")]);
    await shows("own_vposer.ckpt");
    await section(page).getByRole("checkbox").check();
    await section(page).getByText("Kept in this browser").waitFor();
    await keepLandmarks(page, ["own_smpl.pkl", "own_smplh.npz", "own_star.npz", "own_smplx.npz"]);
    await reload(page);

    await dropFiles(page, [path("own_dmpl.npz"), path("own_smplh.npz")]);
    await shows("own_smplh (smplh): 6,799 vertices, 52 joints, 16 shape components");
    expect(await listed()).toEqual(["own_smplh.npz", "own_dmpl.npz", "own_vposer.ckpt"]);
    // Soft tissue goes with its body.
    await dropFiles(page, [path("own_star.npz")]);
    await shows("own_star (star): 6,799 vertices, 24 joints");
    expect(await listed()).toEqual(["own_star.npz", "own_vposer.ckpt"]);
    await dropFiles(page, [path("own_smpl.pkl")]);
    await shows("own_smpl (smpl): 6,799 vertices, 24 joints");
    await dropFiles(page, [path("own_dmpl.npz")]);
    await shows("own_dmpl.npz");
    expect(await listed()).toEqual(["own_smpl.pkl", "own_dmpl.npz", "own_vposer.ckpt"]);
    await section(page).getByRole("button", { name: "Remove own_vposer.ckpt" }).click();
    await section(page).getByText("own_vposer.ckpt").waitFor({ state: "detached", timeout: PATIENCE_MS });

    // A scan among them is opened.
    await dropFiles(page, [path("own_smplx.npz"), `${root}/models/generated/sample.ply`]);
    await page.getByText("Vertices", { exact: true }).waitFor({ timeout: PATIENCE_MS });
    await page.keyboard.press("r");
    expect(await verdict(page)).toBe("OK");
    const { model, parameters } = JSON.parse(
      (await downloaded(page, "registration.json")).toString(),
    ) as Registration;
    expect(model).toMatchObject({ family: "smplx", joints: 55 });
    expect(parameters?.pose.length).toBe(165);

    // What does not fit, or is twice there, is told beside the list; models and result stay.
    for (const [names, told] of [
      [["own_dmpl.npz"], "goes with SMPL or SMPL+H, not with own_smplx (smplx)"],
      [["own_smpl.npz", "own_star.npz"], "own_smpl.npz and own_star.npz are for the same"],
    ] as const) {
      await dropFiles(page, names.map(path));
      await page.getByRole("alert").getByText(told).waitFor({ timeout: PATIENCE_MS });
      expect(await listed()).toEqual(["own_smplx.npz"]);
    }
    await page.keyboard.press("6");
    expect(await verdict(page)).toBe("OK");
    expect((await downloaded(page, "registration.json")).length).toBeGreaterThan(1000);

    await page.keyboard.press("4");
    await section(page).getByRole("button", { name: "Bundled model again" }).click();
    await section(page).getByText("drop them on the page").waitFor({ timeout: PATIENCE_MS });
  });
});
