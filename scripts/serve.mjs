// Serves a folder on 127.0.0.1 with the headers that give the page shared memory (threads).
// usage: node scripts/serve.mjs FOLDER [--port N] [--base /PATH/] [--no-isolation]
import { createReadStream } from "node:fs";
import { stat } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize, resolve, sep } from "node:path";
import { pipeline } from "node:stream";
import { parseArgs } from "node:util";

const TYPES = {
  ".css": "text/css; charset=utf-8",
  ".html": "text/html; charset=utf-8",
  ".ico": "image/x-icon",
  ".js": "text/javascript; charset=utf-8",
  ".json": "application/json",
  ".mjs": "text/javascript; charset=utf-8",
  ".png": "image/png",
  ".svg": "image/svg+xml",
  ".txt": "text/plain; charset=utf-8",
  ".wasm": "application/wasm",
  ".webmanifest": "application/manifest+json",
};

const ISOLATION = {
  "Cross-Origin-Opener-Policy": "same-origin",
  "Cross-Origin-Embedder-Policy": "require-corp",
  "Cross-Origin-Resource-Policy": "same-origin",
};

/** A server of `folder` under the URL path `base`; `isolation: false` leaves out the headers, as plain hosts do. */
export function createStaticServer(folder, { base = "/", isolation = true } = {}) {
  const root = resolve(folder);
  return createServer(async (request, response) => {
    const fail = (status) => response.writeHead(status, { "Content-Type": "text/plain" }).end(`${status}\n`);
    if (request.method !== "GET" && request.method !== "HEAD") return fail(405);
    let path;
    try {
      path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    } catch {
      return fail(400);
    }
    if (!path.startsWith(base) || path.includes("\0")) return fail(404);
    path = path.slice(base.length);
    const file = join(root, normalize(path === "" || path.endsWith("/") ? `${path}index.html` : path));
    if (file !== root && !file.startsWith(root + sep)) return fail(404);
    const info = await stat(file).catch(() => null);
    if (!info?.isFile()) return fail(404);
    const tag = `"${info.size.toString(16)}-${Math.round(info.mtimeMs).toString(16)}"`;
    const headers = {
      ...(isolation ? ISOLATION : {}),
      "Cache-Control": "no-cache",
      "Content-Type": TYPES[extname(file)] ?? "application/octet-stream",
      ETag: tag,
      "X-Content-Type-Options": "nosniff",
    };
    if (request.headers["if-none-match"] === tag) return response.writeHead(304, headers).end();
    response.writeHead(200, { ...headers, "Content-Length": info.size });
    if (request.method === "HEAD") return response.end();
    pipeline(createReadStream(file), response, () => {});
  });
}

if (process.argv[1] && resolve(process.argv[1]) === new URL(import.meta.url).pathname) {
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: {
      port: { type: "string", default: "8080" },
      base: { type: "string", default: "/" },
      "no-isolation": { type: "boolean", default: false },
    },
  });
  const server = createStaticServer(positionals[0] ?? ".", {
    base: values.base,
    isolation: !values["no-isolation"],
  });
  server.on("error", (error) => {
    console.error(
      error.code === "EADDRINUSE"
        ? `port ${values.port} is taken: choose another with --port N`
        : `cannot serve: ${error.message}`,
    );
    process.exit(1);
  });
  server.listen(Number(values.port), "127.0.0.1", () => {
    console.log(`serving http://127.0.0.1:${values.port}${values.base} (Ctrl+C stops)`);
  });
}
