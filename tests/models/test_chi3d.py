"""SMPL-X forward and the paper's selection of CHI3D samples, on a made model and a made data set."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from benchmarks import chi3d, meshes, smplx  # noqa: E402

SEED = 20
VERTICES, JOINTS, BETAS = 220, 55, 20
# Parents of SMPL-X in joint order: body 0-21, jaw, eyes, then 15 joints a hand.
PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 15, 15, 15]
for wrist in (20, 21):
    for finger in range(5):
        first = len(PARENTS)
        PARENTS += [wrist, first, first + 1]
LEFT_ELBOW, LEFT_WRIST = 18, 20


def below(joint):
    """The joint and all its descendants."""
    found = {joint}
    for j, parent in enumerate(PARENTS):
        if parent in found:
            found.add(j)
    return sorted(found)


def write_model(path, generator):
    """Random arrays of SMPL-X's names and shapes; each vertex hangs on one or two joints."""
    weights = np.zeros((VERTICES, JOINTS))
    for v in range(VERTICES):
        weights[v, v % JOINTS] += 0.7
        weights[v, generator.integers(JOINTS)] += 0.3
    regressor = np.zeros((JOINTS, VERTICES))
    for j in range(JOINTS):
        regressor[j, generator.choice(VERTICES, 3, replace=False)] = 1 / 3
    np.savez(path, v_template=generator.normal(size=(VERTICES, 3)), weights=weights, J_regressor=regressor,
             shapedirs=0.01 * generator.normal(size=(VERTICES, 3, BETAS)), posedirs=0.01 * generator.normal(size=(VERTICES, 3, 486)),
             kintree_table=np.array([[2**32 - 1] + PARENTS[1:], range(JOINTS)], np.uint32), f=np.array([[0, 1, 2], [2, 1, 3]], np.uint32),
             hands_meanl=0.2 * generator.normal(size=45), hands_meanr=np.zeros(45),
             hands_componentsl=np.eye(45), hands_componentsr=np.eye(45))
    return path


def person(generator, **given):
    """Parameters as CHI3D stores them: rotation matrices."""
    parameters = {"betas": generator.normal(size=10), "expression": generator.normal(size=10), "transl": generator.normal(size=3)}
    for key, joints in smplx.POSE_KEYS:
        parameters[key] = smplx.rotation_from_axis_angle(0.5 * generator.normal(size=(joints, 3)))
    return parameters | given


class ForwardModel(unittest.TestCase):
    def setUp(self):
        self.generator = np.random.default_rng(SEED)
        with tempfile.TemporaryDirectory() as folder:
            self.model = smplx.Smplx.read(write_model(Path(folder) / "m.npz", self.generator))

    def test_without_pose_only_shape_expression_and_place_count(self):
        betas, expression = self.generator.normal(size=10), self.generator.normal(size=10)
        vertices, joints = self.model.pose({"betas": betas, "expression": expression, "transl": [1, 2, 3]})
        shaped = self.model.arrays["v_template"] + self.model.arrays["shapedirs"] @ np.concatenate([betas, expression])
        np.testing.assert_allclose(vertices, shaped + [1, 2, 3], atol=1e-12)
        np.testing.assert_allclose(joints, self.model.arrays["J_regressor"] @ shaped + [1, 2, 3], atol=1e-12)

    def test_turning_the_root_turns_the_whole_body_about_the_pelvis(self):
        parameters = person(self.generator, transl=np.zeros(3))
        upright, joints = self.model.pose(parameters | {"global_orient": np.zeros(3)})
        turn = smplx.rotation_from_axis_angle(np.array([[0.3, -1.1, 0.4]]))
        turned, turned_joints = self.model.pose(parameters | {"global_orient": turn})
        np.testing.assert_allclose(turned, (upright - joints[0]) @ turn[0].T + joints[0], atol=1e-9)
        np.testing.assert_allclose(turned_joints, (joints - joints[0]) @ turn[0].T + joints[0], atol=1e-9)

    def test_an_elbow_moves_what_hangs_on_it_and_nothing_else(self):
        self.model.arrays["posedirs"][:] = 0
        body = np.zeros((smplx.BODY_JOINTS, 3))
        body[LEFT_ELBOW - 1] = [0, 0.9, 0]
        rest, rest_joints = self.model.pose({})
        bent, joints = self.model.pose({"body_pose": body})
        own = below(LEFT_ELBOW)
        hangs = self.model.arrays["weights"][:, own].sum(1)
        np.testing.assert_allclose(bent[hangs == 0], rest[hangs == 0], atol=1e-12)
        rotation = smplx.rotation_from_axis_angle(body[[LEFT_ELBOW - 1]])[0]
        expected = (rest - rest_joints[LEFT_ELBOW]) @ rotation.T + rest_joints[LEFT_ELBOW]
        np.testing.assert_allclose(bent[hangs == 1], expected[hangs == 1], atol=1e-12)
        np.testing.assert_allclose(np.delete(joints, own[1:], 0), np.delete(rest_joints, own[1:], 0), atol=1e-12)
        self.assertGreater(np.abs(joints[LEFT_WRIST] - rest_joints[LEFT_WRIST]).max(), 0.01)

    def test_matrices_axis_angle_and_hand_components_are_the_same_pose(self):
        parameters = person(self.generator)
        coefficients = 0.3 * self.generator.normal(size=6)
        angles = np.concatenate([coefficients, np.zeros(39)]) + self.model.arrays["hands_meanl"]
        parameters["left_hand_pose"] = coefficients
        by_components, _ = self.model.pose(parameters)
        parameters["left_hand_pose"] = angles
        by_angles, _ = self.model.pose(parameters)
        parameters["left_hand_pose"] = smplx.rotation_from_axis_angle(angles.reshape(15, 3))
        by_matrices, _ = self.model.pose(parameters)
        np.testing.assert_allclose(by_components, by_matrices, atol=1e-12)
        np.testing.assert_allclose(by_angles, by_matrices, atol=1e-12)


