#!/usr/bin/python3
"""The list of a cohort's scans, and the table of its results. Needs nothing but Python 3.9.

usage: cohort.py list FOLDER > scans.tsv     a line a scan: an ID, a tab, the file's path
       cohort.py merge scans.tsv OUT         OUT/cohort.csv: a row a scan; OUT/measurements.csv: a row a measurement

cohort.csv: id, scan, verdict (ok, doubtful, failed; error: could not be registered; missing: did not end yet), confidence,
reasons (or the error's message), unit, vertices, errors in mm of the surface and of the scan, seconds, body volume and mass, then
each dimension in mm in the standing posture. NA where nothing is known. Exit status of merge: 1 if a scan is missing.
"""
import csv
import json
import os
import re
import sys

FORMATS = (".ply", ".obj", ".stl", ".off", ".glb", ".gltf", ".xyz", ".pts", ".pcd")
FACTS = ("id", "scan", "verdict", "confidence", "reasons", "unit", "vertices", "surface_mean_mm", "surface_median_mm",
         "surface_p95_mm", "surface_max_mm", "scan_mean_mm", "scan_p95_mm", "seconds", "volume_cm3", "mass_kg")


def scans_below(folder):
    """[(id, path)]: the path below the folder without the format's ending, as a name that can be a folder's."""
    found = {}
    for place, folders, files in os.walk(folder):
        folders.sort()
        for name in sorted(files):
            stem = re.sub(r"\.gz$", "", name, flags=re.I)
            base, ending = os.path.splitext(stem)
            if ending.lower() not in FORMATS or name.startswith("."):
                continue
            path = os.path.abspath(os.path.join(place, name))
            if "\t" in path or "\n" in path:
                raise SystemExit(f"{path!r}: a path with a tab or a line end cannot be listed: rename it")
            own = re.sub(r"[^A-Za-z0-9._+@=-]", "-", os.path.relpath(os.path.join(place, base), folder).replace(os.sep, "__"))
            own = own if own[0].isalnum() else "s" + own
            if own in found:
                raise SystemExit(f"{found[own]} and {path} would both be called {own}: rename one")
            found[own] = path
    return list(found.items())


def read_list(path):
    rows, seen = [], set()
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        for number, line in enumerate(file, 1):
            own, tab, scan = line.rstrip("\n").partition("\t")
            if not tab or not own or not scan:
                raise SystemExit(f"{path}, line {number}: not an ID, a tab and a path")
            if own in seen:
                raise SystemExit(f"{path}, line {number}: the ID {own} was given before")
            seen.add(own)
            rows.append((own, scan))
    return rows


def read_json(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise SystemExit(f"{path}: cannot be read: {error}")


def facts_of(own, scan, status, registration, measurements):
    """The row of one scan without its dimensions."""
    facts = dict.fromkeys(FACTS)
    facts.update(id=own, scan=scan, verdict="missing", reasons="not registered yet, or the job was stopped")
    if status is None:
        return facts
    if registration is None or status["outcome"] != "registered":
        facts.update(verdict="error", reasons=status["message"] or f"exit status {status['exit_status']}")
        return facts
    verdict, error = registration["verdict"], registration.get("surface_error") or {}
    facts.update(verdict=verdict["status"], confidence=verdict["confidence"], reasons="; ".join(verdict["reasons"]))
    facts.update(unit=registration["scan"]["unit"], vertices=registration["scan"]["vertices"])
    for measure, name in (("surface_all", "surface"), ("scan_to_model", "scan")):
        for which in ("mean", "median", "p95", "max"):
            column = f"{name}_{which}_mm"
            if column in facts:
                facts[column] = (error.get(measure) or {}).get(f"{which}_mm")
    facts["seconds"] = round(registration["timing_ms"]["total"] / 1000, 3)
    if measurements:
        facts.update(volume_cm3=measurements["body"]["volume_cm3"], mass_kg=measurements["body"].get("mass_kg"))
    return facts


def write_csv(path, header, rows):
    """Whole or not at all."""
    partial = f"{path}.{os.getpid()}.part"
    with open(partial, "w", newline="", encoding="utf-8", errors="surrogateescape") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for row in rows:
            writer.writerow("NA" if value is None else value for value in row)
    os.replace(partial, path)


def merge(list_path, out):
    os.makedirs(out, exist_ok=True)
    scans, dimension_rows, names = [], [], []
    for own, scan in read_list(list_path):
        folder = os.path.join(out, "scans", own)
        status = read_json(os.path.join(folder, "status.json"))
        registration = read_json(os.path.join(folder, "registration.json")) if status else None
        measurements = read_json(os.path.join(folder, "measurements.json")) if status else None
        standing = {}
        for d in (measurements or {}).get("dimensions", []):
            dimension_rows.append((own, d["id"], d["standard"], d["side"], d["posture"], d["value_mm"], d["uncertainty_mm"]))
            if d["posture"] == "standard":
                standing[d["id"] + "_mm"] = d["value_mm"]
        names.extend(name for name in standing if name not in names)
        scans.append((facts_of(own, scan, status, registration, measurements), standing))
    write_csv(os.path.join(out, "cohort.csv"), [*FACTS, *names],
              ([*facts.values(), *(standing.get(name) for name in names)] for facts, standing in scans))
    write_csv(os.path.join(out, "measurements.csv"),
              ["id", "dimension", "standard", "side", "posture", "value_mm", "uncertainty_mm"], dimension_rows)
    counts = {}
    for facts, _ in scans:
        counts[facts["verdict"]] = counts.get(facts["verdict"], 0) + 1
    print(f"{len(scans)} scans: " + ", ".join(f"{n} {verdict}" for verdict, n in sorted(counts.items())))
    return 1 if "missing" in counts else 0


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "list":
        if not os.path.isdir(arguments[1]):
            raise SystemExit(f"{arguments[1]}: not a folder")
        for own, path in scans_below(arguments[1]):
            sys.stdout.buffer.write(os.fsencode(f"{own}\t{path}\n"))
        return 0
    if len(arguments) == 3 and arguments[0] == "merge":
        return merge(arguments[1], arguments[2])
    print(__doc__.strip(), file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
