import { readdirSync, readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";

const isolation = {
  "Cross-Origin-Opener-Policy": "same-origin",
  "Cross-Origin-Embedder-Policy": "require-corp",
  "Cross-Origin-Resource-Policy": "same-origin",
};

/** Puts every notice beside the page. */
function notices(): Plugin {
  return {
    name: "notices",
    generateBundle() {
      const add = (fileName: string, path: string) =>
        this.emitFile({ type: "asset", fileName, source: readFileSync(new URL(path, import.meta.url)) });
      add("licences/LICENSE.txt", "../LICENSE");
      add("licences/THIRD_PARTY.md", "../THIRD_PARTY.md");
      add("licences/CITATION.cff", "../CITATION.cff");
      for (const name of readdirSync(new URL("../scripts/licences", import.meta.url))) {
        add(`licences/texts/${name}`, `../scripts/licences/${name}`);
      }
    },
  };
}

/** The development server puts styles and its client into the page inline, which the page's policy forbids. */
function withoutPolicyInDevelopment(): Plugin {
  return {
    name: "without-policy-in-development",
    apply: "serve",
    transformIndexHtml: (html) => html.replace(/<meta http-equiv="Content-Security-Policy"[^>]*>/, ""),
  };
}

const { version } = JSON.parse(readFileSync(new URL("package.json", import.meta.url), "utf8"));

export default defineConfig({
  base: "./",
  define: { __VERSION__: JSON.stringify(version) },
  plugins: [notices(), withoutPolicyInDevelopment()],
  server: { headers: isolation },
  preview: { headers: isolation },
  worker: { format: "es" },
  build: { target: "es2022", modulePreload: { polyfill: false }, chunkSizeWarningLimit: 1200 },
  optimizeDeps: { exclude: ["onnxruntime-web"] },
  oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
});
