"""Pose correctives: sparse linear functions of the joints' rotations that undo the artefacts of linear blending.

The target of a pose is a mixture of linear and dual-quaternion blending, moved along the normals so that the volume
around each bent joint stays what it is at rest. The blocks are fitted by ridge regression over random poses and shapes.
"""
import numpy as np

from .posing import dual_quaternion_blend, linear_blend, random_pose, skinning_transforms
from .skeleton import DESCENDS, MIRROR
from .skin_weights import smoothed
from .surface import face_normals, vertex_areas, vertex_normals

DUAL_SHARE = 0.65
VOLUME_SHARE = 0.6
MAX_VOLUME_OFFSET = 0.015
MAX_OFFSET = 0.05
# A joint concerns a vertex as far as its weights are split between what hangs below the joint and the rest: its
# activity is 4 b (1 - b) with the share b below. The penalty RIDGE / activity^2 lets blocks fade out with it.
RIDGE = 1.0
MIN_ACTIVITY = 0.04
SMOOTHING_PASSES = 3
MIN_BLOCK_RMS = 1.5e-4

_SIGN = np.array([-1.0, 1.0, 1.0])
_BLOCK_SIGN = _SIGN[:, None] * np.outer(_SIGN, _SIGN).ravel()[None, :]


def activities(weights):
    """How much each joint bends the skin at a vertex, [V,24] in 0..1; 0 for the root."""
    below = (weights @ DESCENDS).clip(0, 1)
    out = 4 * below * (1 - below)
    out[:, 0] = 0
    return out


class _LocalVolumes:
    """Volume around each joint: the cones from the joint's centre over the faces that bend with it."""

    def __init__(self, faces, weights):
        self.faces = faces
        self.activity = activities(weights).T[1:]
        self.face_activity = self.activity[:, faces].mean(2)

    def of(self, vertices, joints):
        normal = face_normals(vertices, self.faces)
        flux = np.einsum("fi,fi->f", vertices[self.faces].mean(1), normal)
        return (self.face_activity @ flux - np.einsum("ji,ji->j", joints[1:], self.face_activity @ normal)) / 6

    def restored(self, vertices, joints, volumes):
        """Vertices moved along their normals towards the given volumes."""
        lack = volumes - self.of(vertices, joints)
        area = vertex_areas(vertices, self.faces)
        effect = (self.activity**2 @ area).clip(1e-6)
        offset = np.clip(VOLUME_SHARE * (lack / effect) @ self.activity, -MAX_VOLUME_OFFSET, MAX_VOLUME_OFFSET)
        return vertices + offset[:, None] * vertex_normals(vertices, self.faces)


def rest_offset(vertices, joints, weights, faces, turns, local):
    """Offsets [V,3] in the rest frame that make linear blending reach the target in a pose."""
    transforms = skinning_transforms(joints, turns)
    linear = linear_blend(vertices, weights, transforms)
    target = linear + DUAL_SHARE * (dual_quaternion_blend(vertices, weights, transforms) - linear)
    centres = np.einsum("jab,jb->ja", transforms[:, :, :3], joints) + transforms[:, :, 3]
    target = local.restored(target, centres, local.of(vertices, joints))
    blend = (weights @ transforms[:, :, :3].reshape(24, 9)).reshape(-1, 3, 3)
    offset = np.linalg.solve(blend, (target - linear)[:, :, None])[:, :, 0]
    length = np.linalg.norm(offset, axis=1, keepdims=True)
    return offset * np.minimum(1, MAX_OFFSET / np.maximum(length, 1e-9))


def fitted_correctives(mean, directions, regressor, weights, faces, vertex_mirror, rng, count=420):
    """(vertex [B], joint [B], block [B,3,9]), sorted by vertex then joint, exactly symmetric."""
    local = _LocalVolumes(faces, weights)
    features = np.empty((count, 24, 9))
    offsets = np.empty((count, len(mean), 3))
    for i in range(count):
        shape = mean + np.tensordot(rng.normal(size=len(directions)), directions, 1)
        turns = random_pose(rng)
        features[i] = (turns - np.eye(3)).reshape(24, 9)
        offsets[i] = rest_offset(shape, regressor @ shape, weights, faces, turns, local)
    activity = activities(weights)
    dense = np.zeros((len(mean), 24 * 27))
    dense.reshape(-1, 24, 3, 9)[:] = _ridge_blocks(features, offsets, activity)
    dense = smoothed(dense, faces, np.full(len(mean), 0.5), SMOOTHING_PASSES).reshape(-1, 24, 3, 9)
    dense = 0.5 * (dense + dense[vertex_mirror][:, MIRROR] * _BLOCK_SIGN)
    spread = np.sqrt((features**2).mean(0))
    spread = 0.5 * (spread + spread[MIRROR])
    rms = np.sqrt(((dense * spread[None, :, None, :]) ** 2).sum((2, 3)))
    vertex, joint = np.nonzero(rms > MIN_BLOCK_RMS)
    return vertex, joint, dense[vertex, joint]


def _ridge_blocks(features, offsets, activity):
    """Blocks [V,24,3,9] that map features [N,24,9] to offsets [N,V,3]."""
    count, vertices = offsets.shape[:2]
    blocks = np.zeros((vertices, 24, 3, 9))
    patterns, group = np.unique(activity > MIN_ACTIVITY, axis=0, return_inverse=True)
    for g, pattern in enumerate(patterns):
        joints = np.nonzero(pattern)[0]
        members = np.nonzero(group == g)[0]
        if not len(joints):
            continue
        a = features[:, joints].reshape(count, -1)
        penalty = RIDGE / np.repeat(activity[members][:, joints] ** 2, 9, axis=1)
        systems = np.tile(a.T @ a, (len(members), 1, 1))
        systems[:, np.arange(a.shape[1]), np.arange(a.shape[1])] += penalty
        right = (a.T @ offsets[:, members].reshape(count, -1)).reshape(-1, len(members), 3).transpose(1, 0, 2)
        solved = np.linalg.solve(systems, right).reshape(len(members), len(joints), 9, 3)
        blocks[members[:, None], joints[None, :]] = solved.transpose(0, 1, 3, 2)
    return blocks


def corrected(vertices, turns, vertex, joint, block):
    """Rest vertices [V,3] with the correctives of a pose added."""
    feature = (turns - np.eye(3)).reshape(24, 9)
    out = vertices.copy()
    np.add.at(out, vertex, np.einsum("bcf,bf->bc", block, feature[joint]))
    return out
