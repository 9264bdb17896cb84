// Typed view of the WASM module: the only place that knows its entry points.
import type { MeasurementsReport, Section } from "../core/measurements";
import type { Calls, EnergyPoint } from "../core/messages";
import {
  type AlignData,
  CoreError,
  type CoreStage,
  type ErrorCode,
  type Keypoint,
  kCoreStages,
  type OutputFile,
  type PoseData,
  type Registration,
  type Settings,
  type ViewData,
} from "../core/types";
import { givesWay, kModelKinds, type ModelFile, type ModelKind, type ModelsInfo } from "../models/types";
import { load } from "./load";
import type { Network } from "./networks";

/** Values of TaskState in wasm/task.h. */
const WORKING = 1;
const FAILED = 3;
/** Between two looks at a task that works on its own thread. */
const POLL_MS = 25;

/** A zero-terminated text in the module's memory; 0 when the call failed. */
type Text = number;

interface Module {
  HEAPU8: Uint8Array;
  onProgress?: (stage: string, fraction: number) => void;
  onEnergy?: (curve: string, iteration: number, value: number) => void;
  _malloc(size: number): number;
  _free(address: number): void;
  _vitruvian_version(): Text;
  _vitruvian_memory(): number;
  _vitruvian_memory_in_use(): number;
  _vitruvian_has_threads(): number;
  _vitruvian_last_error(): Text;
  _vitruvian_create(threads: number): number;
  _vitruvian_open(data: number, size: number, name: Text): number;
  _vitruvian_task_state(): number;
  _vitruvian_task_progress(): Text;
  _vitruvian_task_error(): Text;
  _vitruvian_cancel(): void;
  _vitruvian_scan_report(): Text;
  _vitruvian_load_model(part: number, data: number, size: number, name: Text): number;
  _vitruvian_add_model(data: number, size: number, name: Text): number;
  _vitruvian_use_models(known: Text): number;
  _vitruvian_model_report(): Text;
  _vitruvian_configure(settings: Text): number;
  _vitruvian_begin(until: number, again: number): number;
  _vitruvian_request_report(): Text;
  _vitruvian_reply_buffer(input: number, output: number, size: number): number;
  _vitruvian_resume(): number;
  _vitruvian_findings_report(): Text;
  _vitruvian_edit(request: Text): Text;
  _vitruvian_files_report(format: Text): Text;
  _vitruvian_measurements_report(): Text;
  _vitruvian_profile_report(segment: Text, count: number): Text;
  _vitruvian_measured_files_report(format: Text): Text;
  _vitruvian_body_report(): Text;
  _vitruvian_pose_body(parameters: Text): Text;
  _vitruvian_begin_lesson(settings: Text): number;
  _vitruvian_lesson_report(): Text;
}

/** Files of ModelPart in wasm/session.h, in its order. */
const MODEL_FILES = ["body.vbm", "pose_prior.vpp", "landmarks.json"] as const;

/** `[address, number of elements]` in the module's memory. */
export type ArrayReference = [number, number];

export interface ScanReport {
  vertices: number;
  faces: number;
  decimated: boolean;
  origin: [number, number, number];
  notes: string[];
  positions: ArrayReference;
  normals: ArrayReference;
  indices: ArrayReference;
}

/** TaskProgress in wasm/task.h. */
interface TaskProgress {
  stage: string;
  fraction: number;
  energies: EnergyPoint[];
}

interface NetworkRequest {
  network: Network;
  inputs: ArrayReference[];
}

/** What the stages found, with arrays that are still in the module's memory. */
export interface FindingsReport {
  align: AlignData | null;
  keypoints: {
    views: (Omit<ViewData, "rgb"> & { rgb: ArrayReference })[];
    joints: Keypoint[];
  } | null;
  pose: { joints: PoseData["joints"]; body: ArrayReference; faces: ArrayReference } | null;
  result: {
    registration: Registration;
    body: ArrayReference;
    faces: ArrayReference;
    errors_mm: ArrayReference;
  } | null;
}

export type RunNetwork = (network: Network, input: Float32Array) => Promise<Float32Array[]>;

export class Core {
  private cancelled = false;
  onProgress: (stage: string, fraction: number | null, energies?: EnergyPoint[]) => void = () => {};

  private constructor(
    private readonly module: Module,
    readonly threads: number,
  ) {}

  /** Loads the build that fits `threads` from `base`/wasm. @throws CoreError(network) */
  static async load(base: string, threads: number): Promise<Core> {
    const folder = new URL(`wasm/${threads > 1 ? "threads" : "single"}/`, base);
    const module: Module = await import(/* @vite-ignore */ new URL("vitruvian.mjs", folder).href)
      .then(({ default: create }) => create())
      .catch((error: unknown) => {
        throw new CoreError("network", `the core could not be loaded: ${error}`);
      });
    const core = new Core(module, module._vitruvian_has_threads() ? threads : 1);
    // Without threads the core calls while it works; with them finished() asks.
    let latest = { stage: "", fraction: -1 };
    module.onProgress = (stage, fraction) => {
      latest = { stage, fraction };
      core.report({ ...latest, energies: [] });
    };
    module.onEnergy = (curve, iteration, value) =>
      core.report({ ...latest, energies: [{ curve, iteration, value }] });
    core.check(module._vitruvian_create(core.threads));
    return core;
  }

