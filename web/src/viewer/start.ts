// Starts the 3D view without holding up the page: each thing that takes time has a turn of its own.
import type { Viewer } from "./viewer";

/** The browser's graphics process is not waited for any longer. */
const WAKING_MS = 3000;

/** Program, graphics context and scene; three.js is loaded here. @throws Error when the browser has no WebGL. */
export async function startViewer(canvas: HTMLCanvasElement): Promise<Viewer> {
  const [{ createContext, Viewer }] = await Promise.all([import("./viewer"), graphicsAwake()]);
  await turn();
  const context = createContext(canvas);
  await turn();
  const viewer = new Viewer(canvas, context);
  await turn();
  return viewer;
}

function turn(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve));
}

/** Resolves when the browser's graphics process is up: a worker waits for it instead of the page. */
function graphicsAwake(): Promise<void> {
  return new Promise((resolve) => {
    const worker = new Worker(new URL("./warm.worker.ts", import.meta.url), { type: "module", name: "warm" });
    worker.onmessage = () => resolve();
    worker.onerror = () => resolve();
    setTimeout(resolve, WAKING_MS);
  });
}
