"""Suite forced: registrations led astray on purpose, so that there are wrong ones to judge the verdict by."""
import dataclasses
import json

import numpy as np

from . import objects, own_body
from .cases import Case, generator, spread
from .measures import MM, SMPL
from .other import avatars_if_present

SEED = 59
NOISE_M = 0.15
OBJECTS = 40
# Bodies and avatars (if there are any) of each way; most noisy keypoints lead to a right fit all the same.
WAYS = {"exchanged keypoints": (120, 44), "T-pose start": (60, 44), "wrong up": (60, 20), "noisy keypoints": (40, 20)}
# Which joints take the other side's place, by turns: all, those of the arms, of the forearms, of the legs, of the shanks.
EXCHANGED = (("hip", "knee", "ankle", "foot", "collar", "shoulder", "elbow", "wrist"), ("shoulder", "elbow", "wrist"),
             ("elbow", "wrist"), ("hip", "knee", "ankle", "foot"), ("knee", "ankle", "foot"))
UPS = ("x", "-x", "y", "-y", "z", "-z")
FRONT_OF = {"x": "y", "y": "z", "z": "x"}


def exchanged(joints, k, random, metres):
    swapped = EXCHANGED[k % len(EXCHANGED)]

    def partner(name):
        side, _, part = name.partition("_")
        return {"left": "right_", "right": "left_"}[side] + part if part in swapped else name

    return {name: joints[partner(name)] for name in joints}


def noisy(joints, k, random, metres):
    return {name: (np.array(p) + random.normal(0, NOISE_M / metres, 3)).tolist() for name, p in joints.items()}


@dataclasses.dataclass
class Forced(Case):
    """Another case's scan with joints that lie where `place` puts them."""

    of: Case = None
    place: object = None
    number: int = 0

    def files(self, folder):
        scan, truth, surface = self.of.files(folder)
        if self.place:
            target = folder / f"{self.name}.keypoints.json"
            if not target.exists():
                folder.mkdir(parents=True, exist_ok=True)
                known = json.loads(truth.read_text())
                random = generator(SEED, self.number)
                joints = {n: p for n, p in known["joints"].items() if n in SMPL}
                joints = self.place(joints, self.number, random, MM[known["unit"]] / 1e3)
                target.write_text(json.dumps({"frame": "scan", "joints": {n: {"position": p} for n, p in joints.items()}}))
        return scan, truth, surface


def forced(options):
    bodies, avatars = own_body.poses(options), avatars_if_present(options)
    scans = options.out / "scans"
    found = [objects.cases(OBJECTS)]
    for way, (of_bodies, of_avatars) in WAYS.items():
        for group, sources in (("body", bodies[:of_bodies]), ("avatar", spread(avatars, of_avatars))):
            own = []
            for k, source in enumerate(sources):
                name = f"{source.name}_{way.replace(' ', '_')}"
                arguments, place = (), None
                if way == "T-pose start":
                    arguments = ("--init", "tpose")
                elif way == "wrong up":
                    up = UPS[generator(SEED, k, 1).integers(len(UPS))]
                    arguments = ("--init", "tpose", f"--up={up}", f"--front={FRONT_OF[up[-1]]}")
                else:
                    arguments = ("--keypoints", str(scans / f"{name}.keypoints.json"))
                    place = exchanged if way.startswith("exchanged") else noisy
                own.append(Forced(name, source.make, f"{group}, {way}", source.hidden, arguments, source.source or source.name,
                                  source, place, k))
            found.append(own)
    # Mixed, each kind evenly from begin to end, so that a run that was stopped has all.
    ordered = sorted(((k + 0.5) / len(group), number, k) for number, group in enumerate(found) for k in range(len(group)))
    return [found[number][k] for _, number, k in ordered]
