"""Suites of scans that lie ready, and of one scan run in several ways: avatars, ablation."""
import dataclasses
from pathlib import Path

from . import own_body
from .cases import ROOT, Case

# Starts and views of the published method, beside ours.
WAYS = {"ours": (), "T-pose start": ("--init", "tpose"), "2 views": ("--views", "2")}


@dataclasses.dataclass
class Ready(Case):
    """A scan that lies in a folder with its truth."""

    def files(self, folder):
        scan = Path(self.source)
        return scan, scan.with_name(scan.stem + ".truth.json"), scan.with_name(scan.stem + ".surface.ply")


def avatars_if_present(options):
    folder = Path(options.scans or ROOT.parent / "shared/data/avatars")
    scans = [p for p in sorted(folder.glob("*.ply")) if p.with_name(p.stem + ".truth.json").exists()]
    return [Ready(p.stem, lambda folder: None, source=str(p)) for p in scans]


def avatars(options):
    found = avatars_if_present(options)
    if not found:
        raise SystemExit("no scan with a truth file found: give --scans DIR")
    return found


def ablation(options):
    """The scans of `poses`, each in every way: as ours, from a T-pose, with the two published views."""
    return [dataclasses.replace(case, name=f"{case.name}_{way.replace(' ', '_')}", kind=way, arguments=arguments, source=case.name)
            for case in own_body.poses(options) for way, arguments in WAYS.items()]