class Selection(unittest.TestCase):
    def test_categories(self):
        for name, action in (("Grab 12", "grab"), ("Handshake 3", "handshake"), ("Hit 1", "hit"), ("HoldingHands 2", "holding hands"),
                             ("Holding Hands 2", "holding hands"), ("Hug 18", "hug"), ("Kick 4", "kick"), ("Posing 9", "posing"),
                             ("Push 7", "push"), ("Walking 1", None), ("", None)):
            self.assertEqual(chi3d.action_of(name), action, name)

    def make(self, folder, generator):
        """Two sequences of the selection, one of another action, one of another subject; two persons, two frames."""
        first = {}
        for subject, action in (("s02", "Hug 1"), ("s04", "Holding Hands 2"), ("s02", "Walk 1"), ("s05", "Hug 1")):
            people = [[person(generator) for _ in range(2)] for _ in range(2)]
            first[subject, action] = [frames[0] for frames in people]
            path = folder / "train" / subject / "smplx" / f"{action}.json"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps({k: [[f[k].tolist() for f in frames] for frames in people] for k in people[0][0]}))
        return first

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, str(ROOT / "scripts/make_chi3d"), *map(str, arguments)], capture_output=True, text=True)

    def test_both_persons_at_frame_0_of_the_eight_actions(self):
        generator = np.random.default_rng(SEED)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            model = write_model(folder / "SMPLX_NEUTRAL.npz", generator)
            first = self.make(folder, generator)
            result = self.run_script(folder, model, folder / "out")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("hug 2", result.stdout)
            self.assertIn("746", result.stderr)  # the made set is not whole, and is told so
            names = sorted(p.stem for p in (folder / "out").glob("*.ply"))
            self.assertEqual(names, ["s02_Hug-1_0", "s02_Hug-1_1", "s04_Holding-Hands-2_0", "s04_Holding-Hands-2_1"])
            vertices, joints = smplx.Smplx.read(model).pose(first["s02", "Hug 1"][1])
            np.testing.assert_allclose(meshes.read_ply(folder / "out/s02_Hug-1_1.ply")[0], vertices, atol=1e-5)
            truth = json.loads((folder / "out/s02_Hug-1_1.truth.json").read_text())
            self.assertEqual(len(truth["joints"]), 22)
            np.testing.assert_allclose(truth["joints"]["left_wrist"], joints[LEFT_WRIST], atol=1e-9)

    def test_what_is_missing_or_broken_is_named(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            model = write_model(folder / "SMPLX_NEUTRAL.npz", np.random.default_rng(SEED))
            result = self.run_script(folder, model, folder / "out")
            self.assertIn("train/", result.stderr)
            broken = folder / "train/s02/smplx/Hug 1.json"
            broken.parent.mkdir(parents=True)
            for text in ("{", "{}", '{"betas": [[[0]], [[0]]], "body_pose": [[[1, 2]], [[1, 2]]]}'):
                broken.write_text(text)
                result = self.run_script(folder, model, folder / "out")
                self.assertNotEqual(result.returncode, 0)
                self.assertIn("Hug 1.json", result.stderr, text)
                self.assertNotIn("Traceback", result.stderr)
            result = self.run_script(folder, broken, folder / "out")
            self.assertIn("SMPLX_NEUTRAL.npz", result.stderr)
            self.assertNotIn("Traceback", result.stderr)


if __name__ == "__main__":
    unittest.main()
