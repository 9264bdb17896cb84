"""Brings characters from the package's A-pose into the model's T-pose by linear blending."""
import numpy as np
from scipy.spatial.transform import Rotation

from .skeleton import INDEX, JOINTS, PARENT

# Share of the arm's swing that the collar bone takes (scapular rhythm).
COLLAR_SHARE = 0.33


def _unit(a):
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


def _swing(a, b):
    """Smallest rotations taking directions a [N,3] to b, [N,3,3]."""
    a, b = _unit(a), _unit(np.broadcast_to(b, a.shape))
    axis, cosine = np.cross(a, b), (a * b).sum(-1)
    k = np.zeros(a.shape[:-1] + (3, 3))
    k[..., 0, 1], k[..., 0, 2], k[..., 1, 2] = -axis[..., 2], axis[..., 1], -axis[..., 0]
    k -= np.swapaxes(k, -1, -2)
    return np.eye(3) + k + k @ k / (1 + cosine)[..., None, None]


def _frame(x, y):
    """Orthonormal frames whose rows are x, y made orthogonal to x, and their cross product."""
    x = _unit(x)
    y = _unit(y - (x * y).sum(-1, keepdims=True) * x)
    return np.stack([x, y, np.cross(x, y)], -2)


def turns_to_t_pose(centres):
    """World rotations [N,24,3,3] of each joint's bone from A-pose to T-pose.

    centres: {joint name: [N,3]}, the 24 joints and left_/right_ index and pinky. Trunk, head and feet keep their
    direction; thighs and shins take the population's mean direction; upper arms, forearms and hands lie along +-X with
    the elbows' hinge axes vertical (forearms flex forward) and the palms down.
    """
    n = len(centres["pelvis"])
    turns = np.tile(np.eye(3), (n, 24, 1, 1))
    mean = {name: c.mean(0) for name, c in centres.items()}

    def mean_bone(side, upper, lower):
        left = mean["left_" + lower] - mean["left_" + upper]
        right = mean["right_" + lower] - mean["right_" + upper]
        direction = (left + right * [-1, 1, 1]) / 2
        return direction * ([1, 1, 1] if side == "left" else [-1, 1, 1])

    for side, sign in (("left", 1.0), ("right", -1.0)):
        c = {name[len(side) + 1 :]: centres[name] for name in centres if name.startswith(side)}
        turns[:, INDEX[side + "_hip"]] = _swing(c["knee"] - c["hip"], mean_bone(side, "hip", "knee"))
        turns[:, INDEX[side + "_knee"]] = _swing(c["ankle"] - c["knee"], mean_bone(side, "knee", "ankle"))
        along = np.broadcast_to([sign, 0.0, 0.0], (n, 3))
        upper, fore, hand = c["elbow"] - c["shoulder"], c["wrist"] - c["elbow"], c["hand"] - c["wrist"]
        hinge = np.cross(upper, fore)
        target = np.swapaxes(_frame(along, np.broadcast_to([0.0, -sign, 0.0], (n, 3))), -1, -2)
        turns[:, INDEX[side + "_shoulder"]] = target @ _frame(upper, hinge)
        turns[:, INDEX[side + "_elbow"]] = target @ _frame(fore, hinge)
        swing = Rotation.from_matrix(_swing(upper, along)).as_rotvec()
        turns[:, INDEX[side + "_collar"]] = Rotation.from_rotvec(COLLAR_SHARE * swing).as_matrix()
        palm = -sign * np.cross(c["index"] - c["wrist"], c["pinky"] - c["wrist"])
        palm_target = np.swapaxes(_frame(along, np.broadcast_to([0.0, -1.0, 0.0], (n, 3))), -1, -2)
        for joint in ("_wrist", "_hand"):
            turns[:, INDEX[side + joint]] = palm_target @ _frame(hand, palm)
    return turns


def t_pose_centres(centres, turns):
    """Joint centres in T-pose with the pelvis at the origin, [N,24,3]. centres [N,24,3] in A-pose."""
    out = np.zeros_like(centres)
    for j in range(1, len(JOINTS)):
        p = PARENT[j]
        out[:, j] = out[:, p] + np.einsum("nab,nb->na", turns[:, p], centres[:, j] - centres[:, p])
    return out


def to_t_pose(skin, weights, centres, turns, centres_t):
    """T-pose skin [N,V,3] float32. skin [N,V,3] in A-pose, weights [V,24], centres, turns, centres_t as above.

    The blended A-to-T transform is used as it is: the inverse of the T-to-A one would give the A-pose back to the
    last digit instead of 0.4 mm, but swells the armpits.
    """
    shift = centres_t - np.einsum("njab,njb->nja", turns, centres)
    out = np.empty(skin.shape, np.float32)
    for i in range(len(skin)):
        blend = (weights @ turns[i].reshape(24, 9)).reshape(-1, 3, 3)
        out[i] = np.einsum("vab,vb->va", blend, skin[i]) + weights @ shift[i]
    return out
