import { readFileSync } from "node:fs";
import { describe, expect } from "vitest";
import { PATIENCE_MS, test } from "./harness";

describe("the body model", () => {
  test("changes its shape and pose by sliders, and goes back", async ({ page }) => {
    await page.getByRole("button", { name: "Body", exact: true }).click();
    const height = page.getByText("Standing height");
    await height.waitFor({ timeout: PATIENCE_MS });
    const mean = await height.innerText();
    const first = page.getByLabel("Component 1", { exact: true });
    await first.focus();
    await page.keyboard.press("End");
    await expect.poll(() => height.innerText()).not.toBe(mean);
    await page.getByText("Left knee").click();
    await page.getByLabel("Left knee about X (nod)").focus();
    await page.keyboard.press("End");
    const picture = page.waitForEvent("download");
    await page.getByRole("button", { name: "PNG" }).click();
    expect(
      readFileSync(await (await picture).path())
        .subarray(1, 4)
        .toString(),
    ).toBe("PNG");
    await page.getByRole("button", { name: "Mean shape" }).click();
    await expect.poll(() => height.innerText()).toBe(mean);
    await page.getByRole("button", { name: "Rest pose" }).click();
    expect(await page.getByLabel("Left knee about X (nod)").getAttribute("aria-valuetext")).toBe("0°");
  });
});
