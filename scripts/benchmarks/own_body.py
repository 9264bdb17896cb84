"""Suites of the default body itself, exact joints and surface known: default-body, poses, times, orientations."""
import itertools
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from . import meshes
from .cases import ROOT, Case, generator
from .measures import MM

sys.path[:0] = [str(ROOT / "scripts/models"), str(ROOT / "scripts/models/pose")]

import array_file  # noqa: E402  (found through the path above)
import cmu  # noqa: E402
import skeleton  # noqa: E402
import synthetic  # noqa: E402

SHAPE_SEED = 1
NOISE_SEED = 7
POSES_SEED = 11
POSE_VERTICES = 10475
MOTION_CAPTURE, MADE = 546, 200
# Close interaction and other poses that the motion capture lacks: (legs, arms, share).
MADE_KINDS = (("standing", "hugging", 3), ("standing", "shaking_hands", 3), ("standing", "pushing", 3),
              ("standing", "arms_crossed", 3), ("standing", "hands_on_hips", 1), ("standing", "hands_on_chest", 1),
              ("standing", "hands_on_head", 1), ("standing", "hands_on_shoulders", 1), ("standing", "hands_behind", 1),
              ("sitting", "arms_crossed", 1), ("sitting", "arms_to_legs", 1), ("kneeling", "arms_hanging", 1.5),
              ("half_kneeling", "arms_to_legs", 1.5), ("kneeling", "hugging", 1), ("lying", "arms_in_a_pose", 1.5),
              ("lying", "hands_on_chest", 1.5), ("lying", "arms_raised", 1))


class BodyFiles:
    """The maker of scans and the body beside the CLI, looked for when they are needed."""

    def __init__(self, cli):
        self.cli = Path(cli)

    def _first(self, what, *places):
        found = next((p for p in places if p.exists()), None)
        if found is None:
            raise SystemExit(f"no {what} beside {self.cli}: run scripts/start --no-serve and cmake --build build/native")
        return found

    @property
    def body(self):
        return self._first("models/body.vbm", self.cli.parent / "models/body.vbm", ROOT / "models/generated/body.vbm",
                           Path(os.environ.get("VITRUVIAN_DATA", "/nonexistent")) / "body.vbm")

    @property
    def maker(self):
        return self._first("vitruvian-make-scans", self.cli.with_name("vitruvian-make-scans"))

    def make(self, poses, folder, seed, *more):
        subprocess.run([self.maker, self.body, poses, folder, str(seed), *map(str, more)], check=True)

    def segments(self):
        """Segment (V) of every template vertex."""
        return array_file.read(str(self.body), "BODY")["segment"]


def default_body(options, seed=SHAPE_SEED):
    """200 varied test-side poses, one run of the maker for all."""
    files = BodyFiles(options.cli)

    def make(folder):
        with tempfile.TemporaryDirectory(dir=folder) as made:
            files.make(ROOT / "tests/data/test_poses.csv", made, seed, 200)
            for path in Path(made).iterdir():
                path.rename(folder / path.name.replace("body_", f"seed{seed}_body_"))

    return [Case(f"seed{seed}_body_{k:03}", make) for k in range(200)]


def pose_list():
    """746 poses (N,24,3) and the kind of each: the most different ones of the test side, and made ones."""
    test = cmu.load_side(cmu.SUBSET_DATA, "test")["poses"]
    features = skeleton.body_joints(test).reshape(len(test), -1)
    count = min(MOTION_CAPTURE, len(test))
    poses, kinds = [test[_farthest(features, count)]], ["motion capture"] * count
    random = generator(POSES_SEED)
    table = synthetic.ArmTable(random, 200_000)
    total = sum(weight for *_, weight in MADE_KINDS)
    wanted = MADE + MOTION_CAPTURE - count
    shares = np.array([wanted * weight / total for *_, weight in MADE_KINDS])
    counts = np.diff(np.round(np.concatenate([[0], np.cumsum(shares)])).astype(int))
    for (legs, arms, _), n in zip(MADE_KINDS, counts):
        own = []
        while len(own) < n:  # some reaches find no arm
            trunk, both = getattr(synthetic, legs)(random, 2 * n)
            rotations = synthetic.assemble(random, trunk, both, 2 * n)
            good = getattr(synthetic, arms)(rotations, table, random)
            own += list(skeleton.vectors(rotations[good]))
        own = np.array(own[:n])
        if legs == "lying":
            own[:, 0] = _lying_roots(n, random)
        swap = random.random(n) < 0.5
        own[swap, 1:] = skeleton.mirrored(own[swap])[:, 1:]
        poses.append(own)
        kinds += [f"{legs}, {arms}".replace("_", " ")] * n
    return np.concatenate(poses), kinds


