"""The study of the verdict: scans led astray as announced, and a calibration that can be repeated."""
import json
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(REPOSITORY, "scripts"))

from benchmarks import forced, measures, meshes, objects, verdict_model  # noqa: E402
from benchmarks.cases import generator  # noqa: E402

SEGMENT = {"observed": 1.0, "unseen": 0.0, "model_to_scan_p95_mm": 2.0, "scan_to_model_p95_mm": 2.0, "unexplained_share": 0.0,
           "opposed_share": 0.0}
FEATURES = {"model_to_scan_p95_mm": 2.0, "scan_to_model_p95_mm": 2.0, "typical_mm": 16.0, "unexplained_share": 0.0,
            "opposed_share": 0.0, "inside_share": 0.01, "limb_misfit": {"left_hand": 0.5}, "joint_limit_excess_rad": {},
            "keypoint_disagreement_m": {}, "segments": [dict(SEGMENT) for _ in range(24)]}


class Forced(unittest.TestCase):
    def test_objects_have_the_size_of_people_and_are_the_same_each_time(self):
        for case in objects.cases(len(objects.KINDS)):
            with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
                scans = [case.files(Path(folder)) for folder in (first, second)]
                self.assertEqual(scans[0][0].read_bytes(), scans[1][0].read_bytes(), case.name)
                truth = json.loads(scans[0][1].read_text())
                vertices, faces = meshes.read_ply(scans[0][0])
            self.assertEqual(truth["joints"], {})
            extent = np.ptp(vertices * measures.MM[truth["unit"]] / 1e3, axis=0).max()
            self.assertTrue(0.5 < extent < 3, (case.name, extent))
            self.assertTrue(np.isfinite(vertices).all())
            self.assertLess(faces.max(), len(vertices))
            self.assertGreater(len(faces), 1000)

    def test_exchanged_joints_are_exchanged_and_noise_has_its_size(self):
        joints = {name: [float(i), 0.0, 0.0] for i, name in enumerate(measures.SMPL)}
        for k, parts in enumerate(forced.EXCHANGED):
            moved = forced.exchanged(joints, k, None, 1)
            for name in joints:
                side, _, part = name.partition("_")
                other = {"left": "right", "right": "left"}.get(side, side) + "_" + part
                self.assertEqual(moved[name], joints[other if part in parts else name])
        random = generator(1)
        offsets = np.array([list(forced.noisy(joints, 0, random, 0.001).values()) for _ in range(200)]) - np.array(list(joints.values()))
        self.assertAlmostEqual(offsets.std() * 0.001, forced.NOISE_M, delta=0.005)


class Calibration(unittest.TestCase):
    def test_the_cores_constants_are_in_the_order_of_the_inputs(self):
        source = Path(REPOSITORY, "core/measure/verdict_model.cpp").read_text()
        names = re.findall(r"\{[-\d.]+, [-\d.]+\},\s*// (\w+)", source)
        self.assertEqual(names, list(verdict_model.inputs(FEATURES)))

    def test_every_input_but_typical_grows_with_what_speaks_against_a_fit(self):
        before = verdict_model.inputs(FEATURES)
        worse = {**FEATURES, "model_to_scan_p95_mm": 40, "scan_to_model_p95_mm": 40, "typical_mm": 30, "unexplained_share": 0.2,
                 "opposed_share": 0.1, "inside_share": 0.1, "limb_misfit": {"left_hand": 2}, "joint_limit_excess_rad": {"neck": 1},
                 "keypoint_disagreement_m": {"neck": 1},
                 "segments": [dict(SEGMENT) for _ in range(22)] + [{**SEGMENT, "observed": 0.1}] +
                             [{key: 60 * value + 0.9 if key != "unseen" else 0 for key, value in SEGMENT.items()}]}
        after = verdict_model.inputs(worse)
        for name in before:
            self.assertGreater(after[name], before[name], name)

    def test_parts_that_the_scan_does_not_show_say_nothing(self):
        hidden = {**SEGMENT, "observed": 0.0, "unseen": 0.9, "model_to_scan_p95_mm": 500.0, "opposed_share": 1.0}
        self.assertEqual(verdict_model.inputs({**FEATURES, "segments": [dict(SEGMENT) for _ in range(23)] + [hidden]}),
                         verdict_model.inputs(FEATURES))

    def test_the_fit_finds_the_probability_and_never_praises_what_is_bad(self):
        random = generator(2)
        x = random.uniform(0, 3, (4000, 3))
        probability = 1 / (1 + np.exp(4 - 2 * x[:, 0] - x[:, 1]))  # the third says nothing
        wrong = random.random(4000) < probability
        bare = np.ones(4000, bool)
        bias, weights = verdict_model.fit(x, wrong, bare, ["a", "b", "c"])
        self.assertTrue(all(weight >= 0 for weight in weights.values()))
        self.assertGreater(weights["a"], 1.4 * weights["b"])
        self.assertLess(weights["c"], 0.2)
        high = np.array([verdict_model.confidence(dict(zip("abc", row)), bias, weights) for row in x])
        self.assertGreater(high[~wrong].mean(), high[wrong].mean() + 0.3)
        self.assertEqual((bias, weights), verdict_model.fit(x, wrong, bare, ["a", "b", "c"]))


if __name__ == "__main__":
    unittest.main()