  version(): string {
    return this.text(this.module._vitruvian_version());
  }

  /** Bytes of the module's memory. */
  heap(): number {
    return this.module._vitruvian_memory();
  }

  /** Bytes of it in use. */
  inUse(): number {
    return this.module._vitruvian_memory_in_use();
  }

  /** All of the module's memory as it is now: it may have grown since the last look, on any thread. */
  private get memory(): Uint8Array {
    this.module._vitruvian_memory();
    return this.module.HEAPU8;
  }

  cancel(): void {
    this.cancelled = true;
    this.module._vitruvian_cancel();
  }

  /** Streams the file into the module's memory and reads it there. */
  async open(file: Blob, name: string): Promise<ScanReport> {
    const address = await this.store(file, "Loading the scan");
    this.withText(name, (title) => this.check(this.module._vitruvian_open(address, file.size, title)));
    await this.finished();
    return this.json<ScanReport>(this.module._vitruvian_scan_report());
  }

  /** Loads the models from `base`/models. @throws CoreError(network | bad_model) */
  async loadModels(base: string): Promise<void> {
    for (const [part, name] of MODEL_FILES.entries()) {
      const bytes = await load(new URL(`models/${name}`, base), (fraction) =>
        this.onProgress("Loading the body model", fraction),
      );
      const address = this.allocate(bytes.length);
      this.memory.set(bytes, address);
      this.withText(name, (title) =>
        this.check(this.module._vitruvian_load_model(part, address, bytes.length, title)),
      );
    }
  }

  /** Puts a user's model files to use, or the bundled ones again. See Calls["models"]. */
  async useModels(
    { fresh, held, learnt }: Calls["models"]["args"],
    runNetwork: RunNetwork,
  ): Promise<ModelsInfo> {
    this.cancelled = false;
    const kinds: ModelKind[] = [];
    for (const each of fresh) kinds.push(await this.addModel(each));
    for (const each of held) if (!givesWay(each.kind, kinds)) await this.addModel(each);
    this.withText(JSON.stringify(learnt), (text) => this.check(this.module._vitruvian_use_models(text)));
    await this.answerAll(runNetwork, false);
    const info = this.json<Omit<ModelsInfo, "kinds">>(this.module._vitruvian_model_report());
    return { ...info, kinds };
  }

  private async addModel({ file, name }: ModelFile): Promise<ModelKind> {
    const address = await this.store(file, "Loading the model");
    const kind = this.withText(name, (title) =>
      this.check(this.module._vitruvian_add_model(address, file.size, title)),
    );
    return kModelKinds[kind - 1]!;
  }

  /** Takes settings over. @returns how many of kCoreStages still hold. @throws CoreError */
  configure(settings: Settings): number {
    const answer = this.withText(JSON.stringify(settings), (text) =>
      this.check(this.module._vitruvian_configure(text)),
    );
    return answer - 1;
  }

  /** Works the opened scan up to a stage. @param again that stage anew, though it was reached. @throws CoreError */
  async run(until: CoreStage, again: boolean, runNetwork: RunNetwork): Promise<FindingsReport> {
    this.cancelled = false;
    this.check(this.module._vitruvian_begin(kCoreStages.indexOf(until), Number(again)));
    await this.answerAll(runNetwork, true);
    return this.json<FindingsReport>(this.module._vitruvian_findings_report());
  }

  /** The editors' questions: JSON in, JSON out. */
  edit<T>(request: unknown): T {
    return this.withText(JSON.stringify(request), (text) => this.json<T>(this.module._vitruvian_edit(text)));
  }

  /** What the command line writes. */
  files(meshFormat: string): OutputFile[] {
    return this.withText(meshFormat, (text) => this.listed(this.module._vitruvian_files_report(text)));
  }

  measure(): MeasurementsReport & {
    standing: ArrayReference;
    seated: ArrayReference;
    faces: ArrayReference;
  } {
    return this.json(this.module._vitruvian_measurements_report());
  }

  profile(segment: string, count: number): Section[] {
    return this.withText(segment, (text) => this.json(this.module._vitruvian_profile_report(text, count)));
  }

  /** What `vitruvian measure` writes. */
  measuredFiles(format: string): OutputFile[] {
    return this.withText(format, (text) => this.listed(this.module._vitruvian_measured_files_report(text)));
  }

  /** Copies of the files of a report. */
  private listed(report: Text): OutputFile[] {
    const { files } = this.json<{ files: { name: string; data: ArrayReference }[] }>(report);
    return files.map(({ name, data: [address, size] }) => ({ name, data: this.bytes(address, size) }));
  }

