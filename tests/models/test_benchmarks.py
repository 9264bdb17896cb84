"""The benchmark's own parts: scans spoilt as announced, tables that count failures in, suites that can be repeated."""
import math
import os
import sys
import unittest
from types import SimpleNamespace

import numpy as np

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(REPOSITORY, "scripts"))

from benchmarks import degraded, measures, meshes, own_body, pictures, tables  # noqa: E402
from benchmarks.cases import Case, generator, spread  # noqa: E402
from support import made_body  # noqa: E402


def t_pose():
    """Vertices, faces and joints of the body in its T-pose."""
    body = made_body()
    names = own_body.skeleton.NAMES
    return body.v, body.faces, dict(zip(names, body.regressor @ body.v))


class SpoiltScans(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.vertices, cls.faces, cls.joints = t_pose()
        cls.truth = {"unit": "m", "joints": {n: list(p) for n, p in cls.joints.items()}}

    def spoilt(self, kind, side="left"):
        return degraded.spoilt(kind, side, self.vertices, self.faces, self.truth, generator(1))

    def test_missing_parts_are_missing_and_nothing_else(self):
        for kind, gone, kept in (("no forearm", "left_wrist", "right_wrist"), ("no foot", "left_foot", "right_foot"),
                                 ("no head", "head", "left_foot")):
            vertices, _, _, _ = self.spoilt(kind)
            self.assertGreater(np.linalg.norm(vertices - self.joints[gone], axis=1).min(), 0.04, kind)
            self.assertLess(np.linalg.norm(vertices - self.joints[kept], axis=1).min(), 0.06, kind)
            self.assertGreater(len(vertices), 0.4 * len(self.vertices), kind)

    def test_a_front_only_scan_faces_forward(self):
        vertices, faces, _, _ = self.spoilt("front only")
        self.assertTrue(0.25 < len(vertices) / len(self.vertices) < 0.6)
        self.assertGreater((meshes.normals(vertices, faces)[:, 2] > 0).mean(), 0.95)

    def test_holes_take_the_share_they_should(self):
        vertices, faces, _, _ = self.spoilt("holes 15 %")
        self.assertTrue(0.78 < len(vertices) / len(self.vertices) < 0.86)
        self.assertLess(faces.max(), len(vertices))

    def test_few_vertices(self):
        vertices, faces, _, _ = self.spoilt("2000 vertices")
        self.assertTrue(1800 <= len(vertices) <= 2000)
        self.assertGreater(len(faces), 3000)

    def test_a_floor_touches_the_lowest_point(self):
        vertices, _, _, _ = self.spoilt("floor")
        floor = vertices[len(self.vertices):]
        self.assertLess(abs(np.median(floor[:, 1]) - self.vertices[:, 1].min()), 0.002)

    def test_the_rest_is_only_turned_scaled_or_shaken(self):
        for kind in ("rotation", "unit", "noise 5 mm", "no faces"):
            vertices, _, rotation, _ = self.spoilt(kind)
            self.assertEqual(len(vertices), len(self.vertices))
            self.assertAlmostEqual(np.linalg.det(rotation), 1, places=9)


class Tables(unittest.TestCase):
    def test_failures_count_as_wrong(self):
        rows = [{"e_max": 10.0, "core_max": 10.0}, {"e_max": math.inf, "core_max": math.inf}]
        made = tables.Tables()
        tables.success(made, rows)
        self.assertEqual(made.all[0][1][1][-1], "50.0 %")

    def test_wilson_interval(self):
        low, high = tables.wilson(148, 150)
        self.assertAlmostEqual(low, 0.953, places=3)
        self.assertAlmostEqual(high, 0.996, places=3)

    def test_joint_errors_do_not_see_a_common_offset_and_leave_out_the_hidden(self):
        joints = {name: [float(k), 2.0, 3.0] for k, name in enumerate(measures.SMPL)}
        found = {"joints": [{"name": n, "scan": [p[0], p[1] + 1, p[2] + 0.5 * (n == "left_wrist")]} for n, p in joints.items()]}
        truth = {"unit": "m", "joints": joints}
        aligned, core = measures.joint_errors(found, truth)
        self.assertAlmostEqual(aligned["left_wrist"], 500, places=6)
        self.assertAlmostEqual(core, 500 * 11 / 12, places=6)
        self.assertAlmostEqual(measures.joint_errors(found, truth, ("left_wrist",))[1], 0, places=6)


class Suites(unittest.TestCase):
    def test_a_limited_run_is_spread_and_part_of_the_whole(self):
        cases = [Case(str(k), None) for k in range(746)]
        some = spread(cases, 100)
        self.assertEqual(len({c.name for c in some}), 100)
        self.assertLess(int(some[0].name), 8)
        self.assertGreaterEqual(int(some[-1].name), 735)

    def test_the_poses_are_as_many_and_the_same_each_time(self):
        poses, kinds = own_body.pose_list()
        again, _ = own_body.pose_list()
        self.assertEqual((poses.shape, len(kinds)), ((746, 24, 3), 746))
        self.assertTrue(np.array_equal(poses, again))
        self.assertTrue(np.isfinite(poses).all())

    def test_every_kind_of_degraded_has_its_fifty(self):
        options = SimpleNamespace(cli="/nonexistent", scans="/nonexistent", out=None)
        cases = degraded.degraded(options)
        kinds = [c.kind for c in cases]
        self.assertEqual({k: kinds.count(k) for k in degraded.KINDS}, dict.fromkeys(degraded.KINDS, 50))
        self.assertEqual(len({c.name for c in cases}), len(cases))


class Pictures(unittest.TestCase):
    def test_a_body_covers_its_place_and_left_is_on_the_viewers_right(self):
        vertices, faces, _ = t_pose()
        arm = vertices[:, 0] > 0.4
        kept, kept_faces = meshes.restricted(vertices, faces, ~arm)
        whole = pictures.view(vertices, faces, pictures.camera(), pictures.frame_of(vertices))
        cut = pictures.view(kept, kept_faces, pictures.camera(), pictures.frame_of(vertices))
        changed = np.nonzero((whole != cut).any(2))
        self.assertGreater(len(changed[0]), 200)
        self.assertGreater(changed[1].min(), whole.shape[1] / 2)


if __name__ == "__main__":
    unittest.main()
