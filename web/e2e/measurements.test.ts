import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { unzipSync } from "fflate";
import { validateBytes } from "gltf-validator";
import { AnimationMixer, Matrix4, type SkinnedMesh, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { describe, expect } from "vitest";
import type { Dimension } from "../src/core/measurements";
import { EXPORTS } from "../src/core/measurements";
import type { Registration } from "../src/core/types";
import { downloaded, openSample, root, test, verdict } from "./harness";

const CLI = `${root}/build/native/vitruvian`;
// As scanned, a tape keeps the corners it has in the standard posture, and one that hardly stands out there comes or goes
// with the last digit of the registration's file.
const DIMENSION_TOLERANCE_MM = { standard: 0.1, scanned: 1 };
const MESH_TOLERANCE_MM = 0.1;

interface Measured {
  dimensions: Dimension[];
}

/** What the command line measures on the page's own registration. */
function measuredByCommandLine(registration: Uint8Array): Measured {
  const out = mkdtempSync(join(tmpdir(), "vitruvian-e2e-"));
  writeFileSync(join(out, "registration.json"), registration);
  execFileSync(CLI, ["measure", join(out, "registration.json"), "--out", out]);
  return JSON.parse(readFileSync(join(out, "measurements.json"), "utf8"));
}

/** Vertex positions of a binary PLY whose vertices begin with three floats or doubles. */
function plyVertices(bytes: Uint8Array): Vector3[] {
  const text = new TextDecoder("latin1").decode(bytes.subarray(0, 1000));
  const header = text.slice(0, text.indexOf("end_header\n") + "end_header\n".length);
  const sizes: Record<string, number> = { uchar: 1, float: 4, double: 8 };
  const properties = [...header.split("element face")[0]!.matchAll(/property (\w+) \w+/g)].map((m) => m[1]!);
  const stride = properties.reduce((sum, type) => sum + sizes[type]!, 0);
  const data = new DataView(bytes.buffer, bytes.byteOffset + header.length);
  const read = (at: number) =>
    properties[0] === "double" ? data.getFloat64(at, true) : data.getFloat32(at, true);
  const count = Number(/element vertex (\d+)/.exec(header)![1]);
  return Array.from({ length: count }, (_, i) => {
    const at = (axis: number) => read(i * stride + axis * sizes[properties[0]!]!);
    return new Vector3(at(0), at(1), at(2));
  });
}

describe("the measurements of the sample scan", () => {
  test("are those of the command line, drawn on the body, and exported", async ({ page }) => {
    await openSample(page);
    await page.keyboard.press("r");
    expect(await verdict(page)).toBe("OK");
    await page.getByText("Measurements", { exact: true }).click();
    await page.locator(".measurements").waitFor();
    const zip = unzipSync(await downloaded(page, "report.html").then(() => downloadedZip(page)));
    const registration = JSON.parse(
      new TextDecoder().decode(zip["sample/registration.json"]),
    ) as Registration;

    const ours = JSON.parse(new TextDecoder().decode(zip["sample/measurements.json"])) as Measured;
    const theirs = measuredByCommandLine(zip["sample/registration.json"]!);
    const key = ({ id, posture }: Dimension) => `${id} ${posture}`;
    expect(ours.dimensions.map(key)).toEqual(theirs.dimensions.map(key));
    expect(ours.dimensions.length).toBeGreaterThan(100);
    ours.dimensions.forEach(({ id, posture, value_mm }, i) => {
      expect(Math.abs(value_mm - theirs.dimensions[i]!.value_mm), id).toBeLessThan(
        DIMENSION_TOLERANCE_MM[posture],
      );
    });

    // The table shows them, and what is chosen is drawn.
    const waist = ours.dimensions.find((each) => key(each) === "waist_girth standard")!;
    const before = await page.locator("canvas").first().screenshot();
    await page.getByRole("button", { name: "Waist girth", exact: true }).click();
    await page.getByText(`Waist girth ${waist.value_mm.toFixed(1)} mm`).waitFor();
    await page.getByText("Horizontal tape midway between lowest rib and iliac crest").waitFor();
    await expect
      .poll(async () => (await page.locator("canvas").first().screenshot()).equals(before), {
        timeout: 20_000,
      })
      .toBe(false);
    await page.getByText("Sitting", { exact: true }).click();
    const seated = ours.dimensions.find(({ id }) => id === "sitting_height")!;
    const standingView = await page.locator("canvas").first().screenshot();
    await page.getByRole("button", { name: "Sitting height", exact: true }).click();
    await page.getByText(`Sitting height ${seated.value_mm.toFixed(1)} mm`).waitFor();
    await expect
      .poll(async () => (await page.locator("canvas").first().screenshot()).equals(standingView), {
        timeout: 20_000,
      })
      .toBe(false);
    await page.getByText("As scanned", { exact: true }).click();
    expect(await page.getByRole("button", { name: "Stature (body height)" }).count()).toBe(0);

    // A profile by keyboard.
    await page.getByLabel("Segment of the profile").selectOption("left_leg");
    await page.getByLabel("Section", { exact: true }).press("ArrowRight");
    await page.getByText(/^Left leg at 2 %$/).waitFor();

    // Every file of the menu is in the ZIP.
    for (const [, name] of EXPORTS) expect(zip[`sample/${name}`]?.length, name).toBeGreaterThan(50);

    for (const glb of [zip["sample/body.glb"]!, await registeredGlb(page)]) {
      const { issues } = await validateBytes(Uint8Array.from(glb));
      expect(issues.messages).toEqual([]);
    }
    await checkAnimated(zip["sample/body.glb"]!, zip["sample/registered.ply"]!, registration);
  });
});

async function downloadedZip(page: Parameters<typeof downloaded>[0]): Promise<Uint8Array> {
  await page.getByText("Distances", { exact: true }).click();
  const zip = await downloaded(page, "All as ZIP");
  await page.getByText("Measurements", { exact: true }).click();
  return zip;
}

async function registeredGlb(page: Parameters<typeof downloaded>[0]): Promise<Uint8Array> {
  await page.getByText("Distances", { exact: true }).click();
  return downloaded(page, "registered.glb");
}

/** The GLB in three.js: its bones move the skin, and its animation holds the registered pose. */
async function checkAnimated(glb: Uint8Array, ply: Uint8Array, { scan }: Registration): Promise<void> {
  const gltf = await new GLTFLoader().parseAsync(glb.slice().buffer as ArrayBuffer, "");
  let found: SkinnedMesh | undefined;
  let scanFromGlb: Matrix4 | undefined;
  gltf.scene.traverse((object) => {
    if ((object as SkinnedMesh).isSkinnedMesh) found = object as SkinnedMesh;
    const rows = object.userData.scan_from_glb as number[] | undefined;
    if (rows) scanFromGlb = new Matrix4().set(...(rows as Parameters<Matrix4["set"]>));
  });
  const mesh = found!;
  const posed = () => {
    gltf.scene.updateMatrixWorld(true);
    return Array.from({ length: mesh.geometry.getAttribute("position").count }, (_, i) =>
      mesh.getVertexPosition(i, new Vector3()).applyMatrix4(mesh.matrixWorld),
    );
  };
  expect(gltf.animations).toHaveLength(1);
  const mixer = new AnimationMixer(gltf.scene);
  mixer.clipAction(gltf.animations[0]!).play();
  mixer.update(0);
  const animated = posed();
  const registered = plyVertices(ply);
  expect(animated.length).toBe(registered.length);
  const distances = animated.map((at, i) => at.clone().applyMatrix4(scanFromGlb!).distanceTo(registered[i]!));
  expect(1000 * scan.metres_per_unit * Math.max(...distances)).toBeLessThan(MESH_TOLERANCE_MM);

  // A bone turned by hand takes its vertices along.
  const elbow = mesh.skeleton.bones.find(({ name }) => /left_elbow/.test(name))!;
  elbow.rotateY(0.5);
  const moved = posed().map((at, i) => at.distanceTo(animated[i]!));
  expect(Math.max(...moved)).toBeGreaterThan(0.05);
  expect(Math.min(...moved)).toBeLessThan(1e-6);
}
