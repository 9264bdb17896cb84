"""A character of the package on its own 163-bone rig: what scans of people outside the model's span are made from."""
import functools

import numpy as np
from scipy.spatial.transform import Rotation

from .bone_segments import bone_segments
from .characters import Shapes
from .skeleton import JOINTS, joint_heads
from .skin_weights import bone_heat, limited, smoothed
from .subdivide import catmull_clark
from .surface import closed_skin, opened_and_capped
from .template import rig_bone_names

INFLUENCES = 6
# The 22 joints of a truth file: all but the hands.
TRUTH_JOINTS = JOINTS[:22]


def posed(vertices, weights, ends, names, parents, pose):
    """(posed vertices, posed heads [B,3]) by linear blending over all bones."""
    turn, head = np.empty((len(names), 3, 3)), np.empty((len(names), 3))
    for k, name in enumerate(names):
        turn[k] = Rotation.from_rotvec(pose.get(name, np.zeros(3))).as_matrix()
        head[k] = ends[k, 0]
        if parents[k] >= 0:
            p = parents[k]
            turn[k] = turn[p] @ turn[k]
            head[k] = turn[p] @ (ends[k, 0] - ends[p, 0]) + head[p]
    shift = head - np.einsum("bij,bj->bi", turn, ends[:, 0])
    blend = (weights @ turn.reshape(-1, 9)).reshape(-1, 3, 3)
    return np.einsum("vij,vj->vi", blend, vertices) + weights @ shift, head


class RiggedCharacter:
    """Closed skin [V,3] in the package's A-pose (metres, Y up, facing +Z, left = +X), weights [V,bones], bones.

    kept [V]: the skin's indices into the package's; polygons: quads and triangles of the closed skin.
    """

    def __init__(self, package, amounts):
        """amounts: {target: weight}; the joint cubes of all must be admitted."""
        self.names = rig_bone_names(package)
        self.parents = [
            self.names.index(package.bones[n][2]) if package.bones[n][2] in self.names else -1 for n in self.names
        ]
        lists = [[package.joint_vertices[package.bones[name][e]]] for name in self.names for e in (0, 1)]
        self.faces, self.kept = closed_skin(package.skin, package.quads)
        shapes = Shapes(package, [(name, False) for name in amounts], self.kept, lists)
        weights = np.array([list(amounts.values())], np.float32)
        self.skin = shapes.skin(weights).reshape(3, -1).T.astype(float)
        self.ends = shapes.joints(weights)[0].reshape(-1, 2, 3)
        place = np.full(len(package.skin), -1)
        place[self.kept] = np.arange(len(self.kept))
        self.polygons = [place[corners] for corners in opened_and_capped(package.skin, package.quads)]

    @functools.cached_property
    def weights(self):
        """[V,bones]; costly, made when they are first needed."""
        begin, end, owner = bone_segments(self.names, self.ends, self.skin)
        heat = bone_heat(self.skin, self.faces, begin, end, owner, len(self.names))
        return limited(smoothed(heat, self.faces, np.full(len(self.skin), 0.4), 4), INFLUENCES)

    def posed(self, pose):
        """(skin [V,3], heads of the bones [B,3]). pose: {bone: rotation vector in radians, relative to the parent}."""
        return posed(self.skin, self.weights, self.ends, self.names, self.parents, pose)

    def finer(self, vertices):
        """(vertices, triangles) after one subdivision; the first V vertices are the old ones, moved."""
        fine, quads = catmull_clark(vertices, self.polygons)
        return fine, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])

    def joints(self, heads):
        """{joint: position} of the truth's 22 joints."""
        return {
            joint: heads[[self.names.index(b) for b in bones]].mean(0)
            for joint, bones in joint_heads().items()
            if joint in TRUTH_JOINTS
        }

    def finger_curls(self, degrees):
        """{bone: rotation vector in radians} that curl the fingers of both hands towards the palms.

        degrees: {finger number: angles of its bones, root first}.
        """
        out = {}
        for suffix, sign in ((".L", 1.0), (".R", -1.0)):
            wrist = self.ends[self.names.index("wrist" + suffix), 0]
            index, pinky = (self.ends[self.names.index(f"finger{k}-1{suffix}"), 0] for k in "25")
            back = sign * np.cross(index - wrist, pinky - wrist)
            for finger, angles in degrees.items():
                for k, angle in enumerate(angles, 1):
                    bone = f"finger{finger}-{k}{suffix}"
                    head, tail = self.ends[self.names.index(bone)]
                    axis = np.cross(back, tail - head)
                    out[bone] = axis / np.linalg.norm(axis) * np.radians(angle)
        return out
