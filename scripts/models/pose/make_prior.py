#!/usr/bin/env python3
"""Makes models/pose_prior.vpp from the training side of the split: Gaussian, joint limits, limb libraries and, once
train_vae.py has been run, the variational autoencoder.

    make_prior.py --vae build/pose/vae.pt
"""
import argparse
import json
import os
import sys

import numpy as np

import cmu
import skeleton
import synthetic
from skeleton import INDEX

sys.path.insert(0, os.path.join(cmu.HERE, ".."))
import array_file

SEED = 1
SYNTHETIC_COUNT = 20_000
# Share of our own poses in the Gaussian; the rest are measured ones.
SYNTHETIC_WEIGHT = 0.2
# Standard deviations (rad) added to the measured ones: the data are narrower than people, most where a joint was not
# measured at all.
ADDED_SD = {"default": 0.10, "collar": 0.25, "wrist": 0.25, "ankle": 0.15, "spine": 0.12}
LIMIT_PERCENTILES = (0.2, 99.8)
LIMIT_MARGIN = 0.15
# Ranges (rad) that a limit box holds at least, +- in each number, where the data keep a joint still that people move.
LEAST_RANGE = {"hand": (0.6, 0.6, 0.6), "wrist": (0.8, 0.6, 0.8), "knee": (0.0, 0.35, 0.2), "elbow": (0.6, 0.0, 0.3),
               "collar": (0.3, 0.4, 0.5)}
LIMB_COUNTS = {"arm": 250, "leg": 200}
LIMB_SEGMENTS_M = {"arm": ((0.25, 0, 0), (0.24, 0, 0)), "leg": ((0, -0.40, 0), (0, -0.42, 0))}


def part_of(name):
    """"knee" of "left_knee", "spine" of "spine2"."""
    return name.split("_")[-1].rstrip("123")


def training_poses(data):
    """Measured and made poses, (N, 24, 3) each: shoulder girdle moving, mirror images included, root zero."""
    measured = cmu.load_side(data, "train")["poses"].astype(np.float64)
    rotations = skeleton.matrices(measured)
    rotations[:, 0] = np.eye(3)
    measured = skeleton.vectors(synthetic.with_shoulder_girdle(rotations, np.random.default_rng(SEED)))
    made, _ = synthetic.poses(SYNTHETIC_COUNT, SEED)
    return tuple(np.concatenate([p, skeleton.mirrored(p)]) for p in (measured, made))


def gaussian(measured, made):
    weight = np.concatenate([np.full(len(measured), (1 - SYNTHETIC_WEIGHT) / len(measured)),
                             np.full(len(made), SYNTHETIC_WEIGHT / len(made))])
    x = np.concatenate([measured, made])[:, 1:].reshape(-1, 69)
    mean = weight @ x
    covariance = (x - mean).T @ (weight[:, None] * (x - mean))
    added = [ADDED_SD.get(part_of(name), ADDED_SD["default"]) for name in skeleton.NAMES[1:]]
    return mean, np.linalg.inv(covariance + np.diag(np.repeat(np.square(added), 3)))


def limits(measured, made):
    boxes = [np.percentile(p[:, 1:], LIMIT_PERCENTILES, axis=0) for p in (measured, made)]
    low = np.minimum(boxes[0][0], boxes[1][0]) - LIMIT_MARGIN
    high = np.maximum(boxes[0][1], boxes[1][1]) + LIMIT_MARGIN
    for k, name in enumerate(skeleton.NAMES[1:]):
        least = np.array(LEAST_RANGE.get(part_of(name), (0, 0, 0)))
        low[k], high[k] = np.minimum(low[k], -least), np.maximum(high[k], least)
    return low.ravel(), high.ravel()


def limb_features(pair, segments):
    """What k-means compares, metres: elbow or knee, wrist or ankle, and the turn of both bones."""
    first = pair[:, 0] @ segments[0]
    both = pair[:, 0] @ pair[:, 1]
    return np.concatenate([1.5 * first, first + both @ segments[1], 0.15 * pair[:, 0, :, 2], 0.10 * both[:, :, 2]], 1)


def mean_rotations(rotations):
    """The rotation nearest to the mean of (N, 2, 3, 3), for each of the two."""
    u, _, vt = np.linalg.svd(rotations.mean(0))
    flip = np.linalg.det(u @ vt)
    u[:, :, 2] *= flip[:, None]
    return u @ vt


