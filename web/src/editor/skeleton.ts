// The 22 joints of the keypoints, SMPL's names and order.

export const JOINTS = [
  "pelvis",
  "left_hip",
  "right_hip",
  "spine1",
  "left_knee",
  "right_knee",
  "spine2",
  "left_ankle",
  "right_ankle",
  "spine3",
  "left_foot",
  "right_foot",
  "neck",
  "left_collar",
  "right_collar",
  "head",
  "left_shoulder",
  "right_shoulder",
  "left_elbow",
  "right_elbow",
  "left_wrist",
  "right_wrist",
] as const;
export type Joint = (typeof JOINTS)[number];

/** Parent of each joint; the root has none. */
const PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19];

/** Bones as pairs of joints, parent first. */
export const BONES: readonly (readonly [Joint, Joint])[] = JOINTS.flatMap((joint, i) =>
  i === 0 ? [] : [[JOINTS[PARENTS[i]!]!, joint] as const],
);

/** A joint and all that hang on it. */
export function limbOf(joint: Joint): Joint[] {
  const limb = new Set<Joint>([joint]);
  for (const [parent, child] of BONES) if (limb.has(parent)) limb.add(child);
  return [...limb];
}
