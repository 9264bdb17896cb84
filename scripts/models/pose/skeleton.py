"""Joints, rotations and forward kinematics of the 24-joint SMPL skeleton, in numpy.

Poses are (N, 24, 3) parent-relative axis-angle, radians; positions are metres, Y up, T-pose facing +Z, left on +X.
"""
import numpy as np
from scipy.spatial.transform import Rotation

NAMES = ("pelvis left_hip right_hip spine1 left_knee right_knee spine2 left_ankle right_ankle spine3 left_foot "
         "right_foot neck left_collar right_collar head left_shoulder right_shoulder left_elbow right_elbow left_wrist "
         "right_wrist left_hand right_hand").split()
INDEX = {name: k for k, name in enumerate(NAMES)}
PARENT = np.array([-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21])
# The joint that each one becomes in a mirror.
MIRROR = np.array([INDEX[name.replace("left", "?").replace("right", "left").replace("?", "right")] for name in NAMES])
# T-pose joints of the default body's mean shape.
REST = np.array([
    [0.0000, -0.0001, -0.0004],
    [0.1040, -0.0924, 0.0327],
    [-0.1040, -0.0924, 0.0327],
    [0.0000, 0.0682, 0.0157],
    [0.1458, -0.4800, 0.0621],
    [-0.1458, -0.4800, 0.0621],
    [0.0000, 0.1514, 0.0167],
    [0.1869, -0.8969, 0.0409],
    [-0.1869, -0.8969, 0.0409],
    [0.0000, 0.2937, 0.0041],
    [0.1967, -0.9426, 0.1715],
    [-0.1967, -0.9426, 0.1715],
    [0.0000, 0.4725, 0.0369],
    [0.0231, 0.4003, 0.0528],
    [-0.0231, 0.4003, 0.0528],
    [0.0000, 0.5431, 0.0550],
    [0.1725, 0.4200, 0.0472],
    [-0.1725, 0.4200, 0.0472],
    [0.4187, 0.4200, 0.0472],
    [-0.4187, 0.4200, 0.0472],
    [0.6572, 0.4200, 0.0473],
    [-0.6572, 0.4200, 0.0473],
    [0.7552, 0.4200, 0.0473],
    [-0.7552, 0.4200, 0.0473],
])


def matrices(rotation_vectors):
    """(..., 3) axis-angle -> (..., 3, 3)."""
    v = np.asarray(rotation_vectors, np.float64)
    return Rotation.from_rotvec(v.reshape(-1, 3)).as_matrix().reshape(*v.shape, 3)


def vectors(rotations):
    """(..., 3, 3) -> (..., 3) axis-angle, angle in [0, pi]."""
    r = np.asarray(rotations)
    return Rotation.from_matrix(r.reshape(-1, 3, 3)).as_rotvec().reshape(r.shape[:-1])


def about(axis, angles):
    """Rotation matrices (N, 3, 3) about one coordinate axis "x", "y" or "z"."""
    return Rotation.from_euler(axis, np.asarray(angles, np.float64)).as_matrix()


def forward(rotations, rest=REST):
    """Global rotations (N, 24, 3, 3) and joints (N, 24, 3) with the pelvis at its rest place."""
    world = np.empty_like(rotations)
    joints = np.empty(rotations.shape[:2] + (3,))
    world[:, 0], joints[:, 0] = rotations[:, 0], rest[0]
    for j in range(1, 24):
        p = PARENT[j]
        world[:, j] = world[:, p] @ rotations[:, j]
        joints[:, j] = joints[:, p] + world[:, p] @ (rest[j] - rest[p])
    return world, joints


def body_joints(poses):
    """Joints (N, 24, 3) with the root's rotation left out."""
    rotations = matrices(poses)
    rotations[:, 0] = np.eye(3)
    return forward(rotations)[1]


def mirrored(poses):
    """The poses of the bodies seen in a mirror (x -> -x)."""
    return poses[:, MIRROR] * np.array([1.0, -1.0, -1.0])


def angle_between(a, b):
    """Angle in radians between rotation matrices (..., 3, 3), exact also for small angles."""
    d = np.swapaxes(a, -1, -2) @ b
    return Rotation.from_matrix(d.reshape(-1, 3, 3)).magnitude().reshape(d.shape[:-2])
