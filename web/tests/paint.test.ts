import { describe, expect, test } from "vitest";
import {
  Brushwork,
  type Command,
  colourOf,
  counts,
  emptyLabels,
  nextId,
  type Pair,
  redo,
  regionsOf,
  replaced,
  suggested,
  undo,
} from "../src/paint/labels";

const HASHES = { scan_sha256: "s", model_sha256: "m" };

/** Numbers from 0 to below `limit` that depend on the seed alone. */
function randomNumbers(seed: number): (limit: number) => number {
  let state = seed;
  return (limit) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state % limit;
  };
}

function snapshot(labels: ReturnType<typeof emptyLabels>): string {
  return JSON.stringify([[...labels.scan], [...labels.template]]);
}

describe("labels", () => {
  test.each([1, 2, 3, 4, 5])("every stroke is undone and redone, seed %i", (seed) => {
    const random = randomNumbers(seed);
    const labels = emptyLabels(40, 25);
    const states = [snapshot(labels)];
    const commands: Command[] = [];
    for (let i = 0; i < 30; ++i) {
      const side = random(2) === 0 ? "scan" : "template";
      const work = new Brushwork(labels, side);
      // Twice over the same vertices in one stroke, as a brush that turns back; some do not exist.
      for (let piece = 0; piece < 3; ++piece)
        work.paint(
          Array.from({ length: 12 }, () => random(45)),
          random(4),
        );
      const change = work.change();
      if (!change) continue;
      commands.push({ label: "", changes: [change] });
      states.push(snapshot(labels));
    }
    expect(commands.length).toBeGreaterThan(20);
    for (let i = commands.length; i-- > 0; ) {
      undo(labels, commands[i]!);
      expect(snapshot(labels)).toBe(states[i]);
    }
    for (const [i, command] of commands.entries()) {
      redo(labels, command);
      expect(snapshot(labels)).toBe(states[i + 1]);
    }
  });

  test("an abandoned stroke leaves nothing behind", () => {
    const labels = emptyLabels(5, 5);
    new Brushwork(labels, "scan").paint([1, 2], 3);
    const before = snapshot(labels);
    const work = new Brushwork(labels, "scan");
    work.paint([0, 1, 2], 4);
    work.paint([1], 0);
    work.abandon();
    expect(snapshot(labels)).toBe(before);
    expect(new Brushwork(labels, "scan").change()).toBeNull();
  });

  test("only pairs that are painted on both sides are regions, and what is read is what was written", () => {
    const labels = emptyLabels(6, 6);
    const pairs: Pair[] = [
      { id: 1, name: "hand" },
      { id: 2, name: "thigh" },
    ];
    new Brushwork(labels, "scan").paint([4, 0], 1);
    new Brushwork(labels, "scan").paint([5], 2);
    expect(regionsOf(pairs, labels, HASHES)).toBeNull();
    new Brushwork(labels, "template").paint([2, 3], 1);
    const regions = regionsOf(pairs, labels, HASHES)!;
    expect(regions).toEqual({
      ...HASHES,
      pairs: [{ name: "hand", scan_vertices: [0, 4], template_vertices: [2, 3] }],
    });
    expect(counts(labels).get(1)).toEqual({ scan: 2, template: 2 });
    expect(counts(labels).get(2)).toEqual({ scan: 1, template: 0 });

    const before = snapshot(labels);
    const command = replaced(pairs, labels, regions, "");
    expect(regionsOf(command.pairs!.after, labels, HASHES)).toEqual(regions);
    expect(labels.scan[5]).toBe(0);
    undo(labels, command);
    expect(snapshot(labels)).toBe(before);
  });

  test("suggestions leave alone what is painted", () => {
    const labels = emptyLabels(4, 4);
    const own: Pair[] = [{ id: 7, name: "mine" }];
    new Brushwork(labels, "scan").paint([0], 7);
    const segments = { scan: new Uint8Array([0, 0, 1, 255]), template: new Uint8Array([1, 0, 1, 0]) };
    const command = suggested(own, labels, segments, ["hips", "head"], [1, 0], "");
    expect(command.pairs!.after).toEqual([...own, { id: 8, name: "head" }, { id: 9, name: "hips" }]);
    expect([...labels.scan]).toEqual([7, 9, 8, 0]);
    expect([...labels.template]).toEqual([8, 9, 8, 9]);
    expect(nextId(command.pairs!.after)).toBe(10);
  });

  test("pairs have colours of their own", () => {
    const colours = Array.from({ length: 60 }, (_, i) => colourOf(i + 1));
    expect(new Set(colours).size).toBe(60);
    for (const colour of colours) expect(colour).toMatch(/^#[0-9a-f]{6}$/);
  });
});
