// Wakes the browser's graphics process, which the first that asks for a context has to wait for: better a worker than
// the page.
const scope = self as unknown as { postMessage(message: string): void; close(): void };

try {
  new OffscreenCanvas(1, 1).getContext("webgl2");
} finally {
  scope.postMessage("awake");
  scope.close();
}
