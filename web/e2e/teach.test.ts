import { readFileSync } from "node:fs";
import { describe, expect } from "vitest";
import { PATIENCE_MS, test } from "./harness";

describe("the method", () => {
  test("is stepped through, scrubbed as a film, and shows what a change does", async ({ page }) => {
    await page.getByRole("button", { name: "Learn", exact: true }).click();
    await page.locator("main.learn").getByRole("button", { name: "Sample scan" }).click();
    await page.getByRole("button", { name: "Stand it up", exact: true }).click({ timeout: PATIENCE_MS });
    await page.getByText("m tall").waitFor({ timeout: PATIENCE_MS });
    await page.getByRole("button", { name: "4. Fit it" }).click();
    await page.getByRole("button", { name: "Fit", exact: true }).click();
    await page.getByText("Nothing is changed").waitFor({ timeout: PATIENCE_MS });
    // Formulas for eyes and screen readers: MathML.
    expect(await page.getByRole("math").allInnerTexts()).toHaveLength(1);
    expect(await page.locator("math munder").count()).toBe(2);
    const film = page.getByLabel("Iteration", { exact: true });
    expect(await film.inputValue()).toBe("36");
    const marked = () => page.locator(".plot path[stroke-dasharray]").first().getAttribute("d");
    const atTheEnd = await marked();
    await film.focus();
    await page.keyboard.press("Home");
    await page.getByText("0 / 36").waitFor();
    expect(await marked()).not.toBe(atTheEnd);

    await page.getByRole("radio", { name: "T-pose" }).check({ force: true });
    await page.getByText("the joints lie").waitFor({ timeout: PATIENCE_MS });
    const [, apart] = (await page.getByText("the joints lie").innerText()).match(/([\d.]+) mm at most/)!;
    expect(Number(apart)).toBeGreaterThan(0);
    const figure = page.waitForEvent("download");
    await page.getByRole("button", { name: "Energy by term, logarithmic, as SVG" }).click();
    const svg = readFileSync(await (await figure).path(), "utf8");
    expect(svg).toMatch(/^<svg [^>]*xmlns="http:\/\/www.w3.org\/2000\/svg"/);
    expect(svg.match(/<polyline/g)).toHaveLength(6);
    await page.getByRole("button", { name: "5. Judge" }).click();
    const png = page.waitForEvent("download");
    await page.getByRole("button", { name: "Vertices by distance to the scan, as PNG" }).click();
    const picture = readFileSync(await (await png).path());
    expect(picture.subarray(1, 4).toString()).toBe("PNG");
    expect([picture.readUInt32BE(16), picture.readUInt32BE(20)]).toEqual([1200, 450]);
    await page.getByRole("button", { name: "3. Pose a body" }).click();
    await page.getByText("uses no keypoints").waitFor();
  });
});

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
