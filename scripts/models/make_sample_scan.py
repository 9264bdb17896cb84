#!/usr/bin/env python3
"""Makes the bundled sample scan: a believable body that the default model cannot represent exactly.

usage: make_sample_scan.py --package DIR --out sample.ply [--body body.vbm]

The package's full-resolution skin, subdivided; one man with asymmetries and a face of his own; posed by the package's
163-bone rig with weights and a pose of our own, fingers curled; 1 mm of noise and holes where no camera looks.
Binary PLY in millimetres, Z up, turned by an arbitrary angle, with vertex colours. Beside it <stem>.truth.json holds
the rig's joints. With --body, a body made from another package is refused.
"""
import argparse
import json
import os
import sys

import numpy as np

import array_file
from body import scanner
from body.characters import draw
from body.modifiers import PREFIX, SUFFIX, Modifiers
from body.package import TARBALL_SHA256, NotAdmitted, Package
from body.rigged import RiggedCharacter
from body.subdivide import split_long_edges

SEED = 2
LONGEST_EDGE = 0.0095
NOISE = 0.001
YAW_DEGREES = 205.0
# Where the scanner's origin lies below the feet and beside the person, metres.
OFFSET = np.array([0.12, -0.31, 0.0])

# Targets the model's shape space knows nothing of, and how much of each.
OWN_FEATURES = {
    "expression/units/caucasian/eye-left-closure": 0.9,
    "expression/units/caucasian/eye-right-closure": 0.9,
    "asym/asym-jaw-1-l": 0.5,
    "asym/asym-nose-2-r": 0.4,
    "asym/asym-cheek-1-r": 0.5,
    "asym/asym-brown-1-l": 0.4,
    "asym/asym-ear-1-l": 0.5,
    "nose/nose-hump-morehump": 0.5,
    "mouth/mouth-scale-horiz-incr": 0.4,
    "mouth/mouth-lowerlip-volume-inflate": 0.4,
    "ears/l-ear-wing-out": 0.4,
    "ears/r-ear-wing-out": 0.3,
    "cheek/l-cheek-volume-deflate": 0.4,
    "cheek/r-cheek-volume-deflate": 0.4,
    "forehead/forehead-temple-in": 0.4,
}

# The pose: rotation vectors in degrees, world axes of the package's A-pose, relative to the parent bone.
POSE = {
    "spine03": (2, 2, 1), "spine02": (2, 2, 1), "spine01": (1, 3, -1),
    "neck01": (0, 4, 0), "neck02": (2, 5, 0), "neck03": (2, 5, 1), "head": (2, 4, 1),
    "clavicle.L": (0, 0, -3), "shoulder01.L": (0, 0, -3), "upperarm01.L": (4, 0, -10), "upperarm02.L": (2, 0, -3),
    "lowerarm01.L": (12, 0, 2), "lowerarm02.L": (4, 0, 0), "wrist.L": (6, 0, 4),
    "clavicle.R": (0, 0, 2), "shoulder01.R": (0, 0, 2), "upperarm01.R": (-4, 6, 8), "upperarm02.R": (-3, 4, 2),
    "lowerarm01.R": (-38, 26, 14), "lowerarm02.R": (-6, 6, 0), "wrist.R": (-4, 4, 0),
    "upperleg01.L": (-5, 3, 2), "lowerleg01.L": (6, 0, 0), "foot.L": (-1, 2, -1),
    "upperleg01.R": (1, -6, 3), "lowerleg01.R": (2, 0, 0), "foot.R": (-2, -5, -2),
}  # fmt: skip
FINGER_CURL_DEGREES = {"1": (4, 8, 10), "2": (12, 16, 10), "3": (16, 20, 12), "4": (18, 22, 14), "5": (18, 24, 16)}

SKIN, HAIR, SHORTS = (214, 168, 140), (62, 46, 38), (70, 78, 92)


def identity(package, modifiers, rng):
    """({target: weight}) of one man of the package's default height, whose joint cubes are all admitted."""
    p = draw(modifiers, 1, rng)
    p.update(gender=np.array([0.95]), age=np.array([0.12]), muscle=np.array([0.58]), weight=np.array([0.72]))
    p.update(completed=np.array([1.0]), height=np.array([0.5]), proportions=np.array([0.6]), race=np.array([[0.7, 0.1, 0.2]]))
    p["detail"] *= 0.8
    p["asymmetry"] *= 2
    amounts = {}
    for (name, mirrored), weight in zip(modifiers.sources, modifiers.weights(p)[0]):
        if weight and not mirrored and package.cube_target(name) is not None:
            amounts[name] = float(weight)
    for name, weight in OWN_FEATURES.items():
        amounts[PREFIX + name + SUFFIX] = weight
    return amounts


