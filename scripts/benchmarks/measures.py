"""Runs the CLI on one scan and measures what comes out against what is known."""
import json
import math
import os
import shlex
import subprocess
import time
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from . import meshes

CORE = [f"{side}_{joint}" for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle") for side in ("left", "right")]
SMPL = ("pelvis left_hip right_hip spine1 left_knee right_knee spine2 left_ankle right_ankle spine3 left_foot right_foot "
        "neck left_collar right_collar head left_shoulder right_shoulder left_elbow right_elbow left_wrist "
        "right_wrist").split()
MM = {"m": 1000.0, "cm": 10.0, "mm": 1.0, "in": 25.4}


def joint_errors(found, truth, hidden=()):
    """{joint: mm after aligning the pelvises}, and core_max: the largest of the core joints that are not hidden after
    removing their mean offset, mm. found: registration.json."""
    mm = MM[truth["unit"]]
    known = {n: np.array(p) for n, p in truth["joints"].items()}
    difference = {j["name"]: (np.array(j["scan"]) - known[j["name"]]) * mm for j in found["joints"] if j["name"] in known}
    core = np.array([difference[n] for n in CORE if n in difference and n not in hidden])
    aligned = {n: float(np.linalg.norm(difference[n] - difference["pelvis"])) for n in SMPL if n in difference}
    return aligned, float(np.linalg.norm(core - core.mean(0), axis=1).max())


def by_segment(table, key="mean_mm"):
    """{segment: value or None} of one of registration.json's tables."""
    return {row["segment"]: row[key] for row in table}


def by_segment_mean(rows, key, name):
    """Mean of one segment's values in rows[...][key], those that were not seen left out; NaN when none was."""
    values = [row[key][name] for row in rows if row[key][name] is not None]
    return float(np.mean(values)) if values else math.nan


def true_surface(surface, scan, registered, unit, segments, observed):
    """Correspondence error by segment (registered template vertex to where that vertex truly is), and the sampling floor
    of the paper's point measure (true template vertex to the nearest scan point), both means in mm. segments (V)."""
    truth, _ = meshes.read_ply(surface)
    points, _ = meshes.read_ply(scan)
    mm = MM[unit]
    floor = cKDTree(points).query(truth)[0] * mm
    names = [name for name, seen in observed.items() if seen is not None]

    def means(values):
        rows = {}
        for k, name in enumerate(observed):
            if name in names:
                rows[name] = float(values[segments == k].mean())
        return rows

    out = {"floor_mm": means(floor), "floor_all_mm": float(floor.mean())}
    if registered is not None:
        error = np.linalg.norm(meshes.read_ply(registered)[0] - truth, axis=1) * mm
        out.update(correspondence_mm=means(error), correspondence_all_mm=float(error.mean()))
    return out


def run(case, options, segments):
    """Registers a case's scan in a process of its own; the row of what came out."""
    scan, truth_file, surface = case.files(options.out / "scans")
    results = options.out / "results"
    if case.source:  # several runs of one scan: each into a folder of its own
        results = results / case.kind.replace(" ", "_")
    command = [options.cli, "register", str(scan), "--out", str(results), "--quiet", *case.arguments, *shlex.split(options.args)]
    if options.jobs > 1 and "--threads" not in options.args:
        command += ["--threads", str(max(1, os.cpu_count() // options.jobs))]
    row = {"scan": case.name, "kind": case.kind, "e_max": math.inf, "core_max": math.inf, "verdict": "none",
           "file": str(scan), "registered": None, "settings": " ".join(command[4:])}
    log = options.out / f"{case.name}.stderr"
    began = time.monotonic()
    with open(log, "w") as error:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=error)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    row.update(exit=process.returncode, seconds=time.monotonic() - began, cpu_seconds=usage.ru_utime + usage.ru_stime,
               memory_mb=usage.ru_maxrss / 1024)
    try:
        row["result"] = str(results / scan.stem / "registration.json")
        result = json.loads(Path(row["result"]).read_text())
        truth = json.loads(truth_file.read_text())
        human = bool(truth["joints"])
        row.update(verdict=result["verdict"]["status"], confidence=result["verdict"]["confidence"],
                   reasons=result["verdict"]["reasons"], timing_ms=result["timing_ms"], version=result["vitruvian"],
                   unit=result["scan"]["unit"], vertices=result["scan"]["vertices"])
        error = result["surface_error"]
        if error is not None:
            row.update(surface_mm=error["surface_all"]["mean_mm"], point_mm=error["all"]["mean_mm"],
                       scan_to_model_mm=error["scan_to_model"]["mean_mm"],
                       surface_segments_mm=by_segment(error["surface_segments"]), point_segments_mm=by_segment(error["segments"]))
            features = result["verdict"].get("features")
            if features:
                row["seen_surface_mm"] = features["model_to_scan_mean_mm"]  # without what the scan cannot show
        mesh = results / scan.stem / "registered.ply"
        if process.returncode in (0, 1) and row["verdict"] != "failed" and mesh.exists():
            row["registered"] = str(mesh)
        if human and result["joints"]:
            joints, core_max = joint_errors(result, truth, case.hidden)
            # Whatever the verdict: the study of the verdict asks the truth.
            row["true_error"] = {"e_max": max(joints.values()), "core_max": core_max}
            if row["registered"]:
                row.update(joints_mm=joints, e_max=max(joints.values()), core_max=core_max, worst_joint=max(joints, key=joints.get))
        if surface.exists() and segments is not None and error is not None:
            row.update(true_surface(surface, scan, row["registered"], truth["unit"], segments, row["surface_segments_mm"]))
    except (OSError, KeyError, ValueError, TypeError) as problem:
        row["error"] = f"{type(problem).__name__}: {problem}; {log.read_text().strip()[-200:]}"
    if log.stat().st_size == 0:
        log.unlink()
    return row
