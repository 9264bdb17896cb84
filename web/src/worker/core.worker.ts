// The worker: holds the core and the networks, answers the page's calls one after the other (a cancel at once).
import type { Calls, EnergyPoint, Kind, Reply, Request } from "../core/messages";
import { CoreError, type Findings, type ScanData } from "../core/types";
import { type ArrayReference, Core } from "./core";
import { answerEditor } from "./editor";
import type { Networks } from "./networks";
import { bodyOf, lessonOf, poseBody } from "./teaching";

const scope = self as unknown as {
  postMessage(message: Reply, transfer?: Transferable[]): void;
  onmessage: (event: MessageEvent<Request>) => void;
};

type Handlers = { [K in Kind]: (args: Calls[K]["args"]) => Promise<Calls[K]["result"]> };

let core: Core | null = null;
let base = "";
let ready: Promise<Networks> | null = null;

function theCore(): Core {
  if (!core) throw new CoreError("internal", "the core was not started");
  return core;
}

/** Models and networks, loaded once, when the first scan has been opened. */
function prepared(): Promise<Networks> {
  if (!ready) {
    ready = prepare(theCore());
    ready.catch(() => {
      ready = null;
    });
  }
  return ready;
}

async function prepare(core: Core): Promise<Networks> {
  await core.loadModels(base);
  const { Networks } = await import("./networks");
  const networks = new Networks(base, core.threads, tell);
  await networks.start();
  return networks;
}

function tell(stage: string, fraction: number | null, energies: EnergyPoint[] = []): void {
  scope.postMessage({ progress: { stage, fraction, ...(energies.length > 0 && { energies }) } });
}

const handlers: Handlers = {
  async start(args) {
    tell("Loading the program", null);
    base = args.base;
    core = await Core.load(base, args.threads);
    core.onProgress = tell;
    return { version: core.version(), threads: core.threads };
  },

  async open({ file, name }): Promise<ScanData> {
    const core = theCore();
    const report = await core.open(file, name);
    // A registration is what comes next. A failure here is reported by it.
    prepared().catch(() => {});
    return {
      file: name,
      bytes: file.size,
      vertices: report.vertices,
      faces: report.faces,
      decimated: report.decimated,
      origin: report.origin,
      notes: report.notes,
      mesh: {
        positions: core.floats(report.positions),
        normals: core.floats(report.normals),
        indices: core.integers(report.indices),
      },
    };
  },

  async models(args) {
    const core = theCore();
    const networks = await prepared();
    try {
      return await core.useModels(args, (network, input) => networks.run(network, input));
    } catch (error) {
      const known = toCoreError(error);
      // These speak of scans and settings elsewhere.
      const about = ["bad_file", "unsupported_format", "usage", "cannot_read", "out_of_memory"];
      throw about.includes(known.code) ? new CoreError("bad_model", known.message) : known;
    }
  },

  async configure({ settings }) {
    return theCore().configure(settings);
  },

  async run({ until, again }): Promise<Findings> {
    const core = theCore();
    const networks = await prepared();
    const { align, keypoints, pose, result } = await core.run(until, again, (network, input) =>
      networks.run(network, input),
    );
    return {
      align,
      keypoints: keypoints && {
        joints: keypoints.joints,
        views: keypoints.views.map((view) => ({ ...view, rgb: core.octets(view.rgb) })),
      },
      pose: pose && {
        joints: pose.joints,
        body: { positions: core.floats(pose.body), indices: core.integers(pose.faces) },
      },
      register: result && {
        registration: result.registration,
        body: { positions: core.floats(result.body), indices: core.integers(result.faces) },
        vertexErrorMm: core.floats(result.errors_mm),
      },
    };
  },

  async edit({ request }) {
    await prepared();
    return answerEditor(theCore(), request);
  },

  async cancel() {
    theCore().cancel();
    return null;
  },

  async files({ format }) {
    return theCore().files(format);
  },

  async measure() {
    const core = theCore();
    const { standing, seated, faces, ...report } = core.measure();
    const mesh = (positions: ArrayReference) => ({
      positions: core.floats(positions),
      indices: core.integers(faces),
    });
    return { ...report, standing: mesh(standing), seated: mesh(seated) };
  },

  async profile({ segment, count }) {
    return theCore().profile(segment, count);
  },

  async measuredFiles({ format }) {
    return theCore().measuredFiles(format);
  },

  async body() {
    await prepared();
    return bodyOf(theCore());
  },

  async poseBody({ parameters }) {
    return poseBody(theCore(), parameters);
  },

  async lesson({ settings }) {
    return lessonOf(theCore(), settings);
  },

  async memory() {
    return { heap: theCore().heap(), inUse: theCore().inUse() };
  },
};

/** The buffers of an answer, so that they move instead of being copied. */
function transferables(value: unknown, found: Transferable[] = []): Transferable[] {
  if (ArrayBuffer.isView(value)) found.push(value.buffer as ArrayBuffer);
  else if (value && typeof value === "object")
    for (const each of Object.values(value)) transferables(each, found);
  return found;
}

function toCoreError(error: unknown): CoreError {
  if (error instanceof CoreError) return error;
  if (error instanceof RangeError) return new CoreError("out_of_memory", error.message);
  return new CoreError("internal", error instanceof Error ? error.message : String(error));
}

scope.onmessage = async ({ data: { id, kind, args } }) => {
  try {
    const value = await (handlers[kind] as (args: unknown) => Promise<unknown>)(args);
    scope.postMessage({ id, ok: true, value }, transferables(value));
  } catch (error) {
    const { code, message } = toCoreError(error);
    scope.postMessage({ id, ok: false, error: { code, message } });
  }
};
