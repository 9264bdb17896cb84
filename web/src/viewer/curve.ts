// A tape or line on the body: bright where it can be seen, faint where the body hides it.
import { Group } from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import type { Vec3 } from "../core/types";

const COLOUR = 0xc2185b;

/** @param course corners, body frame, metres */
export function curveOf(course: readonly Vec3[]): Group {
  const geometry = new LineGeometry();
  geometry.setPositions(course.flat());
  const group = new Group();
  for (const hidden of [true, false]) {
    const material = new LineMaterial({
      color: COLOUR,
      linewidth: hidden ? 2 : 4,
      transparent: hidden,
      opacity: hidden ? 0.35 : 1,
      depthTest: !hidden,
      // The tape lies on the skin: it wins against it.
      polygonOffset: !hidden,
      polygonOffsetFactor: -8,
      polygonOffsetUnits: -8,
    });
    const line = new Line2(geometry, material);
    line.renderOrder = 3;
    group.add(line);
  }
  return group;
}

export function disposeCurve(root: Group): void {
  for (const group of [...root.children]) {
    for (const line of group.children as Line2[]) {
      line.geometry.dispose();
      line.material.dispose();
    }
    root.remove(group);
  }
}
