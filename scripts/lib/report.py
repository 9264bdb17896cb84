"""Prints a registration's report: verdict, alignment, error table, times.

usage: report.py FOLDER   (a folder that `vitruvian register` wrote)
"""
import csv
import json
import pathlib
import sys


def main():
    folder = pathlib.Path(sys.argv[1])
    result = json.loads((folder / "registration.json").read_text())
    scan, alignment, verdict = result["scan"], result["alignment"], result["verdict"]
    print(f"scan      {scan['file']}: {scan['vertices']} vertices, {scan['faces']} faces, unit {scan['unit']}")
    if alignment:
        print(f"alignment up {alignment['up']}, front {alignment['front']} ({alignment['method']})")
    print(f"verdict   {verdict['status']}, confidence {verdict['confidence']:.2f}")
    for reason in verdict["reasons"]:
        print(f"          {reason}")
    table = folder / "errors.csv"
    if table.exists():
        print("distance from the body to the scan's surface, mm")
        for row in csv.reader(table.open()):
            print("  " + f"{row[0]:18}" + "".join(f"{shortened(cell):>11}" for cell in row[1:]))
    times = ", ".join(f"{stage} {value:.0f}" for stage, value in result["timing_ms"].items() if value)
    print(f"time, ms  {times}")


def shortened(cell):
    try:
        return cell if cell.isdigit() else f"{float(cell):.2f}"
    except ValueError:
        return cell


if __name__ == "__main__":
    main()
