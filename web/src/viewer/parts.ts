// What the view is made of: three.js objects of meshes, keypoints and skeletons.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  type Group,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Points,
  PointsMaterial,
  SphereGeometry,
  SRGBColorSpace,
  Vector3,
} from "three";
import { acceleratedRaycast, computeBoundsTree, disposeBoundsTree } from "three-mesh-bvh";
import type { Keypoint, Mesh as MeshData, Vec3 } from "../core/types";
import { confidenceColour, viridis } from "../result/colours";

BufferGeometry.prototype.computeBoundsTree = computeBoundsTree;
BufferGeometry.prototype.disposeBoundsTree = disposeBoundsTree;
Mesh.prototype.raycast = acceleratedRaycast;

const SCAN_COLOUR = 0xb9bcc2;
const BODY_COLOUR = 0xe0a458;
const SKELETON_COLOUR = 0xb3261e;
const FROM_MODEL_COLOUR = 0xc2185b;
const FROM_SCAN_COLOUR = 0x1b7fbd;
const KEYPOINT_RADIUS_M = 0.014;
/** Parent of each of the 24 joints, in SMPL's order; the root has none. */
const PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21];

export type Surface = Mesh<BufferGeometry, MeshLambertMaterial>;

/** A scan's mesh, or its points where it has no faces. */
export function scanObject(mesh: MeshData): Surface | Points {
  const geometry = geometryOf(mesh);
  if (mesh.indices.length > 0) return new Mesh(geometry, surfaceMaterial(SCAN_COLOUR));
  return new Points(geometry, new PointsMaterial({ color: SCAN_COLOUR, size: 1.5, sizeAttenuation: false }));
}

/** A body that can be picked. */
export function bodyObject(mesh: MeshData): Surface {
  // The tree reorders the triangles, hence the copy.
  const geometry = geometryOf({ ...mesh, indices: mesh.indices.slice() });
  geometry.computeBoundsTree();
  return new Mesh(geometry, surfaceMaterial(BODY_COLOUR));
}

/** Colours a body by its errors, or plainly with null. @param maximumMm of the scale */
export function paintErrors(body: Surface, errorsMm: Float32Array | null, maximumMm: number): void {
  if (errorsMm) {
    const colours = new Float32Array(errorsMm.length * 3);
    const colour = new Color();
    errorsMm.forEach((error, i) => {
      colour.setRGB(...viridis(error / maximumMm), SRGBColorSpace).toArray(colours, 3 * i);
    });
    body.geometry.setAttribute("color", new BufferAttribute(colours, 3));
  } else {
    body.geometry.deleteAttribute("color");
  }
  body.material.vertexColors = errorsMm !== null;
  body.material.color.set(errorsMm ? 0xffffff : BODY_COLOUR);
  body.material.needsUpdate = true;
}

/** A ball at each keypoint that has a place; nothing when none has. */
export function keypointObject(keypoints: readonly Keypoint[]): InstancedMesh | null {
  const seen = keypoints.filter((keypoint) => keypoint.position_m !== null);
  if (seen.length === 0) return null;
  const geometry = new SphereGeometry(KEYPOINT_RADIUS_M, 16, 12);
  const dots = new InstancedMesh(geometry, new MeshBasicMaterial({ depthTest: false }), seen.length);
  dots.renderOrder = 1;
  seen.forEach((keypoint, i) => {
    dots.setMatrixAt(i, new Matrix4().makeTranslation(new Vector3(...keypoint.position_m!)));
    dots.setColorAt(i, new Color(confidenceColour(keypoint.confidence).replaceAll(" ", ",")));
  });
  return dots;
}

/** Bones and joints of the 24, body frame; nothing when there are fewer. */
export function skeletonObjects(joints: readonly Vec3[]): (LineSegments | Points)[] {
  if (joints.length < PARENTS.length) return [];
  const ends = PARENTS.flatMap((parent, joint) =>
    parent < 0 ? [] : [...joints[parent]!, ...joints[joint]!],
  );
  const look = { color: SKELETON_COLOUR, depthTest: false, transparent: true };
  const parts = [
    new LineSegments(positionsOf(ends), new LineBasicMaterial(look)),
    new Points(positionsOf(joints.flat()), new PointsMaterial({ ...look, size: 7, sizeAttenuation: false })),
  ];
  for (const part of parts) part.renderOrder = 2;
  return parts;
}

/** A line for each pair of points (six numbers); the first `ofModel` in another colour than the rest. */
export function pairObjects(pairs: Float32Array, ofModel: number): LineSegments[] {
  const parts = [
    [pairs.subarray(0, 6 * ofModel), FROM_MODEL_COLOUR],
    [pairs.subarray(6 * ofModel), FROM_SCAN_COLOUR],
  ] as const;
  return parts
    .filter(([points]) => points.length > 0)
    .map(([points, color]) => {
      const lines = new LineSegments(
        positionsOf([...points]),
        new LineBasicMaterial({ color, depthTest: false, transparent: true }),
      );
      lines.renderOrder = 2;
      return lines;
    });
}

/** Gives a body other positions of its vertices. @returns false when it has not as many */
export function moveBody(body: Surface, positions: Float32Array): boolean {
  const attribute = body.geometry.getAttribute("position") as BufferAttribute;
  if (attribute.array.length !== positions.length) return false;
  attribute.array.set(positions);
  attribute.needsUpdate = true;
  body.geometry.computeVertexNormals();
  body.geometry.boundsTree?.refit();
  body.geometry.computeBoundingSphere();
  body.geometry.computeBoundingBox();
  return true;
}

/** Removes everything from a group, and from the graphics card. */
export function clear(root: Group): void {
  for (const child of [...root.children]) {
    const { geometry, material } = child as Mesh;
    geometry.disposeBoundsTree?.();
    geometry.dispose();
    for (const each of [material].flat()) each.dispose();
    root.remove(child);
  }
}

function surfaceMaterial(color: number): MeshLambertMaterial {
  return new MeshLambertMaterial({ color, side: DoubleSide, transparent: true });
}

function positionsOf(numbers: number[]): BufferGeometry {
  return new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(numbers), 3));
}

/** The mesh, or bare points, in three.js; normals are made where they are missing. */
export function geometryOf({ positions, normals, indices }: MeshData): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  if (indices.length > 0) {
    geometry.setIndex(new BufferAttribute(indices, 1));
    if (normals) geometry.setAttribute("normal", new BufferAttribute(normals, 3));
    else geometry.computeVertexNormals();
  }
  return geometry;
}
