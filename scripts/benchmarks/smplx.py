"""SMPL-X forward in NumPy, as published: to rebuild data sets that hold SMPL-X parameters (Pavlakos et al. 2019).

Reads the user's own model file; none is part of this project."""
from dataclasses import dataclass
from pathlib import Path

import numpy as np

BODY_JOINTS, HAND_JOINTS = 21, 15
# Order of the pose in the model: root, body, jaw, eyes, hands.
POSE_KEYS = (("global_orient", 1), ("body_pose", BODY_JOINTS), ("jaw_pose", 1), ("leye_pose", 1), ("reye_pose", 1),
             ("left_hand_pose", HAND_JOINTS), ("right_hand_pose", HAND_JOINTS))
KEYS_NEEDED = ("v_template", "shapedirs", "posedirs", "J_regressor", "weights", "kintree_table", "f")


def rotation_from_axis_angle(vectors):
    """(N,3) radians -> (N,3,3), Rodrigues."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = (vectors / np.maximum(angle[:, :, 0], 1e-12)).T
    zero = np.zeros_like(x)
    cross = np.stack([np.stack(row, 1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))], 1)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


@dataclass
class Smplx:
    """Arrays of a SMPL-X .npz, float64. V vertices, 55 joints."""

    arrays: dict
    parents: np.ndarray
    expression_start: int

    @classmethod
    def read(cls, path):
        path = Path(path)
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays = {k: np.asarray(file[k]) for k in KEYS_NEEDED}
                hands = {k: np.asarray(file[k], float) for k in ("hands_meanl", "hands_meanr", "hands_componentsl", "hands_componentsr")
                         if k in file.files}
        except (OSError, ValueError, KeyError) as problem:
            raise SystemExit(f"{path}: not a SMPL-X model in .npz ({problem}): give SMPLX_NEUTRAL.npz of SMPL-X 1.1") from problem
        if arrays["weights"].shape[1] != 55:
            raise SystemExit(f"{path}: has {arrays['weights'].shape[1]} joints, SMPL-X has 55: give SMPLX_NEUTRAL.npz")
        parents = arrays["kintree_table"][0].astype(np.int64)
        parents[0] = -1
        arrays = {k: v if k == "f" else v.astype(np.float64) for k, v in arrays.items()}
        return cls(arrays | hands, parents, 300 if arrays["shapedirs"].shape[2] > 300 else 10)

    @property
    def faces(self):
        return self.arrays["f"].astype(np.int32)

    def rotations(self, key, joints, value):
        """(joints,3,3) of a parameter given as matrices, as axis-angle or, for hands, as PCA coefficients."""
        value = np.asarray(value, float)
        if value.shape[-2:] == (3, 3) and value.size == joints * 9:
            return value.reshape(joints, 3, 3)
        if value.size == joints * 3:
            return rotation_from_axis_angle(value.reshape(joints, 3))
        side = key[0]
        components = self.arrays.get(f"hands_components{side}")
        if key.endswith("hand_pose") and components is not None and value.ndim == 1 and value.size <= len(components):
            full = value @ components[:value.size] + self.arrays[f"hands_mean{side}"]
            return rotation_from_axis_angle(full.reshape(joints, 3))
        raise ValueError(f"'{key}' has the shape {value.shape}, which is neither {joints} rotation matrices nor axis-angle")

    def pose(self, parameters):
        """Vertices (V,3) and joints (55,3) in metres. parameters: arrays of one person and frame; those left out are zero."""
        a = self.arrays
        shape = np.zeros(a["shapedirs"].shape[2])
        for key, start in (("betas", 0), ("expression", self.expression_start)):
            values = np.asarray(parameters.get(key, ()), float).ravel()
            shape[start:start + values.size] = values
        rest = a["v_template"] + a["shapedirs"] @ shape
        rest_joints = a["J_regressor"] @ rest
        rotation = np.concatenate([self.rotations(key, n, parameters[key]) if key in parameters else np.tile(np.eye(3), (n, 1, 1))
                                   for key, n in POSE_KEYS])
        feature = (rotation[1:] - np.eye(3)).ravel()
        rest = rest + a["posedirs"].reshape(rest.shape[0], 3, -1) @ feature
        world = np.tile(np.eye(4), (len(rotation), 1, 1))
        for j, parent in enumerate(self.parents):
            local = np.eye(4)
            local[:3, :3] = rotation[j]
            local[:3, 3] = rest_joints[j] - (rest_joints[parent] if parent >= 0 else 0)
            world[j] = local if parent < 0 else world[parent] @ local
        joints = world[:, :3, 3].copy()
        posed_from_rest = world.copy()
        posed_from_rest[:, :3, 3] -= np.einsum("jab,jb->ja", world[:, :3, :3], rest_joints)
        blended = np.einsum("vj,jab->vab", a["weights"], posed_from_rest)
        vertices = np.einsum("vab,vb->va", blended[:, :3, :3], rest) + blended[:, :3, 3]
        move = np.asarray(parameters.get("transl", np.zeros(3)), float).ravel()
        return vertices + move, joints + move
