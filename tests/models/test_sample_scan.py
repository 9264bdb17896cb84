"""The bundled sample scan: size, units, holes, truth."""
import json
import unittest

import numpy as np

from support import generated


def read_ply(path):
    with open(path, "rb") as f:
        data = f.read()
    begin = data.index(b"end_header\n") + len("end_header\n")
    counts = {line.split()[1]: int(line.split()[2]) for line in data[:begin].decode().split("\n") if "element" in line}
    vertex = np.frombuffer(data, [("xyz", "<f4", 3), ("rgb", "u1", 3)], counts["vertex"], begin)
    face = np.frombuffer(data, [("n", "u1"), ("v", "<i4", 3)], counts["face"], begin + vertex.nbytes)
    return vertex["xyz"].astype(float), face["v"]


class SampleScan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.vertices, cls.faces = read_ply(generated("sample.ply"))
        with open(generated("sample.truth.json")) as f:
            cls.truth = json.load(f)

    def test_a_standing_man_in_millimetres(self):
        self.assertTrue(60_000 <= len(self.vertices) <= 120_000)
        self.assertTrue(np.isfinite(self.vertices).all())
        extent = np.ptp(self.vertices, axis=0)
        self.assertTrue(1600 < extent[2] < 1900)
        self.assertLess(extent[:2].max(), 1100)
        self.assertEqual(len(np.unique(self.faces)), len(self.vertices))

    def test_it_has_a_few_holes(self):
        edges = np.sort(np.concatenate([self.faces[:, [0, 1]], self.faces[:, [1, 2]], self.faces[:, [2, 0]]]), 1)
        _, uses = np.unique(edges, axis=0, return_counts=True)
        self.assertEqual((uses > 2).sum(), 0)
        self.assertTrue(50 < (uses == 1).sum() < 0.03 * len(uses))

    def test_joints_lie_in_the_body(self):
        self.assertEqual((self.truth["frame"], self.truth["unit"], len(self.truth["joints"])), ("scan", "mm", 22))
        for name, joint in self.truth["joints"].items():
            nearest = np.linalg.norm(self.vertices - joint, axis=1).min()
            self.assertLess(nearest, 150, name)
        joints = {name: np.array(j) for name, j in self.truth["joints"].items()}
        self.assertGreater(joints["head"][2], joints["pelvis"][2] + 400)
        self.assertLess(joints["left_ankle"][2], 150)

    def test_left_is_left(self):
        joints = {name: np.array(j) for name, j in self.truth["joints"].items()}
        across = joints["left_hip"] - joints["right_hip"]
        up = joints["head"] - joints["pelvis"]
        forward = joints["left_foot"] - joints["left_ankle"]
        self.assertGreater(np.dot(np.cross(across, up), forward), 0)


if __name__ == "__main__":
    unittest.main()
