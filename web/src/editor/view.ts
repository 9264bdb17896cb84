// The editor's scene in three panes over one canvas. World frame: the body frame (metres, Y up).
import {
  Box3,
  Group,
  Matrix4,
  type Mesh,
  type MeshLambertMaterial,
  type Points,
  Scene,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Matrix, Mesh as MeshData, Vec3 } from "../core/types";
import { columnMajor } from "../result/transform";
import { workLights } from "../viewer/lights";
import { bodyObject, clear, scanObject } from "../viewer/parts";
import { JointsObject, type ShownJoint } from "./joints_object";
import { Pane, type PaneName } from "./panes";

/** Milliseconds that a dragging pointer rests before the other panes are drawn too. */
const REST_MS = 150;
/** Pixels within which a pointer takes a joint: mouse, and fingers. */
const REACH = { mouse: 14, touch: 28 };

export class EditorView {
  readonly scene = new Scene();
  readonly panes: Pane[];
  readonly scanRoot = new Group();
  private readonly renderer: WebGLRenderer;
  private readonly bodyRoot = new Group();
  private readonly joints = new JointsObject();
  private readonly origin = new Vector3();
  private readonly observer: ResizeObserver;
  private shown: readonly ShownJoint[] = [];
  private frame = 0;
  private fitted = false;
  /** Panes that are not drawn as things are. */
  private readonly outdated = new Set<PaneName>();
  /** While a pointer drags in one pane, it is drawn first: without a graphics card each costs. */
  private foremost: PaneName | null = null;
  private resting: ReturnType<typeof setTimeout> | undefined;
  /** Called after the panes were drawn. */
  onDrawn: () => void = () => {};
  /** Called before a pane is drawn, to show what belongs into it alone. */
  beforePane: (pane: Pane) => void = () => {};

  /** @throws Error when the browser has no WebGL. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    elements: Record<PaneName, HTMLElement>,
  ) {
    // Three pictures at once: smooth edges would cost machines without a graphics card seconds. What was drawn is
    // kept, so that one of them can be drawn alone.
    this.renderer = new WebGLRenderer({ canvas, antialias: false, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.setScissorTest(true);
    this.renderer.debug.checkShaderErrors = false;
    this.scanRoot.matrixAutoUpdate = false;
    this.scene.add(...workLights(), this.scanRoot, this.bodyRoot, this.joints.root);
    this.panes = (["front", "side", "free"] as const).map(
      (name) => new Pane(name, elements[name], () => this.request(name)),
    );
    this.observer = new ResizeObserver(() => {
      for (const pane of this.panes) pane.resize();
      this.request();
    });
    this.observer.observe(canvas);
  }

  /**
   * @param mesh relative to `origin` in the scan frame
   * @param coarse the same with few vertices, drawn while a joint is dragged
   */
  setScan(mesh: MeshData, coarse: MeshData | null, origin: Vec3): void {
    clear(this.scanRoot);
    this.origin.set(...origin);
    this.scanRoot.add(shaded(mesh));
    if (coarse) this.scanRoot.add(shaded(coarse));
    this.showScan();
    this.request();
  }

  setBodyFromScan(matrix: Matrix): void {
    this.scanRoot.matrix.fromArray(columnMajor(matrix));
    this.scanRoot.matrix.multiply(new Matrix4().makeTranslation(this.origin));
    this.scanRoot.updateMatrixWorld(true);
    if (!this.fitted) this.fit();
    this.request();
  }

  /** How the scan lies as it is drawn. */
  bodyFromScan(): Matrix4 {
    return this.scanRoot.matrix.clone().multiply(new Matrix4().makeTranslation(this.origin.clone().negate()));
  }

  setBody(mesh: MeshData | null): void {
    const old = this.bodyRoot.children[0] as Mesh | undefined;
    if (mesh && old) {
      // Same triangles: only the places are new.
      const position = old.geometry.getAttribute("position");
      (position.array as Float32Array).set(mesh.positions);
      position.needsUpdate = true;
      old.geometry.computeVertexNormals();
    } else {
      clear(this.bodyRoot);
      if (mesh) {
        const body = bodyObject(mesh);
        body.geometry.disposeBoundsTree();
        body.material.transparent = false;
        body.frustumCulled = false;
        this.bodyRoot.add(body);
      }
    }
    this.request();
  }

  setJoints(joints: readonly ShownJoint[]): void {
    this.shown = joints;
    this.joints.update(joints);
    this.request();
  }

