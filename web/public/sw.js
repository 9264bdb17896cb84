// One service worker, two duties: the isolation headers that threads need where the host does not send them, and a copy of
// everything that was loaded, for when the network is gone.
const CACHE = "vitruvian-1";
const POLICY =
  "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; connect-src 'self' blob: data:; img-src 'self' blob: data:";

self.addEventListener("install", () => self.skipWaiting());

self.addEventListener("activate", (event) => {
  const clean = async () => {
    for (const name of await caches.keys()) {
      if (name.startsWith("vitruvian-") && name !== CACHE) await caches.delete(name);
    }
    await self.clients.claim();
  };
  event.waitUntil(clean());
});

/** What the page loaded before this worker was in charge. */
self.addEventListener("message", (event) => {
  if (event.data?.kind !== "keep") return;
  const keep = async () => {
    const cache = await caches.open(CACHE);
    for (const url of event.data.urls) {
      if (new URL(url).origin !== self.location.origin || (await cache.match(url))) continue;
      const response = await fetch(url).catch(() => null);
      if (response?.ok) await cache.put(url, response);
    }
    event.source?.postMessage({ kind: "kept" });
  };
  event.waitUntil(keep());
});

function withHeaders(response) {
  if (response.status === 0 || response.type === "opaqueredirect") return response;
  const headers = new Headers(response.headers);
  headers.set("Cross-Origin-Opener-Policy", "same-origin");
  headers.set("Cross-Origin-Embedder-Policy", "require-corp");
  headers.set("Cross-Origin-Resource-Policy", "same-origin");
  headers.set("Content-Security-Policy", POLICY);
  const empty = response.status === 204 || response.status === 304;
  return new Response(empty ? null : response.body, {
    status: response.status,
    statusText: response.statusText,
    headers,
  });
}

async function answer(event) {
  const { request } = event;
  const cache = await caches.open(CACHE);
  const url = new URL(request.url);
  url.hash = "";
  // Names under assets/ hold a hash of the content: a copy never goes stale.
  if (url.pathname.includes("/assets/")) {
    const kept = await cache.match(url);
    if (kept) return withHeaders(kept);
  }
  try {
    const response = await fetch(request, request.mode === "navigate" ? {} : { cache: "no-cache" });
    if (response.status === 200) event.waitUntil(cache.put(url, response.clone()));
    return withHeaders(response);
  } catch (error) {
    const kept = await cache.match(url, { ignoreSearch: request.mode === "navigate" });
    if (kept) return withHeaders(kept);
    throw error;
  }
}

self.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET" || new URL(request.url).origin !== self.location.origin) return;
  event.respondWith(answer(event));
});
