import { defineConfig } from "vitest/config";

// What is measured, and so is no test: scripts/benchmark page.
export default defineConfig({
  test: {
    include: ["benchmark/**/*.test.ts"],
    testTimeout: 1_800_000,
    hookTimeout: 120_000,
    fileParallelism: false,
    reporters: ["default"],
    disableConsoleIntercept: true,
    // A graphics process as on a user's machine, in software: without one the page itself would compose its pictures.
    env: {
      VITRUVIAN_GRAPHICS:
        "--use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --ignore-gpu-blocklist",
    },
  },
});
