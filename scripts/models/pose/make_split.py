#!/usr/bin/env python3
"""Splits the motion-capture trials once and for all: writes models/pose_split.json.

Some trials are stored under two names (read through different files and rigs). They are found by comparing poses and
always land on the same side. Every fifth trial goes to the test side, in an order that spreads it over the kinds of
motion and depends on nothing but the names.
"""
import argparse
import hashlib
import json
import re

import numpy as np
from scipy.spatial import cKDTree

import cmu
import skeleton

# Two trials are one when their frames match in order: nearest poses this close (m, root mean square over joints, median
# over frames) and the matched frame numbers are in step. Copies read through different rigs lie at 5-30 mm and above
# 0.93; the few pairs of like steps by one person that pass as well do no harm on one side.
SAME_DISTANCE_M = 0.035
SAME_CORRELATION = 0.85
COMPARED_FRAMES = 40
HOW = ("By trial; names that hold the same trial (found by comparing poses: frames match within 35 mm and in step) are "
       "kept together. Trials are sorted by kind of motion (name without its number, or subject), then by the SHA-256 "
       "of their first name; every fifth, from the third, is test. The same person may be on both sides.")


def nearest(frames, tree):
    picked = frames[:: max(1, len(frames) // COMPARED_FRAMES)]
    distance, index = tree.query(picked)
    in_step = np.corrcoef(np.arange(len(index)), index)[0, 1] if len(set(index)) > 2 else 0.0
    return np.median(distance), in_step


def same_trials(sequences):
    """Groups of names that hold one trial. sequences: {name: (N, 66) features, metres}."""
    trees = {name: cKDTree(frames) for name, frames in sequences.items()}
    group = {name: {name} for name in sequences}
    names = sorted(sequences)
    for k, a in enumerate(names):
        for b in names[k + 1 :]:
            both = [nearest(sequences[a], trees[b]), nearest(sequences[b], trees[a])]
            if all(d < SAME_DISTANCE_M and c > SAME_CORRELATION for d, c in both):
                union = group[a] | group[b]
                for name in union:
                    group[name] = union
    return sorted({tuple(sorted(names)) for names in group.values()})


def kind(name):
    numbered = re.fullmatch(r"(\d\d)_\d\d", name)
    return numbered.group(1) if numbered else re.sub(r"^(train|test)_|[-_]\d+$", "", name)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", default=cmu.FULL_DATA)
    parser.add_argument("--out", default=cmu.SPLIT_FILE)
    arguments = parser.parse_args()

    with np.load(arguments.data) as data:
        all_names = sorted(set(data["sequence"].tolist()))
    fields = cmu.load(arguments.data)
    features = skeleton.body_joints(fields["poses"])[:, :22].reshape(-1, 66) / np.sqrt(22)
    sequences = {name: features[fields["sequence"] == name] for name in all_names}
    sequences = {name: frames for name, frames in sequences.items() if len(frames) > 3}
    groups = same_trials(sequences)
    groups.sort(key=lambda names: (kind(names[0]), hashlib.sha256(names[0].encode()).hexdigest()))
    test = sorted(name for names in groups[2::5] for name in names)
    train = sorted(set(all_names) - set(test))
    content = {"how": HOW, "same": [list(names) for names in groups if len(names) > 1], "train": train, "test": test}
    with open(arguments.out, "w", encoding="utf-8") as f:
        json.dump(content, f, indent=1)
        f.write("\n")
    frames = np.isin(fields["sequence"], test)
    print(f"{len(groups)} trials, {len(groups[2::5])} test; names {len(train)} train, {len(test)} test; "
          f"frames {len(frames) - frames.sum()} train, {frames.sum()} test of {len(frames)} clean ones")
    for names in content["same"]:
        print("same:", *names)
    print("test:", *test)


if __name__ == "__main__":
    main()