def limb_library(pairs, segments, count):
    """(count, 2, 3) axis-angle: k-means of rotation pairs (N, 2, 3, 3), started from farthest points."""
    features = limb_features(pairs, np.asarray(segments, float))
    chosen, distance = [0], np.linalg.norm(features - features[0], axis=1)
    for _ in range(count - 1):
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(features - features[chosen[-1]], axis=1))
    centres = features[chosen]
    for _ in range(6):
        squared = (features**2).sum(1)[:, None] - 2 * features @ centres.T + (centres**2).sum(1)
        label = squared.argmin(1)
        centres = np.stack([features[label == k].mean(0) if (label == k).any() else centres[k] for k in range(count)])
    return skeleton.vectors(np.stack([mean_rotations(pairs[label == k]) for k in range(count) if (label == k).any()]))


def limb_libraries(measured, made):
    """Libraries of the four limbs. Arms are those of a collar at rest: its share is in the shoulder's rotation."""
    rotations = skeleton.matrices(np.concatenate([measured[::4], made[::2]]))
    arms = np.stack([rotations[:, INDEX["left_collar"]] @ rotations[:, INDEX["left_shoulder"]],
                     rotations[:, INDEX["left_elbow"]]], 1)
    legs = rotations[:, [INDEX["left_hip"], INDEX["left_knee"]]]
    libraries = {}
    for limb, pairs in (("arm", arms), ("leg", legs)):
        left = limb_library(pairs, LIMB_SEGMENTS_M[limb], LIMB_COUNTS[limb])
        libraries[f"limb_left_{limb}"] = left
        libraries[f"limb_right_{limb}"] = left * np.array([1.0, -1.0, -1.0])
    return libraries


def report(arrays, data):
    """What the prior thinks of the test side."""
    test = cmu.load_side(data, "test")["poses"].astype(np.float64)
    x = test[:, 1:].reshape(-1, 69)
    d = x - arrays["gaussian_mean"]
    mahalanobis = np.einsum("ni,ij,nj->n", d, arrays["gaussian_precision"], d) / 69
    excess = np.maximum(arrays["limit_low"] - x, 0) + np.maximum(x - arrays["limit_high"], 0)
    rotations = skeleton.matrices(test[::5])
    figures = {"test_mahalanobis_per_dimension": {"median": float(np.median(mahalanobis)),
                                                  "p99": float(np.percentile(mahalanobis, 99))},
               "test_poses_outside_limits_share": float((excess > 0).any(1).mean())}
    for limb, (first, second) in (("left_arm", ("left_shoulder", "left_elbow")), ("left_leg", ("left_hip", "left_knee"))):
        segments = np.asarray(LIMB_SEGMENTS_M[limb[5:]], float)
        ends = []
        for pair in (rotations[:, [INDEX[first], INDEX[second]]], skeleton.matrices(arrays[f"limb_{limb}"])):
            elbow = pair[:, 0] @ segments[0]
            ends.append(np.concatenate([elbow, elbow + pair[:, 0] @ pair[:, 1] @ segments[1]], 1))
        nearest = np.sqrt(((ends[0][:, None] - ends[1][None]) ** 2).sum(-1).min(1) / 2)
        figures[f"test_{limb}_to_library_mm"] = {"median": float(np.median(nearest) * 1000),
                                                 "p99": float(np.percentile(nearest, 99) * 1000)}
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", default=cmu.FULL_DATA)
    parser.add_argument("--vae", help="checkpoint of train_vae.py")
    parser.add_argument("--out", default=os.path.join(cmu.ROOT, "models/pose_prior.vpp"))
    arguments = parser.parse_args()

    measured, made = training_poses(arguments.data)
    arrays = {}
    arrays["gaussian_mean"], arrays["gaussian_precision"] = gaussian(measured, made)
    arrays["limit_low"], arrays["limit_high"] = limits(measured, made)
    arrays.update(limb_libraries(measured, made))
    arrays = {name: values.astype(np.float32) for name, values in arrays.items()}
    metadata = {"split": "models/pose_split.json",
                "data": "CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu, funding NSF EIA-0196217), training "
                        "side of models/pose_split.json, and synthetic poses of scripts/models/pose/synthetic.py",
                "frames": {"measured": len(measured) // 2, "made": len(made) // 2},
                "figures": report(arrays, arguments.data)}
    if arguments.vae:
        import vae
        weights, metadata["vae"] = vae.exported(arguments.vae)
        arrays.update(weights)
    arrays["metadata"] = json.dumps(metadata, sort_keys=True)
    size = array_file.write(arguments.out, "POSE", arrays)
    print(json.dumps(metadata, indent=1, sort_keys=True))
    print(f"{arguments.out}: {size} bytes")


if __name__ == "__main__":
    main()
