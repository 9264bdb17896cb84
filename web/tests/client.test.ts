import { describe, expect, it } from "vitest";
import { CoreClient, type WorkerLike } from "../src/core/client";
import { explain } from "../src/core/explain";
import type { Progress, Reply, Request } from "../src/core/messages";
import { CoreError, type ErrorCode } from "../src/core/types";

class FakeWorker implements WorkerLike {
  onmessage: ((event: MessageEvent<Reply>) => void) | null = null;
  onerror: ((event: ErrorEvent) => void) | null = null;
  received: Request[] = [];
  terminated = false;
  postMessage(message: Request): void {
    this.received.push(message);
  }
  terminate(): void {
    this.terminated = true;
  }
  say(reply: Reply): void {
    this.onmessage?.({ data: reply } as MessageEvent<Reply>);
  }
}

function setUp() {
  const workers: FakeWorker[] = [];
  const client = new CoreClient(() => {
    workers.push(new FakeWorker());
    return workers.at(-1)!;
  });
  return { client, workers };
}

describe("CoreClient", () => {
  it("starts no worker before the first call, and one for all calls", async () => {
    const { client, workers } = setUp();
    expect(client.alive).toBe(false);
    const first = client.call("memory", {});
    const second = client.call("cancel", {});
    expect(workers).toHaveLength(1);
    const [a, b] = workers[0]!.received;
    workers[0]!.say({ id: b!.id, ok: true, value: null });
    workers[0]!.say({ id: a!.id, ok: true, value: { heap: 42 } });
    expect(await first).toEqual({ heap: 42 });
    expect(await second).toBeNull();
  });

  it("passes typed errors and progress on", async () => {
    const { client, workers } = setUp();
    const seen: Progress[] = [];
    client.onProgress = (progress) => seen.push(progress);
    const call = client.call("memory", {});
    workers[0]!.say({ progress: { stage: "Reading the scan", fraction: 0.5 } });
    const error = { code: "bad_file" as const, message: "scan.ply: line 3" };
    workers[0]!.say({ id: workers[0]!.received[0]!.id, ok: false, error });
    await expect(call).rejects.toMatchObject(error);
    expect(seen).toEqual([{ stage: "Reading the scan", fraction: 0.5 }]);
  });

  it("fails all calls when ended, and starts anew", async () => {
    const { client, workers } = setUp();
    const call = client.call("memory", {});
    client.end();
    await expect(call).rejects.toMatchObject({ code: "cancelled" });
    expect(workers[0]!.terminated).toBe(true);
    expect(client.alive).toBe(false);
    void client.call("memory", {});
    expect(workers).toHaveLength(2);
  });

  it("reports a worker that cannot be loaded", async () => {
    const { client, workers } = setUp();
    const call = client.call("memory", {});
    workers[0]!.onerror?.({ message: "404", preventDefault: () => {} } as ErrorEvent);
    await expect(call).rejects.toMatchObject({ code: "internal", message: "404" });
    expect(client.alive).toBe(false);
  });
});

describe("explain", () => {
  it("has words and a mend for every code", () => {
    const codes: ErrorCode[] = [
      "usage",
      "not_available",
      "unsupported_format",
      "bad_file",
      "no_geometry",
      "bad_model",
      "cannot_read",
      "cannot_write",
      "cancelled",
      "internal",
      "network",
      "out_of_memory",
    ];
    for (const code of codes) {
      const { what, mend, detail } = explain(new CoreError(code, "the core's words"));
      expect(what).toMatch(/\.$/);
      expect(mend).toMatch(/\.$/);
      expect(detail).toBe("the core's words");
    }
  });
});
