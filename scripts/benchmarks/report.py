"""One HTML file with a suite's tables, its success curve and pictures of its worst cases; needs nothing beside itself."""
import base64
import html
import io
import json
import math
from pathlib import Path

import numpy as np

from . import meshes, pictures

STYLE = """body{font:14px/1.4 sans-serif;margin:2em;max-width:75em}table{border-collapse:collapse;margin:.5em 0 1.5em}
td,th{padding:.15em .7em;text-align:right;border-bottom:1px solid #ddd}td:first-child,th:first-child{text-align:left}
figure{margin:1em 0}figcaption{color:#444}img{max-width:100%}"""


def curve(rows, width=560, height=240, end=200):
    """Share of scans with e_max below a threshold, over the threshold, as SVG."""
    values = sorted(r["e_max"] for r in rows)
    points, below = ["0,%d" % height], 0
    for value in values:
        if value > end:
            break
        x = width * value / end
        points.append(f"{x:.1f},{height * (1 - below / len(values)):.1f}")
        below += 1
        points.append(f"{x:.1f},{height * (1 - below / len(values)):.1f}")
    points.append(f"{width},{height * (1 - below / len(values)):.1f}")
    ticks = "".join(f'<text x="{width * t / end + 40}" y="{height + 28}" text-anchor="middle">{t}</text>' for t in range(0, end + 1, 50))
    sides = "".join(f'<text x="34" y="{height * (1 - s) + 14}" text-anchor="end">{100 * s:.0f}%</text>' for s in (0, 0.5, 1))
    return (f'<svg width="{width + 60}" height="{height + 50}" font-size="12"><g transform="translate(40,10)">'
            f'<rect width="{width}" height="{height}" fill="#f6f6f6"/><polyline fill="none" stroke="#1a5fb4" stroke-width="2" '
            f'points="{" ".join(points)}"/></g>{ticks}{sides}<text x="{width / 2 + 40}" y="{height + 46}" text-anchor="middle">'
            "e_max threshold, mm (failures counted in)</text></svg>")


def picture_of(row):
    """PNG of a row's scan and result, seen along the axes that the registration found."""
    scan = meshes.read_ply(row["file"])
    up, front, registered = (0, 1, 0), (0, 0, 1), None
    if row["registered"]:
        registered = meshes.read_ply(row["registered"])
        result = json.loads((Path(row["registered"]).parent / "registration.json").read_text())
        rotation = np.array(result["alignment"]["body_from_scan"])[:3, :3]
        up, front = rotation[1], rotation[2]
    return pictures.beside(scan, registered, up, front)


def figure(row):
    image = io.BytesIO()
    picture_of(row).save(image, "PNG", optimize=True)
    reasons = "; ".join(row.get("reasons", [])) or row.get("error", "")
    text = (f'{row["scan"]} {row["kind"]}: e_max {row["e_max"]:.0f} mm ({row.get("worst_joint", "no result")}), core_max '
            f'{row["core_max"]:.0f} mm, verdict {row["verdict"]}. {reasons}')
    data = base64.b64encode(image.getvalue()).decode()
    return f'<figure><img alt="" src="data:image/png;base64,{data}"><figcaption>{html.escape(text)}</figcaption></figure>'


def write(path, title, rows, tables, count=16):
    """The report with pictures of the `count` worst rows by e_max, without result first."""
    worst = sorted(rows, key=lambda r: -r["e_max"] if math.isfinite(r["e_max"]) else -math.inf)[:count]
    parts = [f"<!doctype html><meta charset=utf-8><title>{html.escape(title)}</title><style>{STYLE}</style><h1>{html.escape(title)}</h1>",
             curve(rows)]
    for heading, cells in tables.all:
        parts.append(f"<h2>{html.escape(heading)}</h2><table>")
        for k, row in enumerate(cells):
            tag = "td" if k else "th"
            parts.append("<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in row) + "</tr>")
        parts.append("</table>")
    parts.append("<h2>Worst cases: scan, result from the front; scan, result from the left</h2>")
    parts += [figure(row) for row in worst]
    path.write_text("\n".join(parts), encoding="utf-8")
