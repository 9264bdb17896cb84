"""The motion-capture poses, cleaned, and their split into a training and a test side.

Data used in this project was obtained from mocap.cs.cmu.edu. The database was created with funding from NSF EIA-0196217.
"""
import json
import os

import numpy as np

import skeleton

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "../../.."))
SPLIT_FILE = os.path.join(ROOT, "models/pose_split.json")
# All frames at 30 Hz; kept beside the project because of its size. The varied subset in tests/data has the same fields.
FULL_DATA = os.path.join(ROOT, "../shared/data/cmu_poses_full.npz")
SUBSET_DATA = os.path.join(ROOT, "tests/data/cmu_poses.npz")

# One source begins each of its clips with this skeleton's rest pose, which nobody took.
PLACEHOLDER_SOURCE = "chaneyddtt"
# A joint further than this from both neighbouring frames has jumped and come back: a flip of the solver.
FLIP_RADIANS = np.radians(40.0)
NEIGHBOUR_FRAMES = 4  # at 120 Hz


def load(path):
    """Fields of a pose file as a dict, without glitches: flagged, placeholder and single-frame flips."""
    with np.load(path) as data:
        fields = {name: data[name] for name in ("poses", "sequence", "source", "frame", "glitch")}
    keep = ~fields.pop("glitch")
    rotations = skeleton.matrices(fields["poses"])
    placeholder = np.char.startswith(fields["source"], PLACEHOLDER_SOURCE) & (fields["frame"] == 0)
    keep &= ~placeholder
    step = skeleton.angle_between(rotations[:-1, 1:], rotations[1:, 1:])
    linked = (fields["sequence"][:-1] == fields["sequence"][1:]) & (np.diff(fields["frame"]) <= NEIGHBOUR_FRAMES)
    jumped = (step > FLIP_RADIANS) & linked[:, None]
    keep[1:-1] &= ~(jumped[:-1] & jumped[1:]).any(1)
    return {name: values[keep] for name, values in fields.items()}


def split():
    """{"train": set of sequence names, "test": set of sequence names}."""
    with open(SPLIT_FILE, encoding="utf-8") as f:
        content = json.load(f)
    return {side: set(content[side]) for side in ("train", "test")}


def load_side(path, side):
    """The cleaned fields of one side, "train" or "test"."""
    fields = load(path)
    keep = np.isin(fields["sequence"], sorted(split()[side]))
    return {name: values[keep] for name, values in fields.items()}
