import type { Page } from "playwright-core";

/**
 * Bytes of JavaScript memory after a collection: of the page, and of the worker that holds the core (WASM included).
 * The core's threads count the same shared memory again and are left out.
 */
export async function scriptBytes(page: Page): Promise<{ page: number; worker: number }> {
  const breakdown: { bytes: number; attribution: { scope: string }[] }[] = await page.evaluate(async () => {
    // @ts-expect-error: Chromium only
    return (await performance.measureUserAgentSpecificMemory()).breakdown;
  });
  const of = (scope: string) =>
    breakdown.filter(({ attribution }) => attribution[0]?.scope === scope).map(({ bytes }) => bytes);
  return {
    page: of("Window").reduce((sum, bytes) => sum + bytes, 0),
    worker: Math.max(0, ...of("DedicatedWorkerGlobalScope")),
  };
}
