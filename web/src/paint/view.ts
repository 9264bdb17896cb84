// Scan and template side by side, in the colours of their regions. World frame: the body frame (metres, Y up).
import {
  Box3,
  BufferAttribute,
  Color,
  Group,
  Matrix4,
  type Mesh,
  type MeshLambertMaterial,
  MOUSE,
  type Points,
  type PointsMaterial,
  Scene,
  SRGBColorSpace,
  TOUCH,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Matrix, Vec3 } from "../core/types";
import { rowsOf } from "../editor/handles";
import { Pane } from "../editor/panes";
import { columnMajor } from "../result/transform";
import { workLights } from "../viewer/lights";
import { clear, scanObject } from "../viewer/parts";
import { colourOf, SIDES } from "./labels";
import type { PaintCamera, PaintMesh, Side } from "./requests";

const FRONT = new Vector3(0, 0.12, 1).normalize();
const PLAIN: Record<Side, Color> = {
  scan: new Color(0xb9bcc2),
  template: new Color(0xd9c6ad),
};

type Painted = (Mesh | Points) & { material: MeshLambertMaterial | PointsMaterial };

/** One half: a mesh, its pane and its lights. */
class Half {
  readonly scene = new Scene();
  readonly root = new Group();
  readonly pane: Pane;
  box = new Box3();
  readonly middle = new Vector3();
  private object: Painted | null = null;
  private source: Uint32Array | null = null;

  constructor(
    readonly side: Side,
    element: HTMLElement,
    changed: () => void,
  ) {
    this.root.matrixAutoUpdate = false;
    this.scene.add(...workLights(), this.root);
    this.pane = new Pane("free", element, changed);
  }

  setMesh({ mesh }: PaintMesh, source: Uint32Array | null): void {
    clear(this.root);
    this.source = source;
    this.object = scanObject(mesh) as Painted;
    this.object.material.transparent = false;
    this.object.material.color.set(0xffffff);
    this.object.material.vertexColors = true;
    const colours = new Float32Array(mesh.positions.length);
    this.object.geometry.setAttribute("color", new BufferAttribute(colours, 3));
    this.root.add(this.object);
  }

  colour(labels: Uint16Array): void {
    const attribute = this.object?.geometry.getAttribute("color") as BufferAttribute | undefined;
    if (!attribute) return;
    const known = new Map<number, Color>([[0, PLAIN[this.side]]]);
    const values = attribute.array as Float32Array;
    for (let i = 0; i < attribute.count; ++i) {
      const label = labels[this.source ? this.source[i]! : i] ?? 0;
      let colour = known.get(label);
      if (!colour) {
        colour = new Color(colourOf(label));
        known.set(label, colour);
      }
      colour.toArray(values, 3 * i);
    }
    attribute.needsUpdate = true;
  }

  /** What the mesh fills, world frame; to be worked out anew when it has moved. */
  measure(): void {
    this.root.updateMatrixWorld(true);
    const box = new Box3().setFromObject(this.root, true);
    this.box = box.isEmpty() ? new Box3(new Vector3(-0.5, -1, -0.3), new Vector3(0.5, 1, 0.3)) : box;
    this.box.getCenter(this.middle);
  }

  dispose(): void {
    this.pane.dispose();
    clear(this.root);
  }
}

export class PaintView {
  private readonly renderer: WebGLRenderer;
  private readonly halves: Record<Side, Half>;
  private readonly observer: ResizeObserver;
  private frame = 0;
  private following = false;
  /** Both cameras move as one. */
  together = true;