  /** What there is to move on the body. @throws CoreError */
  body<T>(): T {
    return this.json<T>(this.module._vitruvian_body_report());
  }

  poseBody<T>(parameters: object): T {
    return this.withText(JSON.stringify(parameters), (text) =>
      this.json<T>(this.module._vitruvian_pose_body(text)),
    );
  }

  async lesson<T>(settings: object): Promise<T> {
    this.withText(JSON.stringify(settings), (text) => this.check(this.module._vitruvian_begin_lesson(text)));
    await this.finished();
    return this.json<T>(this.module._vitruvian_lesson_report());
  }

  /** Runs the networks that the task under way asks for, until it asks no more. @param told with progress */
  private async answerAll(runNetwork: RunNetwork, told: boolean): Promise<void> {
    for (;;) {
      await this.finished();
      const request = this.json<NetworkRequest | null>(this.module._vitruvian_request_report());
      if (!request) return;
      await this.answer(request, runNetwork, told);
      this.check(this.module._vitruvian_resume());
    }
  }

  private async answer(
    { network, inputs }: NetworkRequest,
    runNetwork: RunNetwork,
    told: boolean,
  ): Promise<void> {
    for (const [i, input] of inputs.entries()) {
      this.checkCancelled();
      if (told) this.onProgress("detect", i / inputs.length);
      const outputs = await runNetwork(network, this.floats(input));
      for (const [j, output] of outputs.entries()) {
        const address = this.check(this.module._vitruvian_reply_buffer(i, j, output.length)) >>> 0;
        this.memory.set(new Uint8Array(output.buffer, output.byteOffset, output.byteLength), address);
      }
    }
    this.checkCancelled();
  }

  private checkCancelled(): void {
    if (this.cancelled) throw new CoreError("cancelled", "cancelled");
  }

  /** Text of a call that succeeded, parsed. */
  private json<T>(address: Text): T {
    return JSON.parse(this.text(this.check(address)));
  }

  /** Calls with a text in the module's memory, and frees it. */
  private withText<T>(text: string, call: (address: Text) => T): T {
    const address = this.storeText(text);
    try {
      return call(address);
    } finally {
      this.module._free(address);
    }
  }

  /** A copy of an array of the last report. */
  floats([address, length]: ArrayReference): Float32Array<ArrayBuffer> {
    return new Float32Array(this.bytes(address, length * 4).buffer);
  }

  /** A copy of an array of the last report. */
  integers([address, length]: ArrayReference): Uint32Array {
    return new Uint32Array(this.bytes(address, length * 4).buffer);
  }

  /** A copy of a text's or picture's bytes of the last report. */
  octets([address, length]: ArrayReference): Uint8Array<ArrayBuffer> {
    return this.bytes(address, length);
  }

  /** A copy, never shared, of a piece of the module's memory. */
  private bytes(address: number, size: number): Uint8Array<ArrayBuffer> {
    const copy = new Uint8Array(size);
    copy.set(this.memory.subarray(address, address + size));
    return copy;
  }

  private async store(file: Blob, doing: string): Promise<number> {
    const address = this.allocate(file.size);
    try {
      let offset = 0;
      const reader = file.stream().getReader();
      for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        this.memory.set(value, address + offset);
        offset += value.length;
        this.onProgress(doing, offset / file.size);
      }
      return address;
    } catch (error) {
      this.module._free(address);
      throw new CoreError("cannot_read", String(error));
    }
  }

  private storeText(text: string): number {
    const encoded = new TextEncoder().encode(`${text}\0`);
    const address = this.allocate(encoded.length);
    this.memory.set(encoded, address);
    return address;
  }

  private allocate(size: number): number {
    const address = this.module._malloc(Math.max(size, 1)) >>> 0;
    if (address === 0) throw new CoreError("out_of_memory", `no memory for ${size} bytes`);
    return address;
  }

  private text(address: Text): string {
    const heap = this.memory;
    return new TextDecoder().decode(this.bytes(address, heap.indexOf(0, address) - address));
  }

  /** @throws CoreError when a call returned 0. */
  private check(returned: number): number {
    if (returned === 0) throw this.error(this.module._vitruvian_last_error());
    return returned;
  }

  private error(address: Text): CoreError {
    const { code, message } = JSON.parse(this.text(address)) as { code: ErrorCode; message: string };
    return new CoreError(code, message);
  }

  /** Waits for the task under way. */
  private async finished(): Promise<void> {
    for (;;) {
      const state = this.module._vitruvian_task_state();
      this.report(this.json<TaskProgress>(this.module._vitruvian_task_progress()));
      if (state === FAILED) throw this.error(this.check(this.module._vitruvian_task_error()));
      if (state !== WORKING) return;
      await new Promise((resolve) => setTimeout(resolve, POLL_MS));
    }
  }

  private report({ stage, fraction, energies }: TaskProgress): void {
    if (!stage) return;
    this.onProgress(stage, fraction < 0 ? null : fraction, energies);
  }
}
