"""Dimensions of strangers against those of their true surface, on the scans that suite scanner leaves behind.

The suite keeps where every template vertex truly lies in the scan (NAME.surface.ply). Taken back through the fitted pose and
written as vertex offsets, that surface is re-posed like the fitted body and measured by the same program. The differences hold
the error of the surface and the slide of landmarks along the skin, not the error of re-posing itself.

Hands are compared with the stranger's own open hand in the model's T-pose (strangers.rest_surface): in many scans they are
fists or fused, and a hand is measured stretched.
"""
import json
import subprocess
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from . import meshes, strangers
from .strangers import correctives, posing, shape_space, surface

# ISO 20685-1 by kind of dimension, mm, as cited in Anthropometry, Apparel Sizing and Design, p. 41:
# the 95 % confidence interval of the mean difference must lie within it.
LARGE_GIRTHS = ("chest", "bust", "waist", "hip", "upper_chest", "under_bust", "high_hip")
HAND = ("hand_",)
# Measured on the open hand.
OPEN_HAND = ("hand_", "forearm_fingertip")
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


def measured(cli, registration, folder):
    """{id: row} of measurements.json, standing and sitting; measured once."""
    found = folder / "measurements.json"
    if not found.exists() or found.stat().st_mtime < max(Path(each).stat().st_mtime for each in (cli, registration)):
        subprocess.run([cli, "measure", registration, "--out", folder], check=True, stdout=subprocess.DEVNULL)
    rows = json.loads(found.read_text())["dimensions"]
    return {r["id"]: r for r in rows if r["posture"] == "standard"}


def plain(row):
    """A dimension's id without its side."""
    return row["id"].removesuffix("_" + row["side"]) if row["side"] else row["id"]


def rest_offsets(body, parameters, truth_m):
    """[V,3]: what must be added to the shaped vertices at rest so that the posed body is `truth_m` (body frame)."""
    shape = body.v + np.tensordot(np.array(parameters["betas"]), body.shapedirs, 1)
    turns = Rotation.from_rotvec(np.array(parameters["pose"]).reshape(-1, 3)).as_matrix()
    transforms = posing.skinning_transforms(body.regressor @ shape, turns)
    rest = correctives.corrected(shape, turns, *body.correctives)
    blended = (body.weights @ transforms.reshape(24, 12)).reshape(-1, 3, 4)
    moved = truth_m - np.array(parameters["translation_m"]) - blended[:, :, 3]
    return np.linalg.solve(blended[:, :, :3], moved[:, :, None])[:, :, 0] - rest


def rest_parameters(body, suite, name):
    """(shape and pose, offsets) of a scan's stranger in the T-pose, the shape the nearest one of the model."""
    kept = suite / "scans" / f"{name}.rest.npy"
    if not kept.exists():
        person = int(name.removeprefix("stand_"))
        np.save(kept, strangers.rest_surface(person, body, np.load(suite / "scans" / "template_skin.npy")))
    rest = np.load(kept)
    betas = shape_space.coefficients(rest[None], body.v, body.shapedirs, surface.vertex_areas(body.v, body.faces))[0]
    parameters = {"betas": betas.tolist(), "pose": [0.0] * 72, "translation_m": [0, 0, 0]}
    return parameters, rest - body.v - np.tensordot(betas, body.shapedirs, 1)


def measured_with(cli, folder, document, parameters, offsets):
    """{id: row} of a body given by parameters and vertex offsets. document: a registration, for the rest."""
    folder.mkdir(parents=True, exist_ok=True)
    np.savez(folder / "offsets.npz", offsets=offsets.astype("<f4"))
    path, text = folder / "truth.json", json.dumps(document | {"parameters": parameters | {"offsets": "offsets.npz"}})
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
    return measured(cli, path, folder)


def true_rows(cli, body, suite, name, document, work):
    """{id: row} of the true surface of a scan's stranger."""
    scan = meshes.read_ply(suite / "scans" / f"{name}.surface.ply")[0]
    body_from_scan = np.array(document["alignment"]["body_from_scan"])
    truth = scan @ body_from_scan[:3, :3].T + body_from_scan[:3, 3]
    parameters = document["parameters"]
    rows = measured_with(cli, work / "surface", document, parameters, rest_offsets(body, parameters, truth))
    at_rest = measured_with(cli, work / "rest", document, *rest_parameters(body, suite, name))
    return rows | {key: row for key, row in at_rest.items() if key.startswith(OPEN_HAND)}


def registrations(cli, suite, detail):
    """Those of the standing; with detail made from the suite's by refining them vertex by vertex, unless they are there."""
    for known in sorted(suite.glob("results/stand_*/registration.json")):
        if not detail:
            yield known
            continue
        name = known.parent.name
        refined = suite / "results_detail" / name / "registration.json"
        if not refined.exists():
            subprocess.run([cli, "register", suite / "scans" / f"{name}.ply", "--out", suite / "results_detail", "--init", known,
                            "--detail", "vertex", "--quiet"])
        if refined.exists():
            yield refined


def differences(cli, body, suite, work, detail=False):
    """[(id without side, scan, side, measured - true mm, mean distance to the scan there mm or None)], verdicts."""
    rows, verdicts = [], {}
    for registration in registrations(cli, suite, detail):
        name = registration.parent.name
        document = json.loads(registration.read_text())
        status = document["verdict"]["status"]
        verdicts[status] = verdicts.get(status, 0) + 1
        if not document["parameters"]:
            continue
        truth = true_rows(cli, body, suite, name, document, work / name)
        for key, row in measured(cli, registration, work / name / "fit").items():
            if key in truth:
                rows.append((plain(row), name, row["side"], row["value_mm"] - truth[key]["value_mm"], row["fit_error_mm"]))
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
        fit = [r[4] for r in own if r[4] is not None]
        summary[name] = {"mean_mm": values.mean(), "sd_mm": values.std(ddof=1), "max_mm": float(np.abs(values).max()),
                         "rms_mm": float(np.sqrt((values**2).mean())), "low_mm": low, "high_mm": high, "allowed_mm": limit,
                         "within": bool(low > -limit and high < limit), "fit_mm": float(np.mean(fit))}
        s = summary[name]
        lines.append(f"| {name} | {s['mean_mm']:+.1f} | {s['sd_mm']:.1f} | {s['max_mm']:.1f} | {s['rms_mm']:.1f} | "
                     f"{low:+.1f} to {high:+.1f} | {limit} | {'yes' if s['within'] else 'no'} |")
    return "\n".join(lines), summary


def source(parametric, refined, people):
    """The C++ table that each value's uncertainty comes from."""
    def size(summary):
        return f"{{{summary['rms_mm']:.2f}, {summary['fit_mm']:.2f}}}"

    rows = "".join(f'    DimensionError{{"{name}", {size(parametric[name])}, {size(refined[name])}}},\n'
                   for name in sorted(parametric) if name in refined)
    return f"""// Made by `scripts/measurement_error --scanner FOLDER --source FILE` from scans of {people} people; not to be edited.
#include "anthropometry/dimension_errors.h"

#include <array>

namespace vitruvian {{
namespace {{

constexpr std::array kErrors = {{
    // clang-format off
{rows}    // clang-format on
}};

}}  // namespace

std::span<const DimensionError> dimension_errors() {{ return kErrors; }}

}}  // namespace vitruvian
"""