  /** @throws Error when the browser has no WebGL. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    elements: Record<Side, HTMLElement>,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: false, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.setScissorTest(true);
    this.renderer.debug.checkShaderErrors = false;
    const half = (side: Side) => new Half(side, elements[side], () => this.moved(side));
    this.halves = { scan: half("scan"), template: half("template") };
    this.observer = new ResizeObserver(() => {
      for (const side of SIDES) this.pane(side).resize();
      this.request();
    });
    this.observer.observe(canvas);
  }

  pane(side: Side): Pane {
    return this.halves[side].pane;
  }

  /** @param origin what the mesh is relative to in the scan frame */
  setScan(mesh: PaintMesh & { source: Uint32Array }, origin: Vec3, body_from_scan: Matrix): void {
    const { scan } = this.halves;
    scan.setMesh(mesh, mesh.source);
    scan.root.matrix.fromArray(columnMajor(body_from_scan));
    scan.root.matrix.multiply(new Matrix4().makeTranslation(new Vector3(...origin)));
    scan.measure();
    this.fit("scan");
  }

  setTemplate(mesh: PaintMesh): void {
    this.halves.template.setMesh(mesh, null);
    this.halves.template.measure();
    this.fit("template");
  }

  colour(labels: Readonly<Record<Side, Uint16Array>>): void {
    for (const side of SIDES) this.halves[side].colour(labels[side]);
    this.request();
  }

  /** @param turning a drag with one finger or the left button turns the view instead of painting */
  setTurning(turning: boolean): void {
    for (const side of SIDES) {
      const { controls } = this.pane(side);
      controls.mouseButtons = {
        LEFT: turning ? MOUSE.ROTATE : null,
        MIDDLE: MOUSE.PAN,
        RIGHT: turning ? MOUSE.PAN : MOUSE.ROTATE,
      };
      controls.touches = { ONE: turning ? TOUCH.ROTATE : null, TWO: TOUCH.DOLLY_ROTATE };
    }
  }

  /** The picture of a side as it is drawn. */
  camera(side: Side): PaintCamera {
    const { pane, root } = this.halves[side];
    pane.camera.updateMatrixWorld();
    return {
      clip_from_mesh: rowsOf(pane.clipFromWorld().multiply(root.matrix)),
      width: Math.max(pane.element.clientWidth, 1),
      height: Math.max(pane.element.clientHeight, 1),
    };
  }

  zoom(side: Side, factor: number): void {
    const { camera, controls } = this.pane(side);
    camera.position.sub(controls.target).divideScalar(factor).add(controls.target);
    controls.update();
  }

  /** Shows all of a side from the front. */
  fit(side: Side): void {
    this.following = true;
    this.halves[side].pane.fit(this.halves[side].box, FRONT);
    this.following = false;
    this.request();
  }

  request(): void {
    if (this.frame !== 0) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.draw();
    });
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.frame = -1;
    this.observer.disconnect();
    for (const side of SIDES) this.halves[side].dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** The other camera looks from the same side, as near, at the same place beside the middle. */
  private moved(side: Side): void {
    this.request();
    if (!this.together || this.following) return;
    this.following = true;
    const from = this.halves[side];
    const to = this.halves[side === "scan" ? "template" : "scan"];
    const shift = to.middle.clone().sub(from.middle);
    to.pane.controls.target.copy(from.pane.controls.target).add(shift);
    to.pane.camera.position.copy(from.pane.camera.position).add(shift);
    to.pane.controls.update();
    this.following = false;
  }

  private draw(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    const ratio = this.renderer.getPixelRatio();
    if (this.canvas.width !== Math.floor(width * ratio) || this.canvas.height !== Math.floor(height * ratio))
      this.renderer.setSize(width, height, false);
    const whole = this.canvas.getBoundingClientRect();
    for (const side of SIDES) {
      const { pane, scene } = this.halves[side];
      const part = pane.element.getBoundingClientRect();
      if (part.width === 0 || part.height === 0) continue;
      const area = [part.left - whole.left, whole.bottom - part.bottom, part.width, part.height] as const;
      this.renderer.setViewport(...area);
      this.renderer.setScissor(...area);
      this.renderer.render(scene, pane.camera);
    }
  }
}
