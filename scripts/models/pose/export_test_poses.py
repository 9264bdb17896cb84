#!/usr/bin/env python3
"""Writes tests/data/test_poses.csv: 200 poses of the test side, as different as there are, 72 numbers a row (24 joints,
axis-angle, root first)."""
import argparse
import os

import numpy as np

import cmu
import skeleton

COUNT = 200


def farthest_points(features, count):
    """Indices: the one nearest the mean, then always the one farthest from all before."""
    chosen = [int(np.linalg.norm(features - features.mean(0), axis=1).argmin())]
    distance = np.linalg.norm(features - features[chosen[0]], axis=1)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(features - features[chosen[-1]], axis=1))
    return chosen


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", default=os.path.join(cmu.ROOT, "tests/data/test_poses.csv"))
    arguments = parser.parse_args()
    poses = cmu.load_side(cmu.SUBSET_DATA, "test")["poses"]
    features = skeleton.body_joints(poses).reshape(len(poses), -1)
    picked = poses[farthest_points(features, COUNT)].reshape(COUNT, 72)
    np.savetxt(arguments.out, np.round(picked, 5) + 0.0, fmt="%.5f", delimiter=",")
    print(f"{len(poses)} test poses, {COUNT} written to {arguments.out}")


if __name__ == "__main__":
    main()
