// The page's side of the worker: started when first needed, ended and replaced when it does not obey.
import type { Calls, Kind, Progress, Reply, Request } from "./messages";
import { CoreError } from "./types";

/** What the client needs of a Worker; tests hand in their own. */
export interface WorkerLike {
  postMessage(message: Request): void;
  terminate(): void;
  onmessage: ((event: MessageEvent<Reply>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
}

interface Waiting {
  resolve(value: unknown): void;
  reject(error: CoreError): void;
}

export class CoreClient {
  /** Called with each progress report. */
  onProgress: (progress: Progress) => void = () => {};
  private worker: WorkerLike | null = null;
  private readonly waiting = new Map<number, Waiting>();
  private nextId = 1;

  constructor(private readonly createWorker: () => WorkerLike) {}

  /** Whether a worker lives, and with it an opened scan. */
  get alive(): boolean {
    return this.worker !== null;
  }

  /** @throws CoreError */
  call<K extends Kind>(kind: K, args: Calls[K]["args"]): Promise<Calls[K]["result"]> {
    const worker = this.worker ?? this.begin();
    const id = this.nextId++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (value: unknown) => void, reject });
      worker.postMessage({ id, kind, args } as Request);
    });
  }

  /** Ends the worker; every call under way fails with `error`. The next call starts a new one. */
  end(error = new CoreError("cancelled", "cancelled")): void {
    this.worker?.terminate();
    this.worker = null;
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    for (const { reject } of waiting) reject(error);
  }

  private begin(): WorkerLike {
    const worker = this.createWorker();
    worker.onmessage = ({ data }) => this.receive(data);
    worker.onerror = (event) => {
      event.preventDefault();
      this.end(new CoreError("internal", event.message || "the worker could not be started"));
    };
    this.worker = worker;
    return worker;
  }

  private receive(reply: Reply): void {
    if ("progress" in reply) {
      this.onProgress(reply.progress);
      return;
    }
    const call = this.waiting.get(reply.id);
    this.waiting.delete(reply.id);
    if (reply.ok) call?.resolve(reply.value);
    else call?.reject(new CoreError(reply.error.code, reply.error.message));
  }
}
