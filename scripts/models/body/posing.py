"""Posing with 24 joints: kinematic chain, linear and dual-quaternion blend skinning, and named test poses."""
import numpy as np
from scipy.spatial.transform import Rotation

from .skeleton import INDEX, JOINTS, PARENT


def skinning_transforms(joints, rotations):
    """Rest-to-posed transforms of the 24 joints, [24,3,4]. joints [24,3] rest centres, rotations [24,3,3] relative."""
    turn, centre = np.empty((24, 3, 3)), np.empty((24, 3))
    for j in range(24):
        p = PARENT[j]
        turn[j] = rotations[j] if p < 0 else turn[p] @ rotations[j]
        centre[j] = joints[j] if p < 0 else turn[p] @ (joints[j] - joints[p]) + centre[p]
    return np.concatenate([turn, (centre - np.einsum("jab,jb->ja", turn, joints))[:, :, None]], 2)


def linear_blend(vertices, weights, transforms):
    """Linear blend skinning: posed vertices [V,3]."""
    blended = (weights @ transforms.reshape(len(transforms), 12)).reshape(-1, 3, 4)
    return np.einsum("vab,vb->va", blended[:, :, :3], vertices) + blended[:, :, 3]


def _product(a, b):
    """Quaternion product, scalar first."""
    w = a[..., :1] * b[..., :1] - (a[..., 1:] * b[..., 1:]).sum(-1, keepdims=True)
    v = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + np.cross(a[..., 1:], b[..., 1:])
    return np.concatenate([w, v], -1)


def dual_quaternion_blend(vertices, weights, transforms):
    """Dual-quaternion skinning (Kavan et al. 2007): keeps cross-sections where linear blending shrinks them."""
    q = Rotation.from_matrix(transforms[:, :, :3]).as_quat()[:, [3, 0, 1, 2]]
    dual = 0.5 * _product(np.concatenate([np.zeros((len(q), 1)), transforms[:, :, 3]], 1), q)
    sign = np.where(q[weights.argmax(1)] @ q.T < 0, -1.0, 1.0)
    real, dual = (weights * sign) @ q, (weights * sign) @ dual
    norm = np.linalg.norm(real, axis=1, keepdims=True)
    real, dual = real / norm, dual / norm
    shift = 2 * _product(dual, real * [1, -1, -1, -1])[:, 1:]
    return Rotation.from_quat(real[:, [1, 2, 3, 0]]).apply(vertices) + shift


def rotations(**degrees):
    """Relative rotations [24,3,3] from axis-angle vectors in degrees by joint name; both_NAME sets the left joint and
    its mirror image on the right."""
    out = np.tile(np.eye(3), (24, 1, 1))
    for name, vector in degrees.items():
        if name.startswith("both_"):
            out[INDEX["left_" + name[5:]]] = Rotation.from_rotvec(vector, degrees=True).as_matrix()
            mirrored = np.array(vector) * [1, -1, -1]
            out[INDEX["right_" + name[5:]]] = Rotation.from_rotvec(mirrored, degrees=True).as_matrix()
        else:
            out[INDEX[name]] = Rotation.from_rotvec(vector, degrees=True).as_matrix()
    return out


POSES = {
    "t_pose": rotations(),
    "a_pose": rotations(both_collar=(0, 0, -14), both_shoulder=(0, 0, -38)),
    "arms_up": rotations(both_collar=(0, 0, 18), both_shoulder=(0, 0, 60)),
    "arms_down": rotations(both_collar=(0, 0, -16), both_shoulder=(0, 0, -58)),
    "arms_forward": rotations(both_collar=(0, -15, 0), both_shoulder=(0, -70, -10)),
    "sit": rotations(both_hip=(-90, 0, 0), both_knee=(90, 0, 0)),
    "squat": rotations(
        both_hip=(-110, 15, 15), both_knee=(125, 0, 0), both_ankle=(-25, 0, 0), spine1=(15, 0, 0), spine2=(10, 0, 0),
        both_shoulder=(0, -70, -10)
    ),
    "elbow_120": rotations(both_collar=(0, 0, -12), both_shoulder=(0, 0, -45), both_elbow=(0, -120, 0)),
    "twist": rotations(
        both_shoulder=(70, 0, 0), both_elbow=(50, 0, 0), both_wrist=(60, 0, 0), neck=(0, 30, 0), head=(0, 30, 0),
        spine1=(0, 15, 0), spine2=(0, 15, 0)
    ),
}  # fmt: skip

# Ranges from which random poses are drawn, degrees of axis-angle, left side.
POSE_RANGE = {
    "hip": ((-115, -35, -25), (25, 35, 40)),
    "knee": ((0, -5, -5), (130, 5, 5)),
    "ankle": ((-30, -10, -15), (30, 10, 15)),
    "spine1": ((-12, -15, -12), (28, 15, 12)),
    "spine2": ((-12, -15, -12), (28, 15, 12)),
    "spine3": ((-10, -12, -10), (18, 12, 10)),
    "neck": ((-25, -30, -20), (30, 30, 20)),
    "head": ((-25, -30, -15), (25, 30, 15)),
    "collar": ((-8, -15, -20), (8, 12, 22)),
    "shoulder": ((-60, -85, -65), (60, 35, 65)),
    "elbow": ((-60, -130, -5), (60, 0, 5)),
    "wrist": ((-40, -20, -50), (40, 20, 50)),
    "foot": ((-10, 0, 0), (35, 0, 0)),
    "hand": ((0, 0, -10), (0, 0, 10)),
}


def random_pose(rng):
    """Relative rotations [24,3,3] within POSE_RANGE; the root does not turn."""
    out = np.tile(np.eye(3), (24, 1, 1))
    for j, name in enumerate(JOINTS[1:], 1):
        low, high = POSE_RANGE[name.split("_")[-1]]
        vector = rng.uniform(low, high) * rng.choice([0.4, 1.0])
        mirrored = [1, -1, -1] if name.startswith("right_") else [1, 1, 1]
        out[j] = Rotation.from_rotvec(vector * mirrored, degrees=True).as_matrix()
    return out