def _lying_roots(count, random):
    """Root rotations that lay a body on its back, front or side."""
    roll = random.choice([-90.0, 90.0, -90.0, 0.0], count)
    side = np.where(roll == 0, 90.0, 0.0)
    turn = skeleton.about("x", np.radians(roll)) @ skeleton.about("z", np.radians(side))
    return skeleton.vectors(turn)


def _farthest(features, count):
    """Indices: the one nearest the mean, then always the one farthest from all before."""
    chosen = [int(np.linalg.norm(features - features.mean(0), axis=1).argmin())]
    distance = np.linalg.norm(features - features[chosen[0]], axis=1)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(features - features[chosen[-1]], axis=1))
    return np.sort(chosen)


def poses(options):
    files = BodyFiles(options.cli)
    found, kinds = pose_list()

    def case(k):
        def make(folder):
            with tempfile.TemporaryDirectory(dir=folder) as made:
                np.savetxt(Path(made) / "pose.csv", found[k].reshape(1, 72), fmt="%.6f", delimiter=",")
                files.make(Path(made) / "pose.csv", made, 1000 + k, 1, POSE_VERTICES)
                for path in Path(made).glob("body_000.*"):
                    path.rename(folder / path.name.replace("body_000", f"pose_{k:03}"))
        return Case(f"pose_{k:03}", make, kinds[k])

    # Mixed, so that every limited run has some of each kind.
    return [case(k) for k in generator(POSES_SEED, 1).permutation(len(found))]


def times(options):
    """Ten shapes and poses at two sizes."""
    chosen = default_body(options)[::20]

    def case(source, count, size):
        def make(folder):
            scan, truth, _ = source.files(folder.parent / "sources")
            random = generator(NOISE_SEED, count, int(source.name[-3:]))
            meshes.write_ply(folder / f"{size}_{source.name}.ply", *meshes.with_vertex_count(*meshes.read_ply(scan), count, random))
            (folder / f"{size}_{source.name}.truth.json").write_text(truth.read_text())
        return Case(f"{size}_{source.name}", make, size)

    return [case(source, count, size) for count, size in ((0, "14k"), (1000000, "1M")) for source in chosen]


def axis_rotations():
    """{name: rotation} of the 24 that carry axes to axes."""
    found = {}
    for permutation in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            rotation = np.zeros((3, 3))
            rotation[range(3), permutation] = signs
            if np.linalg.det(rotation) > 0:
                found["".join("+-"[s < 0] + "xyz"[p] for s, p in zip(signs, permutation))] = rotation
    return found


def write_turned(folder, name, vertices, faces, truth, rotation, unit):
    """The scan turned and in another unit, and its truth."""
    ratio = MM[truth["unit"]] / MM[unit]
    meshes.write_ply(folder / f"{name}.ply", ratio * vertices @ rotation.T, faces)
    joints = {n: list(ratio * rotation @ np.array(p)) for n, p in truth["joints"].items()}
    (folder / f"{name}.truth.json").write_text(json.dumps({"frame": "scan", "unit": unit, "joints": joints}))


def orientations(options):
    """One scan in 24 orientations, each in four units."""
    source = default_body(options)[0]

    def case(name, rotation, unit):
        def make(folder):
            scan, truth, _ = source.files(folder.parent / "sources")
            write_turned(folder, name, *meshes.read_ply(scan), json.loads(truth.read_text()), rotation, unit)
        return Case(name, make, unit)

    return [case(f"{name}_{unit}", rotation, unit) for name, rotation in axis_rotations().items() for unit in MM]
