"""Suite degraded: scans of the other suites, each spoilt in one way."""
import json

import numpy as np
from scipy.spatial.transform import Rotation

from . import meshes, own_body, strangers
from .cases import Case, generator, spread
from .measures import MM
from .other import avatars_if_present

SEED = 41
SCANS_A_KIND = 50
# Of the 50: how many bodies of the model, clothed avatars (if there are any), strangers; the first take the rest.
AVATARS, STRANGERS = 10, 6
KINDS = ("rotation", "unit", "noise 5 mm", "holes 15 %", "2000 vertices", "no faces", "floor", "no forearm", "no foot", "no head",
         "front only")
# Joints of a limb from where it is cut, and the core joints that are hidden then.
CUTS = {"no forearm": ("elbow", "wrist"), "no foot": ("ankle", "foot")}


def bones(joints):
    """{name: (begin, end)} of the bones that parts are told by; ends of hands, feet and head are prolonged."""
    found = {}
    for side in ("left", "right"):
        at = {name: joints[f"{side}_{name}"] for name in ("hip", "knee", "ankle", "foot", "shoulder", "elbow", "wrist")}
        found[f"{side}_thigh"] = at["hip"], at["knee"]
        found[f"{side}_shank"] = at["knee"], at["ankle"]
        found[f"{side}_foot"] = at["ankle"], at["foot"] + 0.6 * (at["foot"] - at["ankle"])
        found[f"{side}_upper_arm"] = at["shoulder"], at["elbow"]
        found[f"{side}_forearm"] = at["elbow"], at["wrist"] + 0.7 * (at["wrist"] - at["elbow"])
    up = joints["head"] - joints["neck"]
    found["trunk"] = joints["pelvis"], joints["neck"]
    found["head"] = joints["head"], joints["head"] + 0.15 * up / np.linalg.norm(up) * np.linalg.norm(joints["neck"] - joints["pelvis"]) / 0.5
    return found


def nearest_bone(points, joints):
    """Name of the nearest bone for each point."""
    found = bones(joints)
    distance = []
    for begin, end in found.values():
        along = end - begin
        t = np.clip((points - begin) @ along / max(along @ along, 1e-12), 0, 1)
        distance.append(np.linalg.norm(points - begin - t[:, None] * along, axis=1))
    return np.array(list(found))[np.argmin(distance, 0)]


def floor_under(vertices, up, random, unit):
    """A flat floor of some 2 by 2 metres under the lowest point, with 1 mm of noise."""
    half, step = random.uniform(0.7, 1.2) / unit, 0.02 / unit
    axis = np.arange(-half, half, step)
    x, z = (g.ravel() for g in np.meshgrid(axis, axis))
    helper = np.eye(3)[np.abs(up).argmin()]
    right = np.cross(helper, up)
    right /= np.linalg.norm(right)
    centre = vertices.mean(0) + random.uniform(-0.2, 0.2) / unit * right
    height = (vertices @ up).min() - centre @ up
    points = centre + x[:, None] * right + z[:, None] * np.cross(up, right) + (height + random.normal(0, 0.001 / unit, len(x)))[:, None] * up
    n = len(axis)
    cell = np.arange(n * n).reshape(n, n)
    a, b, c, d = cell[:-1, :-1].ravel(), cell[:-1, 1:].ravel(), cell[1:, :-1].ravel(), cell[1:, 1:].ravel()
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([b, d, c], 1)]).astype(np.int32)


def up_of(joints):
    """Up of the scan's room: the file axis nearest to the way from the ankles to the pelvis."""
    trunk = joints["pelvis"] - (joints["left_ankle"] + joints["right_ankle"]) / 2
    axis = np.zeros(3)
    axis[np.abs(trunk).argmax()] = np.sign(trunk[np.abs(trunk).argmax()])
    return axis


def spoilt(kind, side, vertices, faces, truth, random):
    """(vertices, faces, rotation, unit) of the degraded scan."""
    unit = MM[truth["unit"]] / 1e3  # metres per file unit
    joints = {n: np.array(p) for n, p in truth["joints"].items()}
    rotation, new_unit = np.eye(3), truth["unit"]
    if kind == "rotation":
        rotation = Rotation.random(random_state=random.integers(2**31)).as_matrix()
    elif kind == "unit":
        new_unit = random.choice(list(MM))
    elif kind == "noise 5 mm":
        vertices = vertices + random.normal(0, 0.005 / unit, vertices.shape)
    elif kind == "holes 15 %":
        vertices, faces = meshes.with_patches_cut(vertices, faces, 0.15, 0.06 / unit, random)
    elif kind == "2000 vertices":
        vertices, faces = meshes.coarsened(vertices, faces, 2000)
    elif kind == "no faces":
        faces = meshes.NO_FACES
    elif kind == "floor":
        points, squares = floor_under(vertices, up_of(joints), random, unit)
        faces = np.concatenate([faces, squares + len(vertices)])
        vertices = np.concatenate([vertices, points])
    elif kind in CUTS or kind == "no head":
        part = {"no forearm": f"{side}_forearm", "no foot": f"{side}_foot", "no head": "head"}[kind]
        vertices, faces = meshes.restricted(vertices, faces, nearest_bone(vertices, joints) != part)
    elif kind == "front only":
        across = joints["left_hip"] - joints["right_hip"] + joints["left_shoulder"] - joints["right_shoulder"]
        toward = np.cross(across, joints["neck"] - joints["pelvis"])
        vertices, faces = meshes.restricted(vertices, faces, meshes.seen_from(vertices, faces, toward, 0.012 / unit))
    return vertices, faces, rotation, new_unit


def degraded(options):
    avatars = avatars_if_present(options)
    bodies, people = own_body.poses(options), strangers.scanner_suite(options)[:2 * STRANGERS]
    cases = []
    for number, kind in enumerate(KINDS):
        some_avatars = spread(avatars[number % 4:], AVATARS)
        count = SCANS_A_KIND - len(some_avatars) - STRANGERS
        first = number * count
        sources = [bodies[(first + k) % len(bodies)] for k in range(count)] + some_avatars + people[number % 2::2]
        cases.append([_case(kind, number, k, source, options) for k, source in enumerate(sources)])
    # One of each kind in turn, so that a limited run has all.
    return [case for row in zip(*cases) for case in row]


def _case(kind, number, k, source, options):
    random = generator(SEED, number, k)
    side = random.choice(["left", "right"])
    name = f"{kind.replace(' ', '_').replace('%', 'percent')}_{source.name}"
    hidden = ()
    if kind in CUTS:
        hidden = tuple(f"{side}_{joint}" for joint in CUTS[kind][1:])

    def make(folder):
        scan, truth_file, _ = source.files(options.out / "sources")
        truth = json.loads(truth_file.read_text())
        vertices, faces, rotation, unit = spoilt(kind, side, *meshes.read_ply(scan), truth, random)
        own_body.write_turned(folder, name, vertices, faces, truth, rotation, unit)

    return Case(name, make, kind, hidden=hidden + source.hidden)
