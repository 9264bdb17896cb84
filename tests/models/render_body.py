#!/usr/bin/env python3
"""Draws the made body to look at: the mean and a draw of each sex in the test poses, one row a shape.

usage: render_body.py --body body.vbm --out sheet.png [--seed N]
Needs Debian's python3-numpy, python3-scipy and python3-pil.
"""
import argparse
import os
import sys

import numpy as np
from PIL import Image

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))

from benchmarks import pictures  # noqa: E402  (found through the path above)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--body", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    os.environ["VITRUVIAN_MODELS"] = os.path.dirname(os.path.abspath(arguments.body))
    from support import made_body
    from body import correctives, posing

    body, rng = made_body(), np.random.default_rng(arguments.seed)
    shapes = [body.v]
    for gender in (1, 2):
        root = np.linalg.cholesky(np.linalg.inv(body.raw["prior_precision"][gender].astype(float)))
        beta = body.raw["prior_mean"][gender] + root @ rng.normal(size=len(root))
        shapes.append(body.v + np.tensordot(beta, body.shapedirs, 1))
    rows = []
    for shape in shapes:
        row = []
        for turns in posing.POSES.values():
            transforms = posing.skinning_transforms(body.regressor @ shape, turns)
            rest = correctives.corrected(shape, turns, *body.correctives)
            posed = posing.linear_blend(rest, body.weights, transforms)
            row.append(pictures.view(posed, body.faces, pictures.camera(yaw_degrees=30, pitch_degrees=8)))
        rows.append(np.concatenate(row, 1))
    Image.fromarray(np.concatenate(rows)).save(arguments.out)


if __name__ == "__main__":
    main()
