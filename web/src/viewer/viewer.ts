// The 3D view. World frame: the body frame (metres, Y up). Draws only when something changed.
import {
  AmbientLight,
  Box3,
  DirectionalLight,
  GridHelper,
  Group,
  HemisphereLight,
  Matrix4,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
} from "three";
import type { Keypoint, Matrix, Mesh as MeshData, ScanData, Vec3 } from "../core/types";
import { columnMajor } from "../result/transform";
import type { ViewOptions } from "../ui/state";
import { bodyAxes, disposeAxes } from "./axes";
import { curveOf, disposeCurve } from "./curve";
import { Graphics } from "./graphics";
import {
  bodyObject,
  clear,
  keypointObject,
  moveBody,
  paintErrors,
  pairObjects,
  type Surface,
  scanObject,
  skeletonObjects,
} from "./parts";
import { type Direction, Viewpoint } from "./viewpoint";

export { createContext } from "./graphics";
export type { Direction } from "./viewpoint";

export class Viewer {
  private readonly graphics: Graphics;
  private readonly viewpoint: Viewpoint;
  private readonly scene = new Scene();
  private readonly scanRoot = new Group();
  private readonly scanOrigin = new Vector3();
  private readonly bodyRoot = new Group();
  private readonly keypointRoot = new Group();
  private readonly skeletonRoot = new Group();
  private readonly pairRoot = new Group();
  private readonly axesRoot = new Group();
  private readonly curveRoot = new Group();
  private readonly grid = new GridHelper(4, 16);
  private readonly observer: ResizeObserver;
  private options: ViewOptions | null = null;
  /** Whether the user has left the camera where fit() put it: it then follows the window's size. */
  private fitted = true;
  private legendMaximumMm = 10;
  private errorsMm: Float32Array | null = null;
  /** @param context of the canvas, from createContext(). */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
  ) {
    this.viewpoint = new Viewpoint(canvas, () => this.request());
    this.graphics = new Graphics(canvas, context, this.scene, this.viewpoint.camera, () => this.paintPanes());
    this.scanRoot.matrixAutoUpdate = false;
    const key = new DirectionalLight(0xffffff, 1.4);
    key.position.set(0.6, 1, 1);
    this.viewpoint.camera.add(key);
    this.scene.add(
      this.viewpoint.camera,
      new AmbientLight(0xffffff, 0.7),
      new HemisphereLight(0xffffff, 0x777788, 1.1),
      this.scanRoot,
      this.bodyRoot,
      this.keypointRoot,
      this.skeletonRoot,
      this.pairRoot,
      this.axesRoot,
      this.curveRoot,
      this.grid,
    );
    this.grid.visible = false;
    this.observer = new ResizeObserver(() => (this.fitted ? this.fit() : this.request()));
    this.observer.observe(canvas);
    this.viewpoint.controls.addEventListener("start", () => {
      this.fitted = false;
    });
    this.look("front");
  }

  setDark(dark: boolean): void {
    for (const material of [this.grid.material].flat()) {
      material.transparent = true;
      material.opacity = dark ? 0.25 : 0.35;
    }
    this.request();
  }

  /** @param scan null removes it */
  setScan(scan: ScanData | null): void {
    clear(this.scanRoot);
    const mesh = scan?.mesh;
    this.scanOrigin.set(...(scan?.origin ?? ([0, 0, 0] as const)));
    if (mesh && mesh.positions.length > 0) {
      this.scanRoot.add(scanObject(mesh));
      this.setBodyFromScan(null);
      this.fit();
    }
    this.apply();
    this.request(true);
  }

  /** @param matrix null: not known yet; the scan is then shown on its own axes, scaled to a person's size */
  setBodyFromScan(matrix: Matrix | null): void {
    if (matrix) {
      this.scanRoot.matrix.fromArray(columnMajor(matrix));
      this.scanRoot.matrix.multiply(new Matrix4().makeTranslation(this.scanOrigin));
    } else {
      this.scanRoot.matrix.identity();
      this.scanRoot.updateMatrixWorld(true);
      const box = new Box3().setFromObject(this.scanRoot);
      if (!box.isEmpty()) {
        const size = box.getSize(new Vector3());
        const scale = 1.75 / Math.max(size.x, size.y, size.z, 1e-9);
        const centre = box.getCenter(new Vector3()).multiplyScalar(-scale);
        this.scanRoot.matrix.makeScale(scale, scale, scale).setPosition(centre);
        // Most scans lie with their longest extent upright: show those whose longest is Z standing.
        if (size.z > size.y) this.scanRoot.matrix.premultiply(new Matrix4().makeRotationX(-Math.PI / 2));
      }
    }
    this.scanRoot.matrixWorldNeedsUpdate = true;
    this.scanRoot.updateMatrixWorld(true);
    this.grid.visible = matrix !== null && this.scanRoot.children.length > 0;
    if (this.grid.visible) this.grid.position.y = new Box3().setFromObject(this.scanRoot).min.y;
    this.request();
  }

  /** @param mesh body frame; @param errorsMm a vertex, or null when there are none to show */
  setBody(mesh: MeshData | null, errorsMm: Float32Array | null): void {
    clear(this.bodyRoot);
    this.errorsMm = errorsMm;
    if (mesh && mesh.positions.length > 0) this.bodyRoot.add(bodyObject(mesh));
    this.paint();
    this.apply();
  }

  setKeypoints(keypoints: readonly Keypoint[]): void {
    clear(this.keypointRoot);
    const dots = keypointObject(keypoints);
    if (dots) this.keypointRoot.add(dots);
    this.request(true);
  }

  /** @param joints of the 24, body frame; none removes the skeleton */
  setSkeleton(joints: readonly Vec3[]): void {
    clear(this.skeletonRoot);
    for (const part of skeletonObjects(joints)) this.skeletonRoot.add(part);
    this.request(true);
  }

  /** Moves the body's vertices: cheaper than another body of the same faces. @returns whether there was none yet */
  moveBody(mesh: MeshData): boolean {
    const body = this.bodyRoot.children[0] as Surface | undefined;
    const isFirst = !body || !moveBody(body, mesh.positions);
    if (isFirst) this.setBody(mesh, null);
    this.request();
    return isFirst;
  }

  /** Lines between points that are matched: pairs of six numbers, body frame. */
  setPairs(pairs: Float32Array, ofModel: number): void {
    clear(this.pairRoot);
    for (const part of pairObjects(pairs, ofModel)) this.pairRoot.add(part);
    this.request(true);
  }

  /** What the view shows now, as a PNG. */
  picture(): Promise<Blob> {
    this.paintPanes();
    return new Promise((resolve, reject) =>
      this.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture"))), "image/png"),
    );
  }

  /** Shows the body's directions beside the aligned scan. */
  setAxes(shown: boolean): void {
    disposeAxes(this.axesRoot);
    if (shown) {
      this.axesRoot.add(bodyAxes(new Box3().setFromObject(this.scanRoot)));
      this.fit();
    }
    this.request(true);
  }

  /** Draws a tape or line. @param course corners, body frame; none removes it */
  setCurve(course: readonly Vec3[]): void {
    disposeCurve(this.curveRoot);
    if (course.length > 1) this.curveRoot.add(curveOf(course));
    this.request(true);
  }

  setOptions(options: ViewOptions, legendMaximumMm: number): void {
    const repaint = options.heatMap !== this.options?.heatMap || legendMaximumMm !== this.legendMaximumMm;
    this.options = options;
    this.legendMaximumMm = legendMaximumMm;
    if (repaint) this.paint();
    this.apply();
  }

  /** Turns the camera to a side of the body, everything in sight. */
  look(direction: Direction): void {
    this.viewpoint.turnTo(direction);
    this.fit();
  }

  /** Moves the camera, keeping its direction, until everything is in sight. */
  fit(): void {
    const box = new Box3();
    for (const root of [this.scanRoot, this.bodyRoot, this.axesRoot]) {
      if (root.visible && root.children.length > 0) box.union(new Box3().setFromObject(root));
    }
    this.viewpoint.fit(box, this.aspect());
    this.fitted = true;
    this.request();
  }

  /** Turns the camera round the body by angles in radians. */
  orbit(azimuth: number, elevation: number): void {
    this.fitted = false;
    this.viewpoint.orbit(azimuth, elevation);
    this.request();
  }

  /** @param factor above 1: nearer */
  zoom(factor: number): void {
    this.fitted = false;
    this.viewpoint.zoom(factor);
    this.request();
  }

  /** Vertex of the body nearest to what lies under a point of the canvas (CSS pixels from its upper left corner). */
  pickBody(x: number, y: number): number | null {
    const mesh = this.bodyRoot.children[0] as Surface | undefined;
    const { left, width, height } = this.pane(x);
    if (!mesh || !this.options?.showBody || (this.options.split && left === 0)) return null;
    const pointer = new Vector2(((x - left) / width) * 2 - 1, 1 - (y / height) * 2);
    const caster = new Raycaster();
    caster.firstHitOnly = true;
    caster.setFromCamera(pointer, this.viewpoint.camera);
    const hit = caster.intersectObject(mesh)[0];
    if (!hit?.face) return null;
    const position = mesh.geometry.getAttribute("position");
    const distance = (i: number) =>
      hit.point.distanceToSquared(new Vector3().fromBufferAttribute(position, i));
    return [hit.face.a, hit.face.b, hit.face.c].sort((a, b) => distance(a) - distance(b))[0]!;
  }

  dispose(): void {
    this.observer.disconnect();
    this.viewpoint.controls.dispose();
    const { scanRoot, bodyRoot, keypointRoot, skeletonRoot, pairRoot } = this;
    for (const root of [scanRoot, bodyRoot, keypointRoot, skeletonRoot, pairRoot]) clear(root);
    disposeAxes(this.axesRoot);
    disposeCurve(this.curveRoot);
    this.graphics.dispose();
  }

  private aspect(): number {
    const { clientWidth, clientHeight } = this.canvas;
    const panes = this.options?.split ? 2 : 1;
    return Math.max(clientWidth, 1) / panes / Math.max(clientHeight, 1);
  }

  private pane(x: number): { left: number; width: number; height: number } {
    const { clientWidth, clientHeight } = this.canvas;
    if (!this.options?.split) return { left: 0, width: clientWidth, height: clientHeight };
    const width = clientWidth / 2;
    return { left: x < width ? 0 : width, width, height: clientHeight };
  }

  /** Body colours: the error scale, or plain. */
  private paint(): void {
    const body = this.bodyRoot.children[0] as Surface | undefined;
    if (!body) return;
    const coloured = this.options?.heatMap === true && this.errorsMm !== null && this.errorsMm.length > 0;
    paintErrors(body, coloured ? this.errorsMm : null, this.legendMaximumMm);
    this.request(true);
  }

  private apply(): void {
    const options = this.options;
    if (!options) return;
    this.scanRoot.visible = options.showScan;
    this.bodyRoot.visible = options.showBody;
    this.keypointRoot.visible = options.showKeypoints;
    for (const [root, opacity] of [
      [this.scanRoot, options.scanOpacity],
      [this.bodyRoot, options.bodyOpacity],
    ] as const) {
      const object = root.children[0] as Surface | undefined;
      if (!object) continue;
      object.material.opacity = opacity;
      object.material.transparent = opacity < 1;
      object.material.depthWrite = opacity === 1;
      object.renderOrder = opacity < 1 ? 1 : 0;
      if (root === this.bodyRoot) object.material.wireframe = options.wireframe;
    }
    this.request();
  }

  /** @param fresh materials or geometries came */
  private request(fresh = false): void {
    this.graphics.request(fresh);
  }

  private paintPanes(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.viewpoint.setAspect(this.aspect());
    if (!this.options?.split) {
      this.paintPane(0, width, height);
      return;
    }
    const { scanRoot, bodyRoot } = this;
    const shown = [scanRoot.visible, bodyRoot.visible] as const;
    [scanRoot.visible, bodyRoot.visible] = [true, false];
    this.paintPane(0, width / 2, height);
    [scanRoot.visible, bodyRoot.visible] = [false, true];
    this.paintPane(width / 2, width / 2, height);
    [scanRoot.visible, bodyRoot.visible] = shown;
  }

  private paintPane(left: number, width: number, height: number): void {
    const { renderer } = this.graphics;
    renderer.setViewport(left, 0, width, height);
    renderer.setScissor(left, 0, width, height);
    renderer.render(this.scene, this.viewpoint.camera);
  }
}
