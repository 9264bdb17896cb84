import { expect, test } from "vitest";
import { EMPTY, edits as editsOf, folded, made, redone, type Step, undone } from "../src/editor/history";
import type { Edit } from "../src/editor/requests";
import { BONES, JOINTS, limbOf } from "../src/editor/skeleton";

const head = (z: number) => ({ position: [0, 0, z] as const, confidence: 1 });
const edits: Edit[] = [
  { edit: "keypoints", keypoints: { frame: "scan", joints: { head: head(1), neck: head(2) } } },
  { edit: "joints", joints: { head: head(3), neck: null } },
  { edit: "crop", remove: "inside", box_from_scan: [], label: "Cut away" },
  { edit: "align", body_from_scan: [[1]] },
];

test("edits are made one after the other", () => {
  const { keypoints, crops, body_from_scan } = folded(edits);
  expect(keypoints).toEqual({ frame: "scan", joints: { head: head(3) } });
  expect(crops).toEqual([{ remove: "inside", box_from_scan: [] }]);
  expect(body_from_scan).toEqual([[1]]);
  expect(folded([...edits, { edit: "align", body_from_scan: null }]).body_from_scan).toBeNull();
  expect(folded([]).keypoints).toBeNull();
});

test("every edit can be undone and made again, until another is made", () => {
  let history = edits.reduce(made, EMPTY);
  for (let i = 0; i < 10; ++i) history = undone(history);
  expect(history).toEqual({ done: [], undone: edits });
  history = redone(redone(history));
  expect(history.done).toEqual(edits.slice(0, 2));
  history = made(history, edits[3]!);
  expect(history).toEqual({ done: [edits[0], edits[1], edits[3]], undone: [] });
  expect(redone(history)).toEqual(history);
});

test("locks are undone like edits, and are no part of a project", () => {
  const lock = (joint: string, locked: boolean): Step => ({ edit: "lock", joint, locked });
  const steps = [...edits, lock("head", true), lock("neck", true), lock("head", false)];
  let history = steps.reduce(made, EMPTY);
  expect([...folded(history.done).locked]).toEqual(["neck"]);
  expect(editsOf(history.done)).toEqual(edits);
  history = undone(history);
  expect([...folded(history.done).locked]).toEqual(["head", "neck"]);
  expect(folded(history.done).keypoints).toEqual(folded(edits).keypoints);
});

test("a limb is a joint with all that hangs on it", () => {
  expect(limbOf("left_knee")).toEqual(["left_knee", "left_ankle", "left_foot"]);
  expect(limbOf("pelvis").length).toBe(JOINTS.length);
  expect(limbOf("head")).toEqual(["head"]);
  expect(BONES.length).toBe(JOINTS.length - 1);
});
