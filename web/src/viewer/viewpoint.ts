// Where the view is seen from. World frame: the body frame (metres, Y up).
import { Box3, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export type Direction = "front" | "back" | "left" | "right" | "top";

const FROM: Record<Direction, readonly [number, number, number]> = {
  front: [0, 0, 1],
  back: [0, 0, -1],
  left: [1, 0, 0],
  right: [-1, 0, 0],
  top: [0, 1, 0.001],
};
/** What is looked at when there is nothing. */
const PERSON = new Box3(new Vector3(-0.5, -0.9, -0.2), new Vector3(0.5, 0.9, 0.2));

export class Viewpoint {
  readonly camera = new PerspectiveCamera(35, 1, 0.01, 100);
  readonly controls: OrbitControls;

  constructor(canvas: HTMLCanvasElement, changed: () => void) {
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", changed);
  }

  setAspect(aspect: number): void {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
  }

  /** Turns the camera to a side of the body; fit() then brings everything in sight. */
  turnTo(direction: Direction): void {
    this.camera.position.copy(this.controls.target).add(new Vector3(...FROM[direction]));
  }

  /** Moves the camera, keeping its direction, until the box is in sight. */
  fit(box: Box3, aspect: number): void {
    const sight = box.isEmpty() ? PERSON : box;
    const centre = sight.getCenter(new Vector3());
    const size = sight.getSize(new Vector3());
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const width = Math.hypot(size.x, size.z);
    const distance = Math.max(size.y / 2 / half, width / 2 / half / aspect) * 1.12 + width / 2;
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction, distance);
    this.controls.update();
  }

  /** Turns the camera round the body by angles in radians. */
  orbit(azimuth: number, elevation: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(new Vector3(0, 1, 0), azimuth);
    const side = new Vector3().crossVectors(new Vector3(0, 1, 0), offset).normalize();
    const turned = offset.clone().applyAxisAngle(side, -elevation);
    if (Math.abs(turned.clone().normalize().y) < 0.99) offset.copy(turned);
    this.moveTo(offset);
  }

  /** @param factor above 1: nearer */
  zoom(factor: number): void {
    this.moveTo(this.camera.position.clone().sub(this.controls.target).divideScalar(factor));
  }

  private moveTo(offset: Vector3): void {
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }
}
