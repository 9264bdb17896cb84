// Node 18 and later have fetch(), which Emscripten 3.1.6 would use on a file path.
if (typeof process === "object" && process.versions && process.versions.node) {
  globalThis.fetch = undefined;
}
