"""The line segments heat flows from: the rig's bones, and rings in the trunk, whose spine lies near the back."""
import numpy as np

from .skeleton import INDEX, joint_of_bone
from .skin_weights import segment_distances

# Rings reach this share of the way from the trunk's axis to its skin.
RING_SHRINK = 0.62
RING_SIDES = 16
_TRUNK_JOINTS = "pelvis spine1 spine2 spine3 left_hip right_hip left_collar right_collar neck".split()
# Each ring: the bone that owns it, and its height as (bone, position along the bone from head 0 to tail 1).
_RINGS = [
    ("spine05", "upperleg01.L", -0.37),
    ("spine05", "spine04", 0.15),
    ("spine04", "spine04", 0.65),
    ("spine03", "spine03", 0.25),
    ("spine03", "spine03", 0.70),
    ("spine02", "spine02", 0.20),
    ("spine02", "spine02", 0.50),
    ("spine02", "spine02", 0.80),
    ("spine01", "spine01", 0.15),
    ("spine01", "spine01", 0.40),
]


def bone_segments(names, ends, vertices):
    """Segments for bone_heat: (begin [B,3], end [B,3], owner [B] index into names).

    names: rig bones; ends [len(names),2,3]: their heads and tails; vertices [V,3]: the skin, in the package's A-pose.
    """
    begin, end = ends[:, 0].copy(), ends[:, 1].copy()
    for k, name in enumerate(names):
        # The pelvis' side bones end in the hip joints; half of them leaves the thighs their own surroundings.
        if name.startswith("pelvis."):
            end[k] = (begin[k] + end[k]) / 2
    joint = np.array([joint_of_bone(name) for name in names])
    nearest = joint[segment_distances(vertices, begin, end).argmin(1)]
    trunk = vertices[np.isin(nearest, [INDEX[j] for j in _TRUNK_JOINTS])]
    angle = np.arange(RING_SIDES) * 2 * np.pi / RING_SIDES

    def rounded(x):
        return np.sign(x) * np.abs(x) ** 0.7  # a superellipse: trunks are boxier than ellipses

    begins, ends_, owners = [begin], [end], [np.arange(len(names))]
    for owner, bone, along in _RINGS:
        head, tail = ends[names.index(bone)]
        y = (1 - along) * head[1] + along * tail[1]
        slab = trunk[np.abs(trunk[:, 1] - y) < 0.02]
        depth = slab[:, 2]
        ring = np.stack(
            [
                RING_SHRINK * np.abs(slab[:, 0]).max() * rounded(np.cos(angle)),
                np.full(RING_SIDES, y),
                (depth.min() + depth.max()) / 2 + RING_SHRINK * np.ptp(depth) / 2 * rounded(np.sin(angle)),
            ],
            1,
        )
        begins.append(ring)
        ends_.append(np.roll(ring, -1, 0))
        owners.append(np.full(RING_SIDES, names.index(owner)))
    return np.concatenate(begins), np.concatenate(ends_), np.concatenate(owners)
