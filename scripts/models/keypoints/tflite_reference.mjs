// Runs the original .tflite networks on the inputs of `parity.py write` in the TFLite C++ runtime, as compiled to WASM by
// the npm package @tensorflow/tfjs-tflite (0.0.1-alpha.10), inside Chromium. Needed only to make the reference file anew.
//
// usage: node tflite_reference.mjs RAW_DIR POSE_PACKAGE NODE_MODULES     (NODE_MODULES: with playwright-core as well)

import { createReadStream, readFileSync, statSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { join, normalize, resolve } from 'node:path';

const [raw, posePackage, nodeModules] = process.argv.slice(2).map((path) => resolve(path));
if (!nodeModules) {
  console.error('usage: node tflite_reference.mjs RAW_DIR POSE_PACKAGE NODE_MODULES');
  process.exit(2);
}
const { chromium } = createRequire(join(nodeModules, 'x.js'))('playwright-core');

const roots = {
  raw,
  models: posePackage,
  wasm: join(nodeModules, '@tensorflow/tfjs-tflite/wasm'),
};
const types = { js: 'text/javascript', wasm: 'application/wasm', html: 'text/html' };
const page = `<script>var exports = {};</script><script src="/wasm/tflite_web_api_client.js"></script>`;
const server = createServer((request, response) => {
  if (request.url === '/') {
    response.setHeader('content-type', 'text/html');
    response.end(page);
    return;
  }
  const [, root, ...rest] = decodeURIComponent(request.url).split('/');
  const path = roots[root] && join(roots[root], normalize(rest.join('/')));
  if (!path || !statSync(path, { throwIfNoEntry: false })) {
    response.writeHead(404).end();
    return;
  }
  response.setHeader('content-type', types[path.split('.').pop()] ?? 'application/octet-stream');
  createReadStream(path).pipe(response);
});
await new Promise((done) => server.listen(0, '127.0.0.1', done));

/** In the page: outputs of one run in graph order, each a plain array with its shape. */
async function runInPage({ model, input }) {
  const api = exports.tfweb;
  api.tflite_web_api.setWasmPath('/wasm/');
  const buffer = async (url) => (await fetch(url)).arrayBuffer();
  const runner = await api.TFLiteWebModelRunner.create(await buffer(model), { numThreads: 1 });
  runner.getInputs()[0].data().set(new Float32Array(await buffer(input)));
  if (!runner.infer()) throw new Error('inference failed');
  return runner.getOutputs().map((o) => ({ shape: o.shape, values: Array.from(o.data()) }));
}

const models = { landmarks: '/models/pose_landmark_full.tflite', detector: '/models/pose_solution_packed_assets.data' };
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-background-networking', '--disable-component-update'],
});
try {
  const tab = await browser.newPage();
  await tab.goto(`http://127.0.0.1:${server.address().port}/`);
  for (const job of JSON.parse(readFileSync(join(raw, 'jobs.json'), 'utf8'))) {
    const results = await tab.evaluate(runInPage, {
      model: models[job.network],
      input: `/raw/${job.network}.${job.name}.image.f32`,
    });
    for (const [output, size] of Object.entries(job.outputs)) {
      const match = results.filter((r) => r.values.length === size);
      if (match.length !== 1) throw new Error(`${job.network}: ${match.length} outputs of ${size} values`);
      writeFileSync(join(raw, `${job.network}.${job.name}.${output}.f32`), new Float32Array(match[0].values));
    }
    console.log(job.network, job.name);
  }
} finally {
  await browser.close();
  server.close();
}
