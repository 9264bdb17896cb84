#!/usr/bin/env python3
"""Draws the made body to look at: the mean and a draw of each sex in the test poses, one row a shape.

usage: render_body.py --body body.vbm --out sheet.png [--seed N]
Needs Debian's python3-numpy, python3-scipy and python3-pil.
"""
import argparse
import os

import numpy as np
from PIL import Image, ImageDraw

SIZE, OVERSAMPLING = 320, 2
SKIN = np.array([215, 185, 160])
LIGHTS = ((0.7, (0.4, 0.5, 0.8)), (0.25, (-0.8, 0.1, 0.4)))


def view(vertices, faces, yaw_degrees=30, pitch_degrees=8):
    """A picture [SIZE,SIZE,3] of a mesh, back to front; parallel projection, filling the picture."""
    yaw, pitch = np.radians([yaw_degrees, pitch_degrees])
    turn = np.array([[np.cos(yaw), 0, -np.sin(yaw)], [0, 1, 0], [np.sin(yaw), 0, np.cos(yaw)]])
    tilt = np.array([[1, 0, 0], [0, np.cos(pitch), -np.sin(pitch)], [0, np.sin(pitch), np.cos(pitch)]])
    seen = (vertices - (vertices.min(0) + vertices.max(0)) / 2) @ (tilt @ turn).T
    corners = seen[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-20)
    light = np.full(len(faces), 0.15)
    for strength, toward in LIGHTS:
        light += strength * np.maximum(0, normal @ toward / np.linalg.norm(toward))
    width = SIZE * OVERSAMPLING
    pixel = width / 2 + seen[:, :2] * [1, -1] * 0.94 * width / np.ptp(seen[:, :2], axis=0).max()
    image = Image.new("RGB", (width, width), "white")
    draw = ImageDraw.Draw(image)
    for i in np.argsort(corners[:, :, 2].sum(1)):
        if normal[i, 2] > 0:
            colour = (SKIN * light[i]).clip(0, 255).astype(int)
            draw.polygon([tuple(pixel[k]) for k in faces[i]], fill=tuple(colour.tolist()))
    return np.array(image.resize((SIZE, SIZE), Image.LANCZOS))


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
            row.append(view(posing.linear_blend(rest, body.weights, transforms), body.faces))
        rows.append(np.concatenate(row, 1))
    Image.fromarray(np.concatenate(rows)).save(arguments.out)


if __name__ == "__main__":
    main()
