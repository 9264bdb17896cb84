"""CHI3D (Fieraru et al. 2020): the paper's selection of samples, and the suite over the rebuilt meshes."""
import json
import math
import re
from pathlib import Path

from . import meshes
from .measures import SMPL
from .other import avatars_if_present

PAPERS_SAMPLES = 746
PEOPLE = 2
SUBJECTS = ("s02", "s03", "s04")
# Category -> how the names of its sequences begin, letters alone and small.
ACTIONS = {"grab": "grab", "handshake": "handshak", "hit": "hit", "holding hands": "hold", "hug": "hug", "kick": "kick",
           "posing": "pos", "push": "push"}


def action_of(name):
    """Category of a sequence's name such as "Holding Hands 3", or None."""
    letters = re.sub(r"[^a-z]", "", name.lower())
    return next((action for action, start in ACTIONS.items() if letters.startswith(start)), None)


def sequences(folder):
    """[(file, category)] of the paper's selection, in a fixed order."""
    found = []
    for subject in SUBJECTS:
        for file in sorted((folder / "train" / subject / "smplx").glob("*.json")):
            action = action_of(file.stem)
            if action:
                found.append((file, action))
    return found


def sample_name(file, person):
    return f"{file.parent.parent.name}_{re.sub(r'[^A-Za-z0-9]+', '-', file.stem)}_{person}"


def people(document):
    """Parameters of frame 0 of both persons: CHI3D stores each as [person][frame]..."""
    if "betas" not in document or len(document["betas"]) != PEOPLE:
        raise ValueError("its 'betas' are not those of two persons")
    return [{key: value[person][0] for key, value in document.items()} for person in range(PEOPLE)]


def write_sample(folder, name, model, parameters):
    vertices, joints = model.pose(parameters)
    meshes.write_ply(folder / f"{name}.ply", vertices, model.faces)
    truth = {"frame": "scan", "unit": "m", "joints": {joint: joints[j].tolist() for j, joint in enumerate(SMPL)}}
    (folder / f"{name}.truth.json").write_text(json.dumps(truth))


def suite(options):
    found = avatars_if_present(options) if options.scans else []
    if not found:
        raise SystemExit("no CHI3D mesh found: make them with scripts/make_chi3d, then: scripts/benchmark chi3d DIR")
    return found


RIGHT_MM = 50  # of e_max; the paper drew its line by eye, at rank 619 of 746


def paper_table(tables, rows):
    """The paper's Table of surface-fit errors by segment, over the right registrations: mean +- standard deviation and maximum
    of all vertices together; median and 95th percentile as means over the scans. Both measures of the contract."""
    right = [r for r in rows if r["e_max"] < RIGHT_MM and r["registered"]]
    results = [json.loads(Path(r["registered"]).with_name("registration.json").read_text())["surface_error"] for r in right]
    for title, key in (("to scan points, the paper's measure", "segments"), ("to the scan's surface", "surface_segments")):
        lines = []
        for names in zip(*(result[key] for result in results)):
            seen = [s for s in names if s["mean_mm"] is not None]
            if not seen:
                continue
            count = sum(s["count"] for s in seen)
            mean = sum(s["count"] * s["mean_mm"] for s in seen) / count
            square = sum(s["count"] * (s["std_mm"] ** 2 + s["mean_mm"] ** 2) for s in seen) / count
            lines.append([names[0]["segment"], f"{mean:.2f} +- {math.sqrt(max(0, square - mean ** 2)):.2f}",
                          *(f"{sum(s[k] for s in seen) / len(seen):.2f}" for k in ("median_mm", "p95_mm")),
                          f"{max(s['max_mm'] for s in seen):.2f}"])
        tables.add(f"Surface-fit error by segment, mm, {title}: {len(right)} of {len(rows)} scans with e_max < {RIGHT_MM} mm",
                   ["segment", "mean +- sd", "median", "p95", "max"], lines)
