// What every end-to-end test needs: the built page on a server of its own, in Debian's Chromium, watched.
import { existsSync, readFileSync } from "node:fs";
import type { AddressInfo } from "node:net";
import { resolve } from "node:path";
import { type Browser, type BrowserContext, chromium, type Page } from "playwright-core";
import { test as base, expect } from "vitest";
// @ts-expect-error: the development server is plain JavaScript
import { createStaticServer } from "../../scripts/serve.mjs";

export const root = resolve(import.meta.dirname, "../..");
const dist = resolve(root, "web/dist");

if (!existsSync(dist)) throw new Error("web/dist is missing: run `scripts/test e2e`, which builds it");

export interface Site {
  url: string;
  close(): Promise<void>;
}

/** Serves the built page; `isolation: false` sends no headers, as plain hosts do. */
export async function serve(options: { base?: string; isolation?: boolean } = {}): Promise<Site> {
  const server = createStaticServer(dist, options);
  await new Promise<void>((done) => server.listen(0, "127.0.0.1", done));
  const { port } = server.address() as AddressInfo;
  return {
    url: `http://127.0.0.1:${port}${options.base ?? "/"}`,
    close: () =>
      new Promise((done) => {
        server.close(() => done());
        server.closeAllConnections();
      }),
  };
}

export function launch(): Promise<Browser> {
  return chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      ...(process.env.VITRUVIAN_GRAPHICS?.split(" ") ?? ["--disable-gpu"]),
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      // Memory is measured at once, after a collection.
      "--enable-blink-features=ForceEagerMeasureMemory",
    ],
  });
}

export interface Watch {
  /** console errors, uncaught exceptions, breaches of the page's policy */
  complaints: string[];
  /** every URL that was asked for */
  requests: string[];
}

/** Notes what a page must not do. */
export function watch(context: BrowserContext): Watch {
  const seen: Watch = { complaints: [], requests: [] };
  context.on("console", (message) => {
    // The software renderer of a machine without a graphics card remarks on its own speed.
    if (message.text().includes("GL Driver Message")) return;
    if (message.type() === "error" || message.type() === "warning") seen.complaints.push(message.text());
  });
  context.on("weberror", (error) => seen.complaints.push(String(error.error())));
  context.on("request", (request) => seen.requests.push(request.url()));
  return seen;
}

/** A test on a fresh page of a served site. Afterwards the page must not have complained nor asked another origin. */
export const test = base.extend<{
  $file: { browser: Browser; site: Site };
  $test: { context: BrowserContext; seen: Watch; page: Page };
}>({
  browser: [
    // biome-ignore lint/correctness/noEmptyPattern: vitest reads the names of what a fixture needs
    async ({}, use) => {
      const browser = await launch();
      await use(browser);
      await browser.close();
    },
    { scope: "file" },
  ],
  site: [
    // biome-ignore lint/correctness/noEmptyPattern: as above
    async ({}, use) => {
      const site = await serve();
      await use(site);
      await site.close();
    },
    { scope: "file" },
  ],
  context: async ({ browser }, use) => {
    const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
    await use(context);
    await context.close();
  },
  seen: async ({ context }, use) => use(watch(context)),
  page: async ({ context, seen, site }, use) => {
    const page = await context.newPage();
    await page.goto(site.url);
    await page.getByRole("heading", { name: "Vitruvian" }).waitFor();
    await use(page);
    expect(seen.complaints).toEqual([]);
    expect(seen.requests.filter((url) => !url.startsWith(site.url) && !url.startsWith("blob:"))).toEqual([]);
  },
});

/** A registration, on a machine that does other things too. */
export const PATIENCE_MS = 120_000;

export async function openSample(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Sample scan" }).click();
  await page.getByText("Vertices", { exact: true }).waitFor({ timeout: PATIENCE_MS });
}

/** Waits for the result. @returns its verdict as shown */
export async function verdict(page: Page): Promise<string> {
  await page.locator(".verdict").waitFor({ timeout: PATIENCE_MS });
  return page.locator(".verdict strong").innerText();
}

/** What the button downloads. */
export async function downloaded(page: Page, button: string): Promise<Buffer> {
  const arriving = page.waitForEvent("download");
  await page.getByRole("button", { name: button }).click();
  return readFileSync(await (await arriving).path());
}

/** Puts a file into the page as the file picker does. */
export async function pick(page: Page, file: string | { name: string; buffer: Buffer }): Promise<void> {
  const payload = typeof file === "string" ? file : { ...file, mimeType: "application/octet-stream" };
  await page.getByLabel("Scan file").setInputFiles(payload);
}

/** Drops a file on the page. */
export async function drop(page: Page, name: string, content: Buffer): Promise<void> {
  const transfer = await page.evaluateHandle(
    ([title, base64]) => {
      const bytes = Uint8Array.from(atob(base64!), (letter) => letter.charCodeAt(0));
      const data = new DataTransfer();
      data.items.add(new File([bytes], title!));
      return data;
    },
    [name, content.toString("base64")],
  );
  for (const type of ["dragenter", "dragover", "drop"]) {
    await page.dispatchEvent("main", type, { dataTransfer: transfer });
  }
}

/** Drops files of this computer on the page, all at once. */
export async function dropFiles(page: Page, paths: string[]): Promise<void> {
  const picker = await page.evaluateHandle(() =>
    Object.assign(document.createElement("input"), { type: "file", multiple: true }),
  );
  await picker.asElement()!.setInputFiles(paths);
  await picker.evaluate((input) => {
    const dataTransfer = new DataTransfer();
    for (const file of input.files ?? []) dataTransfer.items.add(file);
    for (const type of ["dragenter", "dragover", "drop"]) {
      document.querySelector("main")!.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true }));
    }
  });
}

/** An OBJ of a box, `height` units high, standing along Y. */
export function boxObj(height: number): Buffer {
  const lines: string[] = [];
  const n = 8;
  for (let i = 0; i <= n; ++i) {
    for (let j = 0; j < 4; ++j) {
      const [x, z] = [j === 0 || j === 3 ? -1 : 1, j < 2 ? -1 : 1];
      lines.push(`v ${(x * height) / 6} ${(i * height) / n} ${(z * height) / 10}`);
    }
  }
  for (let i = 0; i < n; ++i) {
    for (let j = 0; j < 4; ++j) {
      const [a, b] = [4 * i + j + 1, 4 * i + ((j + 1) % 4) + 1];
      lines.push(`f ${a} ${a + 4} ${b + 4} ${b}`);
    }
  }
  return Buffer.from(`${lines.join("\n")}\n`);
}
