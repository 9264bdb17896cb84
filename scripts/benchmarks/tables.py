"""Tables of a suite's rows, printed and kept for the report."""
import math

import numpy as np

THRESHOLDS_MM = (10, 20, 30, 50, 75, 100, 150, 200, 300)
WRONG_MM = 150  # of core_max: a limb in the wrong place by anyone's definition
STAGES = ("read", "align", "project", "detect", "pose", "fit", "refine", "detail", "write", "total")
VERDICTS = ("ok", "doubtful", "failed", "none")


def percentile(values, share):
    """Smallest value that at least `share` of the values do not exceed."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]


def spread(values):
    return [percentile(values, 0.5), percentile(values, 0.95), max(values)] if values else [math.nan] * 3


def wilson(right, count, z=1.96):
    """95 % interval of a share (Wilson 1927)."""
    if not count:
        return 0.0, 1.0
    p = right / count
    centre, half = p + z * z / (2 * count), z * math.sqrt(p * (1 - p) / count + z * z / (4 * count * count))
    return max(0.0, (centre - half) / (1 + z * z / count)), min(1.0, (centre + half) / (1 + z * z / count))


def share(right, count):
    low, high = wilson(right, count)
    return f"{100 * right / max(1, count):.1f} % ({100 * low:.0f}-{100 * high:.0f})"


class Tables:
    """Prints each table as it comes and keeps all for the report."""

    def __init__(self):
        self.all = []

    def add(self, title, heading, rows):
        def cell(value):
            return value if isinstance(value, str) else f"{value:.1f}" if isinstance(value, float) else str(value)

        cells = [heading] + [[cell(v) for v in row] for row in rows]
        self.all.append((title, cells))
        widths = [max(len(row[c]) for row in cells) for c in range(len(heading))]
        print(f"\n{title}")
        for row in cells:
            print("  " + "  ".join(row[c].ljust(widths[c]) if c == 0 else row[c].rjust(widths[c]) for c in range(len(row))))


def success(tables, rows):
    tables.add("Success: share of scans whose largest joint error is below", ["measure"] + [f"{t} mm" for t in THRESHOLDS_MM],
               [[name] + [f"{100 * np.mean([r[key] < t for r in rows]):.1f} %" for t in THRESHOLDS_MM]
                for name, key in (("e_max, 22 joints, pelvis aligned", "e_max"), ("core_max, 12 joints, mean removed", "core_max"))])


def overview(tables, rows):
    lines = [[name] + spread([r[key] for r in rows]) for name, key in (("e_max mm", "e_max"), ("core_max mm", "core_max"))]
    for name, key in (("surface_all mean mm", "surface_mm"), ("  without what the scan does not show mm", "seen_surface_mm"),
                      ("scan_to_model mean mm", "scan_to_model_mm"),
                      ("all mean mm (the paper's, to points)", "point_mm"), ("  its sampling floor mm", "floor_all_mm"),
                      ("correspondence error mean mm", "correspondence_all_mm"),
                      ("wall time s", "seconds"), ("peak memory MB", "memory_mb")):
        values = [r[key] for r in rows if key in r]
        if values:
            lines.append([name if len(values) == len(rows) else f"{name} (of {len(values)})"] + spread(values))
    timed = [r["timing_ms"]["total"] / 1e3 for r in rows if "timing_ms" in r]
    if timed:
        lines.append(["time inside the program s"] + spread(timed))
    tables.add("Over all scans", ["", "median", "p95", "max"], lines)


def verdicts(tables, rows):
    tables.add(f"Verdict against truth (wrong: core_max >= {WRONG_MM} mm)", ["", *VERDICTS],
               [[name] + [sum(r["verdict"] == v and (r["core_max"] < WRONG_MM) == right for r in rows) for v in VERDICTS]
                for name, right in (("right", True), ("wrong", False))])


def segments(tables, rows):
    """Mean over the scans, right ones only, as the paper's tables do; wrong fits would drown every segment."""
    right = [r for r in rows if r["core_max"] < WRONG_MM and "surface_segments_mm" in r]
    if not right:
        return
    columns = [("surface mm", "surface_segments_mm"), ("points mm", "point_segments_mm"), ("floor of points mm", "floor_mm"),
               ("correspondence mm", "correspondence_mm")]
    columns = [(title, key) for title, key in columns if any(key in r for r in right)]
    lines = []
    for name in right[0]["surface_segments_mm"]:
        line = [name, sum(r["surface_segments_mm"][name] is not None for r in right)]
        for _, key in columns:
            values = [r[key][name] for r in right if r.get(key, {}).get(name) is not None]
            line += [f"{np.mean(values):.2f} +- {np.std(values):.2f}" if values else "NA"]
        lines.append(line)
    tables.add(f"Errors by segment, mean +- standard deviation over the {len(right)} right scans", ["segment", "scans"] +
               [title for title, _ in columns], lines)


def kinds(tables, rows):
    names = list(dict.fromkeys(r["kind"] for r in rows))
    if len(names) < 2:
        return
    lines = []
    for name in names:
        own = [r for r in rows if r["kind"] == name]
        values = [r.get("seen_surface_mm", r["surface_mm"]) for r in own if "surface_mm" in r]
        lines.append([name, len(own), share(sum(r["e_max"] < 50 for r in own), len(own)),
                      share(sum(r["core_max"] < 100 for r in own), len(own)), share(sum(r["core_max"] < 150 for r in own), len(own)),
                      percentile([r["core_max"] for r in own], 0.5), percentile(values, 0.5) if values else math.nan,
                      percentile([r["seconds"] for r in own], 0.5), sum(r["verdict"] == "ok" for r in own)])
    tables.add("By kind (95 % intervals)", ["kind", "scans", "e_max < 50 mm", "core_max < 100 mm", "core_max < 150 mm",
                                            "core_max median", "surface (seen) median", "s median", "ok"], lines)


def times(tables, rows):
    for size in ("14k", "1M"):
        own = [r for r in rows if r["kind"] == size]
        timed = [r for r in own if "timing_ms" in r]
        lines = [[stage] + spread([r["timing_ms"][stage] for r in timed]) for stage in STAGES]
        lines.append(["process, wall"] + spread([1e3 * r["seconds"] for r in own]))
        tables.add(f"Times (ms), {size} vertices, {len(own)} scans, {len(own) - len(timed)} without result",
                   ["stage", "median", "p95", "max"], lines)
        tables.add(f"Peak memory (MB), {size} vertices", ["", "median", "p95", "max"],
                   [["process"] + spread([r["memory_mb"] for r in own])])


def orientations(tables, rows):
    tables.add("By unit", ["unit", "scans", "right", "unit found", "verdict ok"],
               [[unit, len(own), sum(r["core_max"] < WRONG_MM for r in own), sum(r.get("unit") == unit for r in own),
                 sum(r["verdict"] == "ok" for r in own)]
                for unit, own in ((u, [r for r in rows if r["kind"] == u]) for u in ("m", "cm", "mm", "in"))])
