"""What `vitruvian measure --export` writes, read back without any of the program's code: numpy and small parsers."""
import csv
import json
import os
import subprocess
import tempfile
import unittest

import numpy as np
from scipy.spatial.transform import Rotation

from body import posing
from support import REPOSITORY, generated, made_body

CLI = os.environ.get("VITRUVIAN_CLI", os.path.join(REPOSITORY, "build", "native", "vitruvian"))


def read_trc(path):
    """Marker names and {name: position} of the one frame of an OpenSim marker file, with its header."""
    with open(path) as f:
        lines = [line.rstrip("\n").split("\t") for line in f]
    header = dict(zip(lines[1], lines[2]))
    names = [name for name in lines[3][2:] if name]
    row = next(line for line in lines[5:] if len(line) > 2)
    numbers = np.array([float(x) for x in row[2:] if x]).reshape(-1, 3)
    return header, names, dict(zip(names, numbers))


def read_ply(path):
    """Vertex table of a binary PLY."""
    with open(path, "rb") as f:
        data = f.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    types = {"uchar": "u1", "float": "<f4", "double": "<f8", "int": "<i4"}
    fields, count = [], 0
    for line in data[:end].decode().splitlines():
        word = line.split()
        if word[:2] == ["element", "vertex"]:
            count = int(word[2])
        elif word[:1] == ["element"]:
            break
        elif word[:1] == ["property"]:
            fields.append((word[2], types[word[1]]))
    return np.frombuffer(data, np.dtype(fields), count, end)


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.holder.cleanup)
        cls.folder = os.path.join(cls.holder.name, "sample")
        subprocess.run([CLI, "register", generated("sample.ply"), "--out", cls.holder.name, "--quiet"], check=True)
        subprocess.run([CLI, "measure", cls.file("registration.json"), "--out", cls.folder, "--scan", generated("sample.ply"),
                        "--export", "npz,smpl,trc,landmarks,ply,obj"], check=True, stdout=subprocess.DEVNULL)
        with open(cls.file("registration.json")) as f:
            cls.registration = json.load(f)
        with open(cls.file("measurements.json")) as f:
            cls.measurements = json.load(f)
        cls.joints = np.array([j["body_m"] for j in cls.registration["joints"]])

    @classmethod
    def file(cls, name):
        return os.path.join(cls.folder, name)

    def test_trc_holds_landmarks_and_joints_in_opensim_axes(self):
        header, names, markers = read_trc(self.file("markers.trc"))
        self.assertEqual(header["Units"], "mm")
        self.assertEqual(int(header["NumMarkers"]), len(names))
        # OpenSim: X forward, Y up, Z right; body frame: X left, Y up, Z forward.
        turned = lambda p: 1e3 * np.array([p[2], p[1], -p[0]])  # noqa: E731
        for joint in self.registration["joints"]:
            np.testing.assert_allclose(markers["joint_" + joint["name"]], turned(joint["body_m"]), atol=0.01)
        for landmark in self.measurements["landmarks"]:
            np.testing.assert_allclose(markers[landmark["name"]], turned(landmark["body_m"]), atol=0.01)
        with open(self.file("markers_subject.json")) as f:
            subject = json.load(f)
        stature = next(d for d in self.measurements["dimensions"] if d["id"] == "stature")
        self.assertAlmostEqual(1e3 * subject["heightM"], stature["value_mm"], delta=0.01)

    def posed_joints(self, betas, pose, translation):
        body = made_body()
        rest = body.regressor @ (body.v + np.tensordot(betas, body.shapedirs, 1))
        transforms = posing.skinning_transforms(rest, Rotation.from_rotvec(pose).as_matrix())
        return np.einsum("jab,jb->ja", transforms[:, :, :3], rest) + transforms[:, :, 3] + translation

    def test_amass_poses_the_registered_joints_with_z_up(self):
        with np.load(self.file("amass.npz"), allow_pickle=False) as data:
            self.assertEqual(data["poses"].shape, (1, 156))
            pose = np.zeros((24, 3))
            pose[:22] = data["poses"][0, :66].reshape(22, 3)
            found = self.posed_joints(data["betas"], pose, data["trans"][0])
        z_up = self.joints @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]).T
        np.testing.assert_allclose(found[:22], z_up[:22], atol=1e-5)

    def test_smpl_codec_poses_the_registered_joints(self):
        with np.load(self.file("body.smpl"), allow_pickle=False) as data:
            found = self.posed_joints(data["shapeParameters"], data["bodyPose"][0], data["bodyTranslation"][0])
        np.testing.assert_allclose(found, self.joints, atol=1e-5)

    def test_coloured_meshes_lie_on_the_registered_one(self):
        registered = read_ply(self.file("registered.ply"))
        place = np.stack([registered[a] for a in "xyz"], 1)
        segments, errors = read_ply(self.file("segments.ply")), read_ply(self.file("errors.ply"))
        scale = 1e-3 / self.registration["scan"]["metres_per_unit"]  # 1 mm in scan units
        for mesh in (segments, errors):
            np.testing.assert_allclose(np.stack([mesh[a] for a in "xyz"], 1), place, atol=0.01 * scale)
        np.testing.assert_array_equal(np.round(segments["segment"]), made_body().raw["segment"])
        self.assertEqual(len(np.unique(np.stack([segments[c] for c in ("red", "green", "blue")], 1), axis=0)), 24)
        mean = self.registration["surface_error"]["surface_all"]["mean_mm"]
        self.assertAlmostEqual(errors["error_mm"].mean(), mean, delta=0.5)
        with open(self.file("errors.obj")) as f:
            rows = [line.split()[1:] for line in f if line.startswith("v ")]
        self.assertEqual({len(row) for row in rows}, {6})  # with colours
        np.testing.assert_allclose(np.array(rows, float)[:, :3], place, atol=0.01 * scale)

    def test_landmarks_are_in_scan_units(self):
        with open(self.file("landmarks.csv")) as f:
            rows = list(csv.reader(f))
        places = {row[0]: np.array(row[1:4], float) for row in rows if row[0] != "name"}
        scale = 1e-3 / self.registration["scan"]["metres_per_unit"]
        for landmark in self.measurements["landmarks"]:
            np.testing.assert_allclose(places[landmark["name"]], landmark["scan"], atol=0.01 * scale)


if __name__ == "__main__":
    unittest.main()
