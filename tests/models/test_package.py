"""Only admitted arrays can be read, and only unchanged ones: a small package of the same layout, then tampered with."""
import hashlib
import json
import os
import tempfile
import unittest

import numpy as np

import support  # noqa: F401  (sets the import path)
from body.package import CUBES, NAME, SKIN, VERSION, VERTEX_COUNT, NotAdmitted, Package


def sha256(array, dtype):
    return hashlib.sha256(np.ascontiguousarray(array, dtype).tobytes()).hexdigest()


def json_sha256(value):
    return hashlib.sha256(json.dumps(value, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


class AdmittedArrays(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        rng = np.random.default_rng(1)
        self.vertices = rng.normal(size=(VERTEX_COUNT, 3)).round(3)
        self.targets = rng.integers(-50, 50, (3, VERTEX_COUNT, 3)).astype("<i2")
        names = [f"data/targets/{n}.target" for n in ("a", "b", "c")]
        rig = {"joints": {"j": [1, 2]}, "bones": {"root": {"head": "j", "tail": "j", "parent": None}}}
        self.json("package.json", {"name": NAME, "version": VERSION})
        face = [11, 0, 1, 2, 3, 0, 0, 0, 0, 0]
        self.json("public/data/models/human_full_size.json", {"vertices": self.vertices.ravel().tolist(), "faces": face})
        self.json("src/json/rigs/default.json", rig)
        self.json("src/json/targets/target-list.json", {"targets": {n: 0 for n in names}})
        os.makedirs(self.path("public/data/targets"))
        self.write_targets()
        self.admitted = {
            "base_vertices_f8_sha256": sha256(self.vertices[SKIN], "<f8"),
            "base_joint_cube_vertices_13606_14597_f8_sha256": sha256(self.vertices[CUBES], "<f8"),
            "body_quads_i4_sha256": sha256([[0, 1, 2, 3]], "<i4"),
            "rig_joint_vertex_lists_sha256": json_sha256(rig["joints"]),
            "rig_bones_head_tail_parent_sha256": json_sha256({"root": ["j", "j", None]}),
            "targets_i2_body_rows_sha256": {n: sha256(t[SKIN], "<i2") for n, t in zip(names[:2], self.targets)},
            "targets_i2_joint_cube_rows_13606_14597_sha256": {names[0]: sha256(self.targets[0, CUBES], "<i2")},
        }

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def json(self, name, value):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w") as f:
            json.dump(value, f)

    def write_targets(self):
        self.targets.tofile(self.path("public/data/targets/targets.bin"))

    def package(self):
        self.json("admitted.json", self.admitted)
        return Package(self.folder.name, self.path("admitted.json"))

    def test_admitted_arrays_are_read_in_metres(self):
        package = self.package()
        np.testing.assert_allclose(package.skin, self.vertices[SKIN] * 0.1)
        np.testing.assert_allclose(package.skin_target("data/targets/a.target"), self.targets[0, SKIN] * 1e-4, rtol=1e-6)
        self.assertEqual(package.target_names(), ["data/targets/a.target", "data/targets/b.target"])

    def test_unlisted_targets_are_refused(self):
        package = self.package()
        self.assertFalse(package.is_admitted("data/targets/c.target"))
        for name in ("data/targets/c.target", "data/targets/unknown.target"):
            with self.assertRaises(NotAdmitted):
                package.skin_target(name)
        self.assertIsNone(package.cube_target("data/targets/b.target"))

    def test_one_changed_number_in_a_target_is_refused(self):
        self.targets[0, 77, 1] += 1
        self.targets[0, CUBES.start, 2] += 1
        self.write_targets()
        package = self.package()
        with self.assertRaisesRegex(NotAdmitted, "a.target"):
            package.skin_target("data/targets/a.target")
        with self.assertRaises(NotAdmitted):
            package.cube_target("data/targets/a.target")
        package.skin_target("data/targets/b.target")

    def test_a_changed_base_or_rig_is_refused(self):
        for key in list(self.admitted):
            if key.startswith("targets"):
                continue
            kept = self.admitted[key]
            self.admitted[key] = "0" * 64
            with self.assertRaises(NotAdmitted, msg=key):
                self.package()
            self.admitted[key] = kept

    def test_another_version_is_not_taken_for_the_package(self):
        self.json("package.json", {"name": NAME, "version": "0.0.3"})
        with self.assertRaises(FileNotFoundError):
            self.package()


if __name__ == "__main__":
    unittest.main()
