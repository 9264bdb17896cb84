// The body's own directions beside the scan: how it was aligned can be seen at a glance.
import {
  ArrowHelper,
  type Box3,
  CanvasTexture,
  Group,
  type Material,
  Sprite,
  SpriteMaterial,
  SRGBColorSpace,
  Vector3,
} from "three";

/** Okabe and Ito's colours, which colour-blind eyes tell apart. */
const DIRECTIONS: readonly [string, readonly [number, number, number], number][] = [
  ["up", [0, 1, 0], 0x009e73],
  ["front", [0, 0, 1], 0x0072b2],
  ["left", [1, 0, 0], 0xd55e00],
];
/** Free space between the scan and the arrows. */
const GAP_M = 0.35;
const LENGTH_M = 0.3;
const LABEL_M = 0.11;

/** Arrows from the floor at the right of `box`; world frame: the body frame. */
export function bodyAxes(box: Box3): Group {
  const group = new Group();
  const origin = new Vector3(box.min.x - GAP_M, box.min.y, (box.min.z + box.max.z) / 2);
  if (box.isEmpty()) return group;
  for (const [name, direction, colour] of DIRECTIONS) {
    const along = new Vector3(...direction);
    const arrow = new ArrowHelper(along, origin, LENGTH_M, colour, 0.07, 0.04);
    const text = label(name, colour);
    text.position.copy(origin).addScaledVector(along, LENGTH_M + LABEL_M / 2);
    group.add(arrow, text);
  }
  return group;
}

function label(text: string, colour: number): Sprite {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [128, 64];
  const context = canvas.getContext("2d")!;
  context.font = "600 40px system-ui, sans-serif";
  [context.textAlign, context.textBaseline] = ["center", "middle"];
  context.lineWidth = 8;
  context.lineJoin = "round";
  context.strokeStyle = "#ffffffd0";
  context.strokeText(text, 64, 32);
  context.fillStyle = `#${colour.toString(16).padStart(6, "0")}`;
  context.fillText(text, 64, 32);
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  const sprite = new Sprite(new SpriteMaterial({ map, depthTest: false }));
  sprite.scale.set(2 * LABEL_M, LABEL_M, 1);
  sprite.renderOrder = 3;
  return sprite;
}

export function disposeAxes(root: Group): void {
  root.traverse((each) => {
    if (each instanceof ArrowHelper) each.dispose();
    if (each instanceof Sprite) {
      each.material.map?.dispose();
      (each.material as Material).dispose();
    }
  });
  root.clear();
}
