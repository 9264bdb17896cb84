import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { describe, expect } from "vitest";
import type { Registration } from "../src/core/types";
import { downloaded, drop, openSample, PATIENCE_MS, root, test, verdict } from "./harness";

/** The default body in the format that SMPL files have. */
function smplFile(): Buffer {
  const folder = mkdtempSync(join(tmpdir(), "vitruvian-e2e-"));
  execFileSync("/usr/bin/python3", [`${root}/tests/smpl/make_smpl_files.py`, folder, "own"]);
  return readFileSync(join(folder, "own_smpl.npz"));
}

const section = (page: Page) => page.getByRole("region", { name: "Own model files" });

describe("a user's own body model", () => {
  test("is dropped, used, kept when asked, and forgotten", async ({ page }) => {
    const file = smplFile();
    await drop(page, "own_smpl.npz", file);
    // Its landmarks are learnt now, once.
    await section(page)
      .getByText(/own_smpl.*\(smpl\): 6,799 vertices, 24 joints, 16 shape components/)
      .waitFor({ timeout: PATIENCE_MS });
    const keep = section(page).getByRole("checkbox");
    await keep.check();
    await section(page).getByText("Kept in this browser").waitFor();
    await page.reload();
    await page.keyboard.press("4");
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
    await page.reload();
    await page.keyboard.press("4");
    await section(page).waitFor();
    expect(await section(page).getByText("own_smpl.npz").count()).toBe(0);
  });
});
