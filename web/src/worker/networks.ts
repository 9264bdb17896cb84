// Runs the keypoint networks when the core asks for it.
import { env, InferenceSession, Tensor } from "onnxruntime-web/wasm";
import { CoreError } from "../core/types";
import { load } from "./load";

export type Network = "detector" | "landmarks";

const SIZE: Record<Network, number> = { detector: 224, landmarks: 256 };
const OUTPUTS: Record<Network, readonly string[]> = {
  detector: ["boxes", "scores"],
  landmarks: ["landmarks", "presence", "heatmap"],
};

export class Networks {
  private readonly sessions = new Map<Network, Promise<InferenceSession>>();

  constructor(
    private readonly base: string,
    threads: number,
    private readonly onProgress: (stage: string, fraction: number | null) => void,
  ) {
    env.wasm.numThreads = threads;
    // The session lives in this worker already.
    env.wasm.proxy = false;
  }

  /** Loads both networks. @throws CoreError(network) */
  async start(): Promise<void> {
    for (const network of ["detector", "landmarks"] as const) await this.session(network);
  }

  /** Outputs of one run in the core's order. */
  async run(network: Network, input: Float32Array): Promise<Float32Array[]> {
    const session = await this.session(network);
    const size = SIZE[network];
    const image = new Tensor("float32", input, [1, 3, size, size]);
    const outputs = await session.run({ image });
    return OUTPUTS[network].map((name) => {
      const tensor = outputs[name];
      if (!tensor) throw new CoreError("bad_model", `the ${network} network has no output "${name}"`);
      return tensor.data as Float32Array;
    });
  }

  private session(network: Network): Promise<InferenceSession> {
    let session = this.sessions.get(network);
    if (!session) {
      session = this.create(network);
      session.catch(() => this.sessions.delete(network));
      this.sessions.set(network, session);
    }
    return session;
  }

  private async create(network: Network): Promise<InferenceSession> {
    const name = `models/blazepose_${network}.fp16.onnx`;
    const bytes = await load(new URL(name, this.base), (fraction) =>
      this.onProgress("Loading the pose network", fraction),
    );
    this.onProgress("Starting the pose network", null);
    return InferenceSession.create(bytes, { executionProviders: ["wasm"] });
  }
}
