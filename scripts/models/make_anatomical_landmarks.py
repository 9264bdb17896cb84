#!/usr/bin/env python3
"""Places the anatomical landmarks on the default body and writes them as a C++ table.

usage: make_anatomical_landmarks.py --body body.vbm --out core/anthropometry/landmark_table.cpp

Every landmark is where a ray from outside first meets the rest pose (metres; x to the body's left, y up, z forward;
T-pose, palms down). The rays were set by eye on drawings of the body, their heights checked against the mean
proportions of women and men together (cervicale 0.86 of the stature, suprasternale 0.82, iliocristale 0.60,
trochanterion 0.52, crotch 0.47). The body is symmetric: right landmarks are the left ones mirrored.
Needs Debian's python3-numpy.
"""
import argparse

import array_file
import numpy as np

# name: (seen from, first coordinate, second coordinate)
#   front, back: x, y;  left (from the body's left), inside (from the midline to the left): z, y;  above, below: x, z
MIDDLE = {
    "top_of_head": ("above", 0, 0.075),
    "glabella": ("front", 0, 0.628),
    "sellion": ("front", 0, 0.608),
    "supramenton": ("front", 0, 0.531),
    "menton": ("front", 0, 0.508),
    "opisthocranion": ("back", 0, 0.648),
    "nuchale": ("back", 0, 0.582),
    "cervicale": ("back", 0, 0.474),
    "suprasternale": ("front", 0, 0.425),
    "substernale": ("front", 0, 0.230),
    "omphalion": ("front", 0, 0.040),
    "waist_preferred_posterior": ("back", 0, 0.085),
    "crotch": ("below", 0, 0.010),
}
LEFT = {
    "infraorbitale": ("front", 0.032, 0.597),
    "euryon": ("left", 0.060, 0.650),
    "tragion": ("left", 0.092, 0.592),
    "gonion": ("left", 0.097, 0.535),
    "neck_shoulder_point": ("above", 0.072, 0.015),
    "clavicale": ("front", 0.022, 0.432),
    "acromion": ("above", 0.170, 0.030),
    "axilla_anterior": ("front", 0.195, 0.350),
    "axilla_posterior": ("back", 0.200, 0.350),
    "thelion": ("front", 0.105, 0.246),
    "inframammary": ("front", 0.105, 0.208),
    "10th_rib": ("left", 0.040, 0.115),
    "iliocristale": ("left", 0.030, 0.055),
    "asis": ("front", 0.115, -0.030),
    "psis": ("back", 0.045, 0.005),
    "trochanterion": ("left", 0.020, -0.085),
    "lateral_humeral_epicondyle": ("above", 0.420, 0.030),
    "medial_humeral_epicondyle": ("below", 0.420, 0.030),
    "olecranon": ("back", 0.430, 0.420),
    "radiale": ("above", 0.440, 0.035),
    "radial_styloid": ("front", 0.672, 0.415),
    "ulnar_styloid": ("back", 0.668, 0.420),
    "metacarpal_phalangeal_ii": ("front", 0.765, 0.425),
    "metacarpal_phalangeal_v": ("back", 0.757, 0.418),
    "dactylion": ("far", 0, 0),
    "mid_patella": ("front", 0.149, -0.490),
    "knee_crease": ("back", 0.145, -0.485),
    "lateral_femoral_epicondyle": ("left", 0.050, -0.480),
    "medial_femoral_epicondyle": ("inside", 0.050, -0.480),
    "tibiale": ("inside", 0.055, -0.520),
    "lateral_malleolus": ("left", 0.030, -0.893),
    "medial_malleolus": ("inside", 0.042, -0.884),
    "sphyrion": ("inside", 0.042, -0.897),
    "calcaneus_posterior": ("back", 0.188, -0.945),
    "metatarsal_phalangeal_i": ("inside", 0.165, -0.945),
    "metatarsal_phalangeal_v": ("left", 0.140, -0.950),
    "digit_ii": ("front", 0.186, -0.947),
}
FAR = 2.0


def ray_of(seen_from, a, b):
    """Origin and direction of a ray."""
    return {
        "front": ((a, b, FAR), (0, 0, -1)),
        "back": ((a, b, -FAR), (0, 0, 1)),
        "left": ((FAR, b, a), (-1, 0, 0)),
        "inside": ((0, b, a), (1, 0, 0)),
        "above": ((a, FAR, b), (0, -1, 0)),
        "below": ((a, -FAR, b), (0, 1, 0)),
    }[seen_from]


def first_hit(v, faces, origin, direction):
    """Where a ray first meets the mesh (Moeller and Trumbore)."""
    origin, direction = np.array(origin, float), np.array(direction, float)
    # A ray exactly along an edge of the symmetric mesh may slip through.
    origin = origin + np.array([1e-6, 2e-6, 3e-6])
    a, e1, e2 = v[faces[:, 0]], v[faces[:, 1]] - v[faces[:, 0]], v[faces[:, 2]] - v[faces[:, 0]]
    p = np.cross(direction, e2)
    det = (e1 * p).sum(1)
    with np.errstate(divide="ignore", invalid="ignore"):
        s = origin - a
        u = (s * p).sum(1) / det
        q = np.cross(s, e1)
        w = (q * direction).sum(1) / det
        t = (e2 * q).sum(1) / det
    hit = (np.abs(det) > 1e-14) & (u >= 0) & (w >= 0) & (u + w <= 1) & (t > 0)
    if not hit.any():
        raise ValueError("a ray misses the body")
    return origin + direction * t[hit].min()


def place(v, faces):
    """Name -> position; sides as left_ and right_."""
    landmarks = {name: first_hit(v, faces, *ray_of(*ray)) * [0, 1, 1] for name, ray in MIDDLE.items()}
    for name, ray in LEFT.items():
        point = v[np.argmax(v[:, 0])] if ray[0] == "far" else first_hit(v, faces, *ray_of(*ray))
        landmarks["left_" + name] = point
        landmarks["right_" + name] = point * [-1, 1, 1]
    return landmarks


def cpp_vector(p):
    return "{" + ", ".join(f"{c + 0.0:.5f}" for c in p) + "}"


def cpp_table(landmarks, joints):
    rows = "".join(f'    {{"{name}", {cpp_vector(p)}}},\n' for name, p in landmarks.items())
    joint_rows = "".join(f"    {cpp_vector(p)},\n" for p in joints)
    return f"""// Made by scripts/models/make_anatomical_landmarks.py; do not edit.
#include "anthropometry/landmark_table.h"

namespace vitruvian {{

// clang-format off
const std::array<LandmarkPlace, {len(landmarks)}> kLandmarkTable = {{{{
{rows}}}}};

const std::array<std::array<double, 3>, 24> kLandmarkJoints = {{{{
{joint_rows}}}}};
// clang-format on

}}  // namespace vitruvian
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--body", required=True)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    raw = array_file.read(arguments.body, "BODY")
    v, faces = array_file.real(raw, "v_template"), raw["faces"].astype(int)
    joints = np.zeros((24, 3))
    np.add.at(joints, raw["regressor_joint"], raw["regressor_weight"][:, None] * v[raw["regressor_vertex"]])
    with open(arguments.out, "w", encoding="utf-8") as file:
        file.write(cpp_table(place(v, faces), joints))


if __name__ == "__main__":
    main()
