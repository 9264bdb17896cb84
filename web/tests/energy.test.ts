import { beforeEach, expect, test } from "vitest";
import { add, clear, curves } from "../src/ui/energy";

beforeEach(clear);

const told = (curve: string, iteration: number) => ({ curve, iteration, value: 1 / iteration });

test("points go to the curve that they are of, in the order of the curves", () => {
  add([told("distance", 1), told("distance", 2)]);
  add([told("distance", 3), told("correspondence 1", 1)]);
  expect(curves.value.map(({ name, points }) => [name, points.map((each) => each.iteration)])).toEqual([
    ["distance", [1, 2, 3]],
    ["correspondence 1", [1]],
  ]);
});

test("a long curve is thinned, and keeps its newest point and its order", () => {
  for (let i = 1; i <= 6000; ++i) {
    add([told("distance", i)]);
    expect(curves.value[0]!.points.at(-1)!.iteration).toBe(i);
  }
  const iterations = curves.value[0]!.points.map((each) => each.iteration);
  expect(iterations.length).toBeLessThanOrEqual(500);
  expect(iterations.length).toBeGreaterThan(200);
  expect(iterations).toEqual([...new Set(iterations)].sort((a, b) => a - b));
  expect(iterations[0]).toBe(1);
});