def colours(rest, rng):
    """Vertex colours [V,3] u8: mottled skin, short hair, shorts, by place in the A-pose (metres, from the sole)."""
    stature = rest[:, 1].max()
    x, y, z = np.abs(rest[:, 0]), rest[:, 1] / stature, rest[:, 2]
    out = np.array(SKIN) * (1 + 0.025 * rng.normal(size=(len(rest), 1)))
    brow = 0.955 - 0.8 * np.maximum(0, 0.05 - z)
    head = (y > 0.86) & (x < 0.11)
    out[head & (y > brow)] = np.array(HAIR)
    out[(y > 0.40) & (y < 0.565) & (x < 0.24) & (y > 0.40 + 0.02 * np.sin(9 * x))] = np.array(SHORTS)
    out *= 1 + 0.02 * rng.normal(size=(len(rest), 1))
    return out.clip(0, 255).astype(np.uint8)


def write_ply(path, vertices, colour, faces):
    """Binary little-endian PLY: float x y z in millimetres, uchar red green blue, int vertex_indices."""
    vertex = np.zeros(len(vertices), [("xyz", "<f4", 3), ("rgb", "u1", 3)])
    vertex["xyz"], vertex["rgb"] = vertices, colour
    face = np.zeros(len(faces), [("n", "u1"), ("v", "<i4", 3)])
    face["n"], face["v"] = 3, faces
    properties = [f"property float {c}" for c in "xyz"] + [f"property uchar {c}" for c in ("red", "green", "blue")]
    header = ["ply", "format binary_little_endian 1.0", "comment unit: mm", f"element vertex {len(vertices)}"]
    header += properties + [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    with open(path + ".part", "wb") as f:
        f.write("\n".join(header).encode() + vertex.tobytes() + face.tobytes())
    os.replace(path + ".part", path)


def make_scan(package):
    """(vertices [V,3] mm, colours [V,3], faces [F,3], {joint: [x,y,z] mm}), scan frame: Z up, turned by YAW_DEGREES."""
    rng = np.random.default_rng(SEED)
    modifiers = Modifiers(package)
    character = RiggedCharacter(package, identity(package, modifiers, rng))
    pose = {bone: np.radians(vector) for bone, vector in POSE.items()} | character.finger_curls(FINGER_CURL_DEGREES)
    moved, heads = character.posed(pose)
    fine, triangles = character.finer(moved)
    rest, _ = character.finer(character.skin)
    both, triangles = split_long_edges(np.concatenate([fine, rest], 1), triangles, LONGEST_EDGE)
    fine, rest = both[:, :3], both[:, 3:]

    visible = scanner.with_holes(triangles, scanner.seen(fine, triangles))
    measured = scanner.noisy(fine, triangles, NOISE, rng)
    colour = colours(rest - [0, rest[:, 1].min(), 0], rng)
    used, triangles = np.unique(visible, return_inverse=True)
    # Body frame (Y up) to scan frame (Z up), the soles at height 0.
    yaw = np.radians(YAW_DEGREES)
    turn = np.array([[np.cos(yaw), 0, np.sin(yaw)], [np.sin(yaw), 0, -np.cos(yaw)], [0, 1, 0]])
    shift = OFFSET - turn @ [0, fine[:, 1].min(), 0]
    joints = {joint: ((turn @ p + shift) * 1e3).round(2).tolist() for joint, p in character.joints(heads).items()}
    return (measured[used] @ turn.T + shift) * 1e3, colour[used], triangles.reshape(-1, 3), joints


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--package", required=True, metavar="DIR")
    parser.add_argument("--out", required=True, metavar="FILE.ply")
    parser.add_argument("--body", metavar="FILE")
    arguments = parser.parse_args()
    try:
        if arguments.body:
            made_from = json.loads(array_file.read(arguments.body, "BODY")["metadata"].tobytes())["package_sha256"]
            if made_from != TARBALL_SHA256:
                raise NotAdmitted(f"{arguments.body}: made from another package; make the body anew")
        vertices, colour, faces, joints = make_scan(Package(arguments.package))
    except (array_file.ArrayFileError, NotAdmitted, OSError) as problem:
        sys.exit(f"make_sample_scan: {problem}")
    write_ply(arguments.out, vertices, colour, faces)
    with open(os.path.splitext(arguments.out)[0] + ".truth.json", "w") as f:
        json.dump({"frame": "scan", "unit": "mm", "joints": joints}, f, indent=1)
    print(f"{arguments.out}: {len(vertices)} vertices, {len(faces)} faces", file=sys.stderr)


if __name__ == "__main__":
    main()
