// Handles that turn, move and scale the scan, or the box that cuts.
import {
  BoxGeometry,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Object3D,
  Vector3,
} from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import type { Matrix } from "../core/types";
import type { Handle } from "./state";
import type { EditorView } from "./view";

const STEP = { rotation: Math.PI / 12, translation_m: 0.01, scale: 0.05 };

/** Four rows of four. */
export function rowsOf({ elements }: Matrix4): Matrix {
  return [0, 1, 2, 3].map((row) => [0, 4, 8, 12].map((column) => elements[row + column]!));
}

class Handles {
  protected readonly controls: TransformControls;

  constructor(
    protected readonly view: EditorView,
    protected readonly object: Object3D,
  ) {
    const pane = view.pane("free");
    this.controls = new TransformControls(pane.camera, pane.element);
    this.controls.setSize(0.9);
    view.scene.add(object, this.controls.getHelper());
    this.controls.attach(object);
    this.controls.addEventListener("change", () => view.request());
    this.controls.addEventListener("dragging-changed", ({ value }) => {
      pane.controls.enabled = !value;
    });
    view.beforePane = (each) => {
      this.controls.getHelper().visible = each.name === "free";
    };
  }

  set(mode: Handle, steps: boolean): void {
    this.controls.setMode(mode);
    this.controls.setRotationSnap(steps ? STEP.rotation : null);
    this.controls.setTranslationSnap(steps ? STEP.translation_m : null);
    this.controls.setScaleSnap(steps ? STEP.scale : null);
    this.view.request();
  }

  dispose(): void {
    this.view.beforePane = () => {};
    this.view.pane("free").controls.enabled = true;
    this.controls.detach();
    this.controls.dispose();
    this.view.scene.remove(this.object, this.controls.getHelper());
    this.view.request();
  }
}

/** Moves the scan in the body frame about its middle; `done` gets where it then lies. */
export class AlignHandles extends Handles {
  private start = new Matrix4();
  private grip = new Matrix4();

  constructor(view: EditorView, done: (body_from_scan: Matrix) => void) {
    super(view, new Object3D());
    this.centre();
    this.controls.addEventListener("mouseDown", () => this.remember());
    this.controls.addEventListener("objectChange", () => this.follow());
    this.controls.addEventListener("mouseUp", () => {
      done(rowsOf(view.bodyFromScan()));
      this.centre();
    });
  }

  /** Turns by radians about an axis of the body frame, through the scan's middle. */
  turned(axis: "x" | "y" | "z", angle: number): Matrix {
    this.centre();
    const direction = new Vector3(axis === "x" ? 1 : 0, axis === "y" ? 1 : 0, axis === "z" ? 1 : 0);
    this.remember();
    this.object.rotateOnWorldAxis(direction, angle);
    this.follow();
    return rowsOf(this.view.bodyFromScan());
  }

  /** Puts the handles into the middle of the scan as it lies now. */
  centre(): void {
    this.object.position.copy(this.view.box().getCenter(new Vector3()));
    this.object.rotation.set(0, 0, 0);
    this.object.scale.setScalar(1);
    this.object.updateMatrixWorld(true);
  }

  private remember(): void {
    this.object.updateMatrixWorld(true);
    this.start.copy(this.view.scanRoot.matrix);
    this.grip.copy(this.object.matrixWorld).invert();
  }

  private follow(): void {
    // One factor for all axes: the body must keep its proportions.
    const { x, y, z } = this.object.scale;
    const scale = [x, y, z].sort(
      (a, b) => Math.abs(Math.log(Math.abs(b) || 1)) - Math.abs(Math.log(Math.abs(a) || 1)),
    )[0]!;
    this.object.scale.setScalar(Math.max(Math.abs(scale), 0.01));
    this.object.updateMatrixWorld(true);
    this.view.scanRoot.matrix.copy(this.start).premultiply(this.grip).premultiply(this.object.matrixWorld);
    this.view.scanRoot.updateMatrixWorld(true);
    this.view.request();
  }
}

/** A box to cut with. */
export class BoxHandles extends Handles {
  constructor(view: EditorView) {
    const box = new Group();
    const edges = new LineSegments(
      new EdgesGeometry(new BoxGeometry(2, 2, 2)),
      new LineBasicMaterial({ color: 0xc2410c }),
    );
    box.add(edges);
    super(view, box);
    // The floor, if there is one, is at the bottom.
    const bounds = view.box();
    const size = bounds.getSize(new Vector3());
    box.position.set(
      (bounds.min.x + bounds.max.x) / 2,
      bounds.min.y + 0.02 * size.y,
      (bounds.min.z + bounds.max.z) / 2,
    );
    box.scale.set(0.52 * size.x, 0.03 * size.y, 0.52 * size.z);
    box.updateMatrixWorld(true);
  }

  /** Scan to the cube from -1 to 1. */
  boxFromScan(): Matrix {
    this.object.updateMatrixWorld(true);
    return rowsOf(this.object.matrixWorld.clone().invert().multiply(this.view.bodyFromScan()));
  }
}
