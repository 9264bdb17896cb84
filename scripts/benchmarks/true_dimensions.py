"""Dimensions of strangers against those of their true surface, from what suite scanner leaves behind.

The suite keeps where every template vertex truly lies (NAME.surface.ply). The difference to the fitted body, taken back
through the fitted pose to the rest pose, is written as vertex offsets; measured with them, the body is the true one, re-posed
like the fitted one and measured by the same program.
"""
import json
import subprocess

import numpy as np
from scipy.spatial.transform import Rotation

from . import meshes

# ISO 20685-1 by kind of dimension, mm, as cited in Anthropometry, Apparel Sizing and Design, p. 41:
# the 95 % confidence interval of the mean difference must lie within it.
LARGE_GIRTHS = ("chest", "bust", "waist", "hip", "upper_chest", "under_bust", "high_hip")
HAND = ("hand_",)
HEAD, FACE, FOOT = ("head_", "bitragion"), ("face_",), ("foot_",)


def allowed(name):
    """Largest allowed mean difference, mm. `name` without its side."""
    if name.startswith(HAND + FACE):
        return 1
    if name.startswith(HEAD + FOOT):
        return 2
    if "girth" in name:
        return 9 if name.startswith(LARGE_GIRTHS) else 4
    if "height" in name or name == "stature" or "breadth" in name:
        return 4
    return 5


def rest_offsets(body, parameters, truth_m):
    """[V,3]: what must be added to the shaped vertices at rest so that the posed body is `truth_m` (body frame)."""
    from body import correctives, posing
    shape = body.v + np.tensordot(np.array(parameters["betas"]), body.shapedirs[: len(parameters["betas"])], 1)
    turns = Rotation.from_rotvec(np.array(parameters["pose"]).reshape(-1, 3)).as_matrix()
    transforms = posing.skinning_transforms(body.regressor @ shape, turns)
    rest = correctives.corrected(shape, turns, *body.correctives)
    blended = (body.weights @ transforms.reshape(24, 12)).reshape(-1, 3, 4)
    moved = truth_m - np.array(parameters["translation_m"]) - blended[:, :, 3]
    return np.linalg.solve(blended[:, :, :3], moved[:, :, None])[:, :, 0] - rest


def measured(cli, registration, folder):
    """{(id, posture): row} of measurements.json."""
    subprocess.run([cli, "measure", registration, "--out", folder], check=True, stdout=subprocess.DEVNULL)
    rows = json.loads((folder / "measurements.json").read_text())["dimensions"]
    return {r["id"]: r for r in rows if r["posture"] == "standard"}


def differences(cli, body, suite, work):
    """[(name without side, scan, side, measured - true mm)], verdicts."""
    rows, verdicts = [], {}
    for registration in sorted(suite.glob("results/stand_*/registration.json")):
        name = registration.parent.name
        document = json.loads(registration.read_text())
        status = document["verdict"]["status"]
        verdicts[status] = verdicts.get(status, 0) + 1
        if not document["parameters"]:
            continue
        scan = meshes.read_ply(suite / "scans" / f"{name}.surface.ply")[0]
        body_from_scan = np.array(document["alignment"]["body_from_scan"])
        truth = scan @ body_from_scan[:3, :3].T + body_from_scan[:3, 3]
        folder = work / name
        folder.mkdir(parents=True, exist_ok=True)
        np.savez(folder / "offsets.npz", offsets=rest_offsets(body, document["parameters"], truth).astype("<f4"))
        document["parameters"]["offsets"] = "offsets.npz"
        (folder / "truth.json").write_text(json.dumps(document))
        truth = measured(cli, folder / "truth.json", folder)
        for key, row in measured(cli, registration, folder / "fit").items():
            if key in truth:
                plain = key.removesuffix("_" + row["side"]) if row["side"] else key
                rows.append((plain, name, row["side"], row["value_mm"] - truth[key]["value_mm"]))
    return rows, verdicts


def table(rows):
    """Markdown and {name: numbers}. The interval counts people, not sides: a person's sides are averaged for it."""
    lines = ["| dimension | mean | SD | largest | rms | 95 % interval of the mean | allowed | within |",
             "| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |"]
    summary = {}
    for name in dict.fromkeys(r[0] for r in rows):
        own = [r for r in rows if r[0] == name]
        values = np.array([r[3] for r in own])
        people = np.array([np.mean([r[3] for r in own if r[1] == person]) for person in dict.fromkeys(r[1] for r in own)])
        half = 1.96 * people.std(ddof=1) / np.sqrt(len(people))
        low, high, limit = people.mean() - half, people.mean() + half, allowed(name)
        summary[name] = {"mean_mm": values.mean(), "sd_mm": values.std(ddof=1), "max_mm": float(np.abs(values).max()),
                         "rms_mm": float(np.sqrt((values**2).mean())), "low_mm": low, "high_mm": high, "allowed_mm": limit,
                         "within": bool(low > -limit and high < limit)}
        s = summary[name]
        lines.append(f"| {name} | {s['mean_mm']:+.1f} | {s['sd_mm']:.1f} | {s['max_mm']:.1f} | {s['rms_mm']:.1f} | "
                     f"{low:+.1f} to {high:+.1f} | {limit} | {'yes' if s['within'] else 'no'} |")
    return "\n".join(lines), summary

