import { defineConfig } from "vitest/config";

// One browser at a time: the tests measure, and a registration uses all cores.
export default defineConfig({
  test: {
    include: ["e2e/**/*.test.ts"],
    testTimeout: 180_000,
    hookTimeout: 120_000,
    fileParallelism: false,
  },
});
