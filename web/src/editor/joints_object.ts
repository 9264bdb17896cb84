// The skeleton as the editor draws it: a joint's shape says where it comes from, its colour how sure it is.
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  Color,
  type BufferGeometry as Geometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  OctahedronGeometry,
  SphereGeometry,
  TorusGeometry,
  type Vector3,
} from "three";
import { confidenceColour } from "../result/colours";
import { BONES, type Joint } from "./skeleton";

export type Source = "detected" | "derived" | "user" | "none";

export interface ShownJoint {
  joint: Joint;
  /** world */
  position: Vector3;
  confidence: number;
  source: Source;
  locked: boolean;
  selected: boolean;
}

const SIZE_M = 0.016;
const SELECTED = 1.6;
const BONE_COLOUR = 0x8b2f6b;
const USER_COLOUR = "#2f6fd0";

export class JointsObject {
  readonly root = new Group();
  private readonly shapes: Record<Source, Geometry> = {
    detected: new SphereGeometry(SIZE_M, 16, 12),
    derived: new OctahedronGeometry(SIZE_M * 1.25),
    user: new BoxGeometry(1.7 * SIZE_M, 1.7 * SIZE_M, 1.7 * SIZE_M),
    none: new TorusGeometry(SIZE_M, SIZE_M / 5, 8, 20),
  };
  private readonly bones = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color: BONE_COLOUR, depthTest: false, transparent: true }),
  );
  private readonly dots = new Map<Joint, Mesh<Geometry, MeshBasicMaterial>>();

  constructor() {
    this.bones.renderOrder = 3;
    this.bones.frustumCulled = false;
    this.root.add(this.bones);
  }

  update(joints: readonly ShownJoint[]): void {
    const at = new Map(joints.map((each) => [each.joint, each]));
    for (const [joint, dot] of this.dots) dot.visible = at.has(joint);
    for (const each of joints) {
      const dot = this.dot(each.joint);
      dot.geometry = this.shapes[each.source];
      dot.position.copy(each.position);
      dot.scale.setScalar(each.selected ? SELECTED : 1);
      const colour = each.source === "user" ? USER_COLOUR : confidenceColour(each.confidence);
      dot.material.color.copy(new Color(colour.replaceAll(" ", ",")));
      dot.material.opacity = each.locked ? 0.45 : 1;
    }
    const ends = BONES.flatMap(([parent, child]) => {
      const [a, b] = [at.get(parent), at.get(child)];
      return a && b ? [...a.position.toArray(), ...b.position.toArray()] : [];
    });
    this.bones.geometry.dispose();
    this.bones.geometry = new BufferGeometry().setAttribute(
      "position",
      new BufferAttribute(new Float32Array(ends), 3),
    );
  }

  dispose(): void {
    for (const shape of Object.values(this.shapes)) shape.dispose();
    for (const dot of this.dots.values()) dot.material.dispose();
    this.bones.geometry.dispose();
    this.bones.material.dispose();
  }

  private dot(joint: Joint): Mesh<Geometry, MeshBasicMaterial> {
    let dot = this.dots.get(joint);
    if (!dot) {
      dot = new Mesh(this.shapes.none, new MeshBasicMaterial({ depthTest: false, transparent: true }));
      dot.renderOrder = 4;
      this.dots.set(joint, dot);
      this.root.add(dot);
    }
    return dot;
  }
}
