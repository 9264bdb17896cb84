// The service worker: isolation headers where the host sends none, and the offline copy.

export function isolated(): boolean {
  return globalThis.crossOriginIsolated === true;
}

const RELOADED = "vitruvian-reloaded-for-isolation";
let controlled: Promise<void> = Promise.resolve();

/**
 * Registers the service worker. On a host without the isolation headers the page reloads once, so that the worker can
 * supply them. @returns false when the page is about to reload.
 */
export async function installServiceWorker(): Promise<boolean> {
  if (!("serviceWorker" in navigator) || import.meta.env.DEV) return true;
  const container = navigator.serviceWorker;
  const hadController = container.controller !== null;
  const inCharge = new Promise<void>((resolve) => {
    if (container.controller) resolve();
    container.addEventListener("controllerchange", () => resolve(), { once: true });
    setTimeout(resolve, 3000);
  });
  controlled = container
    .register(new URL("sw.js", document.baseURI), { updateViaCache: "none" })
    .then(() => inCharge)
    .catch(() => {});
  if (!isolated() && window.isSecureContext) {
    await controlled;
    if (container.controller && !sessionFlag(RELOADED)) {
      location.reload();
      return false;
    }
  }
  if (!hadController) void controlled.then(keepLoaded);
  return true;
}

/** Resolves when what is loaded from now on goes through the service worker (or there is none). */
export function offlineReady(): Promise<void> {
  return controlled;
}

/** Hands the service worker the names of what was loaded before it was in charge. */
function keepLoaded(): void {
  const urls = performance.getEntriesByType("resource").map((entry) => entry.name);
  navigator.serviceWorker.controller?.postMessage({
    kind: "keep",
    urls: [location.href.split("#")[0], ...urls],
  });
}

/** Sets a flag of this tab; returns whether it was set before. Without storage there is no second chance: true. */
function sessionFlag(key: string): boolean {
  try {
    const before = sessionStorage.getItem(key) !== null;
    sessionStorage.setItem(key, "1");
    return before;
  } catch {
    return true;
  }
}
