import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { boxObj, launch, pick, serve, watch } from "./harness";

let browser: Browser;

beforeAll(async () => {
  browser = await launch();
});

afterAll(() => browser?.close());

describe("hosting", () => {
  it("works under a sub-path of a host that sends no headers, with threads", async () => {
    const site = await serve({ base: "/some/where/", isolation: false });
    const context = await browser.newContext();
    const seen = watch(context);
    const page = await context.newPage();
    await page.goto(site.url);
    await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
    expect(await page.evaluate(() => crossOriginIsolated)).toBe(true);
    await pick(page, { name: "box.obj", buffer: boxObj(1.7) });
    await page.getByText("box.obj").waitFor();
    expect(seen.requests.some((url) => url.includes("/some/where/wasm/threads/"))).toBe(true);
    expect(seen.requests.filter((url) => !url.startsWith(site.url) && !url.startsWith("blob:"))).toEqual([]);
    expect(seen.complaints).toEqual([]);
    await context.close();
    await site.close();
  });

  it("works without threads, and says so", async () => {
    const site = await serve({ isolation: false });
    const context = await browser.newContext({ serviceWorkers: "block" });
    const page = await context.newPage();
    await page.goto(site.url);
    await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
    expect(await page.evaluate(() => crossOriginIsolated)).toBe(false);
    await pick(page, { name: "box.obj", buffer: boxObj(1.7) });
    await page.getByText("does not allow threads").waitFor();
    await context.close();
    await site.close();
  });

  it("works with the server gone, once it was used", async () => {
    const site = await serve();
    const context = await browser.newContext();
    const page = await context.newPage();
    await page.goto(site.url);
    await pick(page, { name: "box.obj", buffer: boxObj(1.7) });
    await page.getByText("box.obj").waitFor();
    await page.getByRole("toolbar", { name: "View" }).waitFor();
    await page.waitForTimeout(1000);
    await site.close();
    await page.reload();
    await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
    await pick(page, { name: "again.obj", buffer: boxObj(1.7) });
    await page.getByText("again.obj").waitFor();
    await context.close();
  });
});
