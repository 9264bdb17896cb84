import { readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { describe, expect } from "vitest";
import { boxObj, drop, pick, root, test } from "./harness";

const FIRST_PAINT_BYTES = 250_000;

describe("the page", () => {
  test("paints first from little, and loads neither viewer nor core", async ({ page, seen }) => {
    await page.waitForTimeout(500);
    const loaded = seen.requests.map((url) => new URL(url).pathname.slice(1) || "index.html");
    expect(loaded.some((name) => /viewer|wasm|onnx|ort/.test(name))).toBe(false);
    const scripts = [...new Set(loaded)].filter((name) => /\.(js|css|html)$/.test(name));
    const size = (name: string) => gzipSync(readFileSync(`${root}/web/dist/${name}`)).length;
    expect(scripts.reduce((sum, name) => sum + size(name), 0)).toBeLessThan(FIRST_PAINT_BYTES);
  });

  test("is isolated, forbids evaluation, and asks nobody else", async ({ page, seen }) => {
    expect(await page.evaluate(() => crossOriginIsolated)).toBe(true);
    const policy = await page.locator('meta[http-equiv="Content-Security-Policy"]').getAttribute("content");
    expect(policy).toContain("default-src 'self'");
    expect(policy).not.toContain("'unsafe-eval'");
    const refused = await page.evaluate(() =>
      fetch("https://example.invalid/").then(String, () => "refused"),
    );
    expect(refused).toBe("refused");
    // The policy's own message about this attempt, and no other.
    expect(seen.complaints.some((text) => text.includes("example.invalid"))).toBe(true);
    seen.complaints.length = 0;
  });

  test("goes through the stages by keyboard and names them", async ({ page }) => {
    await page.keyboard.press("3");
    expect(await page.getByRole("button", { name: "Keypoints" }).getAttribute("aria-current")).toBe("step");
    await page.keyboard.press("?");
    await page.getByRole("dialog", { name: "Keys" }).waitFor();
    await page.keyboard.press("Escape");
    expect(await page.getByRole("dialog").count()).toBe(0);
  });

  test("says who made it, under what licence, and what it is not", async ({ page, site, context }) => {
    await page.getByRole("button", { name: "About" }).click();
    const about = page.getByRole("dialog", { name: "About Vitruvian" });
    expect(await about.innerText()).toMatch(/Not a medical device/);
    for (const link of await about.getByRole("link").all()) {
      const url = new URL((await link.getAttribute("href"))!, site.url);
      expect((await context.request.get(url.href)).status()).toBe(200);
    }
  });

  test("changes its theme and remembers it", async ({ page }) => {
    const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await page.getByLabel("Theme").selectOption("light");
    const light = await background();
    await page.getByLabel("Theme").selectOption("dark");
    expect(await background()).not.toBe(light);
    await page.reload();
    await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
    expect(await background()).not.toBe(light);
  });

  test("fits a phone", async ({ page }) => {
    await page.setViewportSize({ width: 390, height: 800 });
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    expect(overflow).toBeLessThanOrEqual(0);
  });
});

describe("a scan", () => {
  test("is opened by dropping, and described", async ({ page }) => {
    await drop(page, "Ærø box.obj", boxObj(1750));
    await page.getByText("Ærø box.obj").waitFor();
    expect(await page.locator("aside").innerText()).toMatch(/Vertices\s+36\s+Faces\s+64/);
    await page.getByRole("toolbar", { name: "View" }).waitFor();
  });

  test("is refused with words and the place when it is broken, and the next one opens", async ({ page }) => {
    await pick(page, {
      name: "broken.ply",
      buffer: Buffer.from("ply\nformat ascii 1.0\nelement vertex 4\n"),
    });
    const alert = page.getByRole("alert");
    await alert.waitFor();
    expect(await alert.innerText()).toMatch(/damaged or incomplete[\s\S]*broken\.ply/);
    await pick(page, { name: "notes.docx", buffer: Buffer.from("PK\u0003\u0004 not a scan") });
    await page.getByText("This kind of file cannot be read.").waitFor();
    await pick(page, { name: "box.obj", buffer: boxObj(1.7) });
    await page.getByText("box.obj").waitFor();
    expect(await page.getByRole("alert").count()).toBe(0);
  });
});
