// What a person does in the editor, with the mouse of a real browser.
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { BrowserContext, Page } from "playwright-core";
import { expect } from "vitest";
import type { Registration } from "../src/core/types";
import { downloaded, PATIENCE_MS, pick, root } from "./harness";

const CLI = `${root}/build/native/vitruvian`;

type Point = readonly [number, number];
export type Places = Record<string, readonly [number, number, number]>;
/** The two panes that look along an axis of the body frame. */
export type FlatPane = "front" | "side";

export async function drag(page: Page, path: readonly Point[], steps = 3): Promise<void> {
  await page.mouse.move(...path[0]!);
  await page.mouse.down();
  for (const point of path.slice(1)) await page.mouse.move(...point, { steps });
  await page.mouse.up();
}

/** One finger, as a touch screen reports it. */
export async function touch(context: BrowserContext, page: Page, from: Point, to: Point): Promise<void> {
  const screen = await context.newCDPSession(page);
  const send = (type: "touchStart" | "touchMove" | "touchEnd", points: Point[]) =>
    screen.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y]) => ({ x, y })) });
  await send("touchStart", [from]);
  for (const share of [0.3, 0.6, 1])
    await send("touchMove", [
      [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])] as const,
    ]);
  await send("touchEnd", []);
  await screen.detach();
}

export async function editJoints(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Edit the joints…" }).click();
  await page.locator("[data-rate]").waitFor({ timeout: PATIENCE_MS });
}

/** The joints in the body frame, by what the editor exports. */
export async function exportedJoints(page: Page): Promise<Places> {
  const { frame, joints } = JSON.parse((await downloaded(page, "Export keypoints")).toString());
  if (frame !== "scan") throw new Error(`keypoints in frame ${frame}`);
  return Object.fromEntries(
    Object.entries(joints).map(([name, joint]) => [name, (joint as { position: Places[string] }).position]),
  );
}

/** Chooses a joint in the list. @returns where a pane then names it, pixels of the page */
export async function choose(page: Page, joint: string, pane: FlatPane | "free"): Promise<Point> {
  await page
    .getByLabel("Joints")
    .getByRole("button", { name: nameOf(joint) })
    .click();
  const label = page.locator(`[data-pane=${pane}] .joint-name[data-joint=${joint}]`);
  await label.waitFor();
  const { x, y } = (await page.locator(`[data-pane=${pane}]`).boundingBox())!;
  const [left, top] = await label.evaluate(({ style }) => [style.left, style.top].map(Number.parseFloat));
  return [x + left!, y + top!];
}

function nameOf(joint: string): RegExp {
  const words = joint.replaceAll("_", " ");
  return new RegExp(`^${words.charAt(0).toUpperCase()}${words.slice(1)}( ■)?( \\(locked\\))?$`);
}

export type Matrix = readonly (readonly number[])[];

export function transformed(matrix: Matrix, [x, y, z]: Places[string]): Places[string] {
  const [a, b, c] = matrix.slice(0, 3).map((row) => row[0]! * x + row[1]! * y + row[2]! * z + row[3]!);
  return [a!, b!, c!];
}

/** A pane that looks along an axis: what a metre is in it, told by two joints of known places. */
export class FlatView {
  private constructor(
    private readonly pane: FlatPane,
    private readonly from: Point,
    private readonly at: Point,
    private readonly scale: number,
  ) {}

  /** @param joints  as they are shown, body frame */
  static async of(page: Page, pane: FlatPane, joints: Places): Promise<FlatView> {
    const [head, foot] = [await choose(page, "head", pane), await choose(page, "left_foot", pane)];
    const [above, below] = [flat(pane, joints.head!), flat(pane, joints.left_foot!)];
    const length = (a: Point, b: Point) => Math.hypot(a[0] - b[0], a[1] - b[1]);
    return new FlatView(pane, above, head, length(head, foot) / length(above, below));
  }

  pixel(place: Places[string]): Point {
    const [u, v] = flat(this.pane, place);
    return [this.at[0] + this.scale * (u - this.from[0]), this.at[1] - this.scale * (v - this.from[1])];
  }
}

/** Right and up in a pane. */
function flat(pane: FlatPane, [x, y, z]: Places[string]): Point {
  return pane === "front" ? [x, y] : [-z, y];
}

export async function result(page: Page): Promise<Registration> {
  return JSON.parse((await downloaded(page, "registration.json")).toString());
}

export async function open(page: Page, folder: string, name: string, scan: Buffer): Promise<string> {
  const file = join(folder, name);
  writeFileSync(file, scan);
  await pick(page, file);
  await page.getByText("Vertices", { exact: true }).waitFor({ timeout: PATIENCE_MS });
  return file;
}

/** registration.json of a replay on the command line. */
export function replayed(
  scan: string,
  project: string,
  out: string,
): { text: string; registration: Registration } {
  const { status, stderr } = spawnSync(CLI, [
    "register",
    scan,
    "--out",
    out,
    "--quiet",
    "--project",
    project,
  ]);
  expect(status, String(stderr)).toBe(0);
  const stem = scan
    .split("/")
    .at(-1)!
    .replace(/\.ply$/, "");
  const text = readFileSync(join(out, stem, "registration.json"), "utf8");
  return { text, registration: JSON.parse(text) };
}

/** Largest distance of joints, mm. */
export function apart(a: Registration, b: Registration): number {
  const distances = a.joints.map(({ scan }, i) =>
    Math.hypot(...b.joints[i]!.scan.map((value, k) => value - scan[k]!)),
  );
  return Math.max(...distances) * 1000 * a.scan.metres_per_unit;
}
