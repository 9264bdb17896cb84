// The editor's three views of one scene: front, side, and any direction. World frame: the body frame.
import {
  type Box3,
  Matrix4,
  OrthographicCamera,
  PerspectiveCamera,
  Plane,
  Ray,
  Vector2,
  Vector3,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export type PaneName = "front" | "side" | "free";
type Camera = OrthographicCamera | PerspectiveCamera;

/** From where each looks. */
const FROM: Record<PaneName, Vector3> = {
  front: new Vector3(0, 0, 1),
  side: new Vector3(1, 0, 0),
  free: new Vector3(0.6, 0.25, 1).normalize(),
};
const MARGIN = 1.12;

export class Pane {
  readonly camera: Camera;
  readonly controls: OrbitControls;

  /** @param element what the pointer acts on, over its part of the canvas */
  constructor(
    readonly name: PaneName,
    readonly element: HTMLElement,
    changed: () => void,
  ) {
    this.camera =
      name === "free"
        ? new PerspectiveCamera(32, 1, 0.01, 100)
        : new OrthographicCamera(-1, 1, 1, -1, 0.01, 50);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.enableRotate = name === "free";
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener("change", changed);
  }

  private aspect(): number {
    return Math.max(this.element.clientWidth, 1) / Math.max(this.element.clientHeight, 1);
  }

  /** Brings a box into sight, seen from the pane's side or another one. */
  fit(box: Box3, from: Vector3 = FROM[this.name]): void {
    const centre = box.getCenter(new Vector3());
    const size = box.getSize(new Vector3());
    const width = this.name === "front" ? size.x : this.name === "side" ? size.z : Math.hypot(size.x, size.z);
    const half = (MARGIN * Math.max(size.y, width / this.aspect())) / 2;
    let distance = 5;
    if (this.camera instanceof PerspectiveCamera)
      distance = half / Math.tan((this.camera.fov * Math.PI) / 360) + width / 2;
    else this.camera.zoom = 1 / half;
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(from, distance);
    this.resize();
    this.controls.update();
  }

  resize(): void {
    const { camera } = this;
    if (camera instanceof PerspectiveCamera) camera.aspect = this.aspect();
    else [camera.left, camera.right] = [-this.aspect(), this.aspect()];
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }

  /** Turns the free view. */
  orbit(azimuth: number, elevation: number): void {
    if (this.name !== "free") return;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const up = new Vector3(0, 1, 0);
    offset.applyAxisAngle(up, azimuth);
    const turned = offset
      .clone()
      .applyAxisAngle(new Vector3().crossVectors(up, offset).normalize(), -elevation);
    if (Math.abs(turned.clone().normalize().y) < 0.99) offset.copy(turned);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  /** Pixels from the pane's upper left corner. */
  pixel(point: Vector3): Vector2 {
    const { x, y } = point.clone().project(this.camera);
    return new Vector2(((x + 1) / 2) * this.element.clientWidth, ((1 - y) / 2) * this.element.clientHeight);
  }

  /** -1..1 from pixels of the pane. */
  clip(x: number, y: number): [number, number] {
    return [(2 * x) / this.element.clientWidth - 1, 1 - (2 * y) / this.element.clientHeight];
  }

  /** Line of sight through a pixel. */
  ray(x: number, y: number): Ray {
    const [u, v] = this.clip(x, y);
    const near = new Vector3(u, v, -1).unproject(this.camera);
    const far = new Vector3(u, v, 1).unproject(this.camera);
    return new Ray(near, far.sub(near).normalize());
  }

  /** The point under a pixel that is as far away as `like`. */
  pointAt(x: number, y: number, like: Vector3): Vector3 | null {
    const direction = this.camera.getWorldDirection(new Vector3());
    return this.ray(x, y).intersectPlane(
      new Plane().setFromNormalAndCoplanarPoint(direction, like),
      new Vector3(),
    );
  }

  /** What the pane shows as right and up. */
  axes(): { right: Vector3; up: Vector3 } {
    const [right, up] = [new Vector3(), new Vector3()];
    this.camera.matrixWorld.extractBasis(right, up, new Vector3());
    return { right, up };
  }

  /** Picture from world. */
  clipFromWorld(): Matrix4 {
    return new Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
  }

  dispose(): void {
    this.controls.dispose();
  }
}