  /** Scan to body: places of joints in the world. */
  world(position: Vec3): Vector3 {
    return new Vector3(...position).sub(this.origin).applyMatrix4(this.scanRoot.matrix);
  }

  /** Body to scan. */
  scan(position: Vector3): Vec3 {
    return position.clone().applyMatrix4(this.scanRoot.matrix.clone().invert()).add(this.origin).toArray();
  }

  scanDirection(direction: Vector3): Vec3 {
    const inverse = this.scanRoot.matrix.clone().invert();
    return direction.clone().transformDirection(inverse).toArray();
  }

  /** Where a joint is drawn; null when it is not. */
  placeOf(joint: string | undefined): Vector3 | null {
    return this.shown.find((each) => each.joint === joint)?.position ?? null;
  }

  pane(name: PaneName): Pane {
    return this.panes.find((pane) => pane.name === name)!;
  }

  /** Joint under a pixel of a pane; of several, the nearest. */
  jointAt(pane: Pane, x: number, y: number, pointer: string): ShownJoint | null {
    const reach = pointer === "touch" ? REACH.touch : REACH.mouse;
    let best: ShownJoint | null = null;
    let least = reach;
    for (const joint of this.shown) {
      const { x: u, y: v } = pane.pixel(joint.position);
      // One that is chosen already is easier to take again.
      const distance = Math.hypot(u - x, v - y) - (joint.selected ? 4 : 0);
      if (distance < least) [best, least] = [joint, distance];
    }
    return best;
  }

  box(): Box3 {
    const box = new Box3().setFromObject(this.scanRoot);
    return box.isEmpty() ? new Box3(new Vector3(-0.5, -1, -0.3), new Vector3(0.5, 1, 0.3)) : box;
  }

  fit(): void {
    this.fitted = this.scanRoot.children.length > 0;
    const box = this.box();
    for (const pane of this.panes) pane.fit(box);
    this.request();
  }

  /** @param name  the pane that a pointer drags in; null: none */
  setForemost(name: PaneName | null): void {
    clearTimeout(this.resting);
    this.foremost = name;
    this.showScan();
    this.request();
  }

  /** @param pane  the only one that changed */
  request(pane?: PaneName): void {
    for (const { name } of this.panes) if (!pane || name === pane) this.outdated.add(name);
    this.schedule();
  }

  dispose(): void {
    clearTimeout(this.resting);
    cancelAnimationFrame(this.frame);
    this.frame = -1;
    this.observer.disconnect();
    for (const pane of this.panes) pane.dispose();
    clear(this.scanRoot);
    clear(this.bodyRoot);
    this.joints.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private schedule(): void {
    if (this.frame !== 0) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.draw();
    });
  }

  /** The whole scan, or while something is dragged the coarse one. */
  private showScan(): void {
    const [whole, coarse] = this.scanRoot.children;
    if (!whole || !coarse) return;
    whole.visible = this.foremost === null;
    coarse.visible = this.foremost !== null;
  }

  private draw(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    const ratio = this.renderer.getPixelRatio();
    if (
      this.canvas.width !== Math.floor(width * ratio) ||
      this.canvas.height !== Math.floor(height * ratio)
    ) {
      this.renderer.setSize(width, height, false);
      for (const { name } of this.panes) this.outdated.add(name);
    }
    const whole = this.canvas.getBoundingClientRect();
    for (const pane of this.panes) {
      if (!this.outdated.has(pane.name) || (this.foremost && this.foremost !== pane.name)) continue;
      this.outdated.delete(pane.name);
      const part = pane.element.getBoundingClientRect();
      const area = [part.left - whole.left, whole.bottom - part.bottom, part.width, part.height] as const;
      if (part.width === 0 || part.height === 0) continue;
      this.beforePane(pane);
      this.renderer.setViewport(...area);
      this.renderer.setScissor(...area);
      this.renderer.render(this.scene, pane.camera);
    }
    this.onDrawn();
    clearTimeout(this.resting);
    if (this.foremost && this.outdated.size > 0) {
      this.resting = setTimeout(() => {
        const dragged = this.foremost;
        this.foremost = null;
        this.draw();
        this.foremost = dragged;
      }, REST_MS);
    }
  }
}

/** A scan that lets what is in it be seen. */
function shaded(mesh: MeshData): Mesh | Points {
  const object = scanObject(mesh) as Mesh | Points;
  const material = object.material as MeshLambertMaterial;
  material.transparent = true;
  material.opacity = 0.5;
  // Otherwise each triangle is drawn twice, by programs that are made anew each time.
  material.forceSinglePass = true;
  object.renderOrder = 1;
  return object;
}
