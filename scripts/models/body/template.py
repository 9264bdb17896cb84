"""The reference character: closed skin, skinning weights, T-pose and the simplified mesh of the model."""
from dataclasses import dataclass

import numpy as np

from .bone_segments import bone_segments
from .characters import Shapes
from .decimate import simplified
from .posing import POSES, linear_blend, skinning_transforms
from .skeleton import INDEX, MIRROR, is_body_bone, joint_heads, joint_of_bone
from .skin_weights import bone_heat, limited, smoothed, symmetric
from .surface import closed_skin, mirror_partners, vertex_areas
from .unpose import t_pose_centres, to_t_pose, turns_to_t_pose

SMOOTHING_PASSES, SMOOTHING = 8, 0.5
DECIMATION_POSES = ("a_pose", "squat", "arms_up")
# Parts whose weights stay as they are: smoothing would bleed between fingers, toes and face.
_UNSMOOTHED = "head left_wrist right_wrist left_hand right_hand left_ankle right_ankle left_foot right_foot".split()


@dataclass
class Template:
    """Simplified mesh: `skin` indices [V] into the package's skin, faces [F,3], mirror [V], weights [V,24]."""

    skin: np.ndarray
    faces: np.ndarray
    mirror: np.ndarray
    weights: np.ndarray


def reference_parameters(details):
    """An average adult, somewhat heavier than the package's default and of its default height."""
    values = {"gender": 0.5, "age": 0.2, "muscle": 0.5, "weight": 0.85, "height": 0.5, "proportions": 0.5, "cup": 0.5}
    p = {name: np.array([value]) for name, value in values.items()}
    return p | {
        "firmness": np.array([0.5]),
        "completed": np.array([1.0]),
        "race": np.full((1, 3), 1 / 3),
        "detail": np.zeros((1, details)),
        "asymmetry": np.zeros((1, details)),
    }


def joint_lists(package):
    """For each of joint_heads(): the package vertices of its rig joints."""
    return [[package.joint_vertices[package.bones[bone][0]] for bone in bones] for bones in joint_heads().values()]


def rig_bone_names(package):
    return [name for name in package.bones if is_body_bone(name)]


def rig_weights(package, names, ends, vertices, faces, vertex_mirror):
    """Weights [V,len(names)] of every rig bone over a closed skin in the package's A-pose, symmetric."""
    begin, end, owner = bone_segments(names, ends, vertices)
    weights = bone_heat(vertices, faces, begin, end, owner, len(names))
    other = {".L": ".R", ".R": ".L"}
    partner = np.array([names.index(n[:-2] + other[n[-2:]] if n[-2:] in other else n) for n in names])
    return symmetric(weights, vertex_mirror, partner)


def joint_weights(package, names, ends, vertices, faces, vertex_mirror):
    """Weights [V,24], at most four a row, symmetric."""
    by_bone = rig_weights(package, names, ends, vertices, faces, vertex_mirror)
    weights = np.zeros((len(vertices), 24))
    for column, name in zip(by_bone.T, names):
        weights[:, joint_of_bone(name)] += column
    keep = weights[:, [INDEX[j] for j in _UNSMOOTHED]].sum(1).clip(0, 1)
    weights = limited(smoothed(weights, faces, SMOOTHING * (1 - keep), SMOOTHING_PASSES))
    # The mean of a row and its image can have more than four weights; limiting it again keeps the symmetry.
    return limited(symmetric(weights, vertex_mirror, MIRROR))


def make_template(package, modifiers, target):
    """The model's mesh with at most `target` vertices."""
    faces, kept = closed_skin(package.skin, package.quads)
    mirror = mirror_partners(package.skin[kept])
    names = rig_bone_names(package)
    bone_lists = [[package.joint_vertices[package.bones[name][e]]] for name in names for e in (0, 1)]
    used_weights = modifiers.weights(reference_parameters(len(modifiers.detail_names)))
    used = np.nonzero(used_weights[0])[0]
    shapes = Shapes(package, [modifiers.sources[k] for k in used], kept, joint_lists(package) + bone_lists)
    vertices = shapes.skin(used_weights[:, used]).reshape(3, -1).T.astype(float)
    vertices = 0.5 * (vertices + vertices[mirror] * [-1, 1, 1])
    joints = shapes.joints(used_weights[:, used])
    heads = list(joint_heads())
    weights = joint_weights(package, names, joints[0, len(heads) :].reshape(-1, 2, 3), vertices, faces, mirror)

    turns = turns_to_t_pose({name: joints[:, k] for k, name in enumerate(heads)})
    centres_t = t_pose_centres(joints[:, :24], turns)
    rest = to_t_pose(vertices[None], weights, joints[:, :24], turns, centres_t)[0].astype(float)
    rest = 0.5 * (rest + rest[mirror] * [-1, 1, 1])
    poses = [rest]
    for name in DECIMATION_POSES:
        posed = linear_blend(rest, weights, skinning_transforms(centres_t[0], POSES[name]))
        poses.append(0.5 * (posed + posed[mirror] * [-1, 1, 1]))
    lite_faces, lite = simplified(rest, poses, faces, vertex_areas(rest, faces), mirror, target)
    # Neighbours in space get neighbouring indices: better compression and cache use.
    order = np.lexsort(np.round(rest[lite] / 0.04).astype(int).T)
    place = np.empty(len(lite), int)
    place[order] = np.arange(len(lite))
    lite = lite[order]
    lite_mirror = np.searchsorted(np.sort(lite), mirror[lite])
    lite_mirror = np.argsort(lite)[lite_mirror]
    lite_faces = place[lite_faces]
    return Template(kept[lite], lite_faces[np.lexsort(lite_faces.T[::-1])], lite_mirror, weights[lite])
