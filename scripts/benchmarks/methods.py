"""Suite methods: the same scans by the published method and by ours, and what the published one costs more."""
import dataclasses
import statistics

from . import own_body, strangers
from .cases import spread
from .measures import by_segment_mean
from .tables import percentile, share

POSES, SCANS = 20, 5
OURS, KD_TREE, BLOCKS = "fast", "paper 60", "paper 60 blockwise"
# As published; with its settings for CPUs; ours. Then, for the price of an iteration alone, few of them with nearest
# neighbours from kd-trees and by the published blockwise brute force.
METHODS = {OURS: (), "paper-cpu": ("--method", "paper-cpu"), "paper": ("--method", "paper")}
SHORT = {KD_TREE: ("--method", "paper", "--iterations", "60"),
         BLOCKS: ("--method", "paper", "--iterations", "60", "--chunk", "512")}
SHORT_SCANS = 2
RIGHT_MM = {"poses": ("e_max", 50), "scanner": ("core_max", 100)}  # which joint error, below what


def methods(options):
    """Scan by scan, each by all methods, so that a run that was stopped holds whole comparisons of both kinds."""
    scans = [("poses", case) for case in spread(own_body.poses(options), POSES)]
    for k, case in enumerate(spread(strangers.scanner_suite(options), SCANS)):
        scans.insert((k + 1) * (POSES // SCANS + 1) - 1, ("scanner", case))
    if options.limit:
        scans = spread(scans, options.limit)
        options.limit = 0
    return [dataclasses.replace(case, name=f"{case.name}_{way.replace(' ', '_')}", kind=f"{suite} {way}", arguments=arguments,
                                source=case.name)
            for k, (suite, case) in enumerate(scans)
            for way, arguments in {**METHODS, **(SHORT if k < SHORT_SCANS else {})}.items()]


def right(row):
    measure, limit = RIGHT_MM[row["kind"].split()[0]]
    return row[measure] < limit


def ratios(rows, one, other, value):
    """value(row of `one`) / value(row of `other`), scan by scan."""
    by_scan = {(r["file"], r["kind"].split(" ", 1)[1]): r for r in rows}
    found = []
    for (file, way), row in by_scan.items():
        partner = by_scan.get((file, other))
        if way == one and partner and "timing_ms" in row and "timing_ms" in partner:
            found.append(value(row) / value(partner))
    return found


def table(tables, rows):
    whole = [r for r in rows if r["kind"].split(" ", 1)[1] in METHODS]
    lines = []
    for kind in dict.fromkeys(r["kind"] for r in whole):
        own = [r for r in whole if r["kind"] == kind]
        good = [r for r in own if right(r)]
        measure = RIGHT_MM[kind.split()[0]][0]
        lines.append([kind, share(len(good), len(own)), measure, percentile([r[measure] for r in own], 0.5),
                      *(statistics.mean(r[key] for r in good) if good else float("nan") for key in ("point_mm", "surface_mm")),
                      *(percentile([r[key] for r in own], 0.5) for key in ("cpu_seconds", "seconds"))])
    tables.add("Methods (errors: means over the right registrations)",
               ["", "right", "measure", "median mm", "points mm", "surface mm", "CPU s median", "wall s median"], lines)

    lines = []
    for one, other, what, value in (
            ("paper", OURS, "whole run, CPU time", lambda r: r["cpu_seconds"]),
            ("paper-cpu", OURS, "whole run, CPU time", lambda r: r["cpu_seconds"]),
            ("paper", OURS, "fit and refine, wall time", lambda r: r["timing_ms"]["fit"] + r["timing_ms"]["refine"]),
            ("paper-cpu", OURS, "fit and refine, wall time", lambda r: r["timing_ms"]["fit"] + r["timing_ms"]["refine"]),
            (BLOCKS, KD_TREE, "whole run, CPU time", lambda r: r["cpu_seconds"]),
            (BLOCKS, KD_TREE, "distance minimisation, wall time", lambda r: r["timing_ms"]["fit"])):
        found = ratios(rows, one, other, value)
        if found:
            lines.append([f"{one} / {other}: {what}", len(found), percentile(found, 0.5), min(found), max(found)])
    tables.add("Time ratios, scan by scan", ["", "scans", "median", "least", "most"], lines)

    ways = [way for way in METHODS if any(r["kind"].endswith(" " + way) for r in whole)]
    for key, title in (("point_segments_mm", "to scan points, the paper's measure"), ("surface_segments_mm", "to the scan's surface")):
        good = {way: [r for r in whole if r["kind"].endswith(" " + way) and right(r) and key in r] for way in ways}
        names = next((list(r[key]) for r in whole if key in r), [])
        tables.add(f"Surface-fit error by segment, mean mm, {title}, over each method's right registrations",
                   ["segment"] + [f"{way} ({len(good[way])})" for way in ways],
                   [[name] + [by_segment_mean(good[way], key, name) for way in ways] for name in names])
