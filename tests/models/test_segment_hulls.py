"""The published segment volumes (paper, appendix D.1) of the command line against SciPy's Delaunay tetrahedra."""
import json
import os
import subprocess
import tempfile
import unittest

import numpy as np
from scipy.spatial import Delaunay
from support import GENERATED, REPOSITORY, made_body

CLI = os.environ.get("VITRUVIAN_CLI", os.path.join(REPOSITORY, "build", "native", "vitruvian"))


def registration(body, betas):
    """A registration.json of the body at rest."""
    with open(os.path.join(GENERATED, "body.vbm"), "rb") as file:
        from hashlib import sha256

        digest = sha256(file.read()).hexdigest()
    identity = np.eye(4).tolist()
    return {
        "vitruvian": "test",
        "scan": {"file": "x.ply", "sha256": "", "vertices": 0, "faces": 0, "unit": "m", "metres_per_unit": 1},
        "model": {"name": "default", "family": "vitruvian", "gender": "neutral", "vertices": len(body.v),
                  "faces": len(body.faces), "betas": len(betas), "joints": 24, "sha256": digest},
        "alignment": {"body_from_scan": identity, "canonical_from_body": identity, "up": "y", "front": "z",
                      "method": "given"},
        "keypoints": [],
        "parameters": {"betas": list(betas), "pose": [0.0] * 72, "translation_m": [0, 0, 0]},
        "joints": [],
        "surface_error": None,
        "verdict": {"status": "ok", "confidence": 1, "reasons": []},
        "timing_ms": dict.fromkeys(
            ["read", "align", "project", "detect", "pose", "fit", "refine", "detail", "write", "total"], 0),
        "settings": {"method": "ours", "align": "auto", "views": 8, "min_visibility": 0, "init": "auto",
                     "solver": "fast", "iterations": 1, "adam_iterations": 0, "one_directional": False, "chunk": 0,
                     "gender": "neutral", "betas": 0, "units": "auto", "up": "auto",
                     "front": "auto", "detail": "off", "threads": 1, "seed": 1},
    }


def delaunay_volume(points):
    corners = points[Delaunay(points).simplices]
    edges = corners[:, 1:] - corners[:, :1]
    return np.abs(np.einsum("ij,ij->i", np.cross(edges[:, 0], edges[:, 1]), edges[:, 2])).sum() / 6


class SegmentHulls(unittest.TestCase):
    def test_hull_volume_is_the_sum_of_delaunay_tetrahedra(self):
        body = made_body()
        for seed in (0, 1):
            betas = np.random.default_rng(seed).normal(size=len(body.shapedirs)) * seed
            vertices = body.v + np.tensordot(betas, body.shapedirs, 1)
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "registration.json")
                with open(path, "w", encoding="utf-8") as file:
                    json.dump(registration(body, betas), file)
                printed = subprocess.run(
                    [CLI, "measure", path, "--model", os.path.join(GENERATED, "body.vbm")],
                    check=True, capture_output=True, text=True).stdout
            for number, segment in enumerate(json.loads(printed)["segments"]):
                expected = 1e6 * delaunay_volume(vertices[body.raw["segment"] == number])
                self.assertAlmostEqual(segment["volume_hull_cm3"] / expected, 1, delta=1e-5, msg=segment["segment"])


if __name__ == "__main__":
    unittest.main()
