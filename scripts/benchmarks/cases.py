"""What a suite is made of: scans that are made when they are needed, each from its own seed."""
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
_MAKING = threading.RLock()  # one scan is made at a time: several cases may share it, and one may be made from another


@dataclass
class Case:
    """One scan. make(folder) writes NAME.ply and NAME.truth.json there (metres unless the truth says otherwise), and
    NAME.surface.ply where the true place of every template vertex is known."""

    name: str
    make: Callable[[Path], None]
    kind: str = ""  # rows are also tabled by kind
    hidden: tuple = ()  # core joints that the scan does not show
    arguments: tuple = ()  # options of the CLI that belong to the case
    source: str = field(default="")  # name of the scan's file, when several cases share one

    def files(self, folder):
        """(scan, truth, surface) as paths; made now unless they are there."""
        stem = self.source or self.name
        scan, truth, surface = (folder / f"{stem}{ending}" for ending in (".ply", ".truth.json", ".surface.ply"))
        with _MAKING:
            if not (scan.exists() and truth.exists()):
                folder.mkdir(parents=True, exist_ok=True)
                self.make(folder)
        return scan, truth, surface


def generator(*seeds):
    """Random numbers that depend on the given whole numbers alone."""
    return np.random.default_rng(list(seeds))


def spread(cases, limit):
    """At most `limit` cases: one out of each of `limit` equal runs, each time one place later, so that no regular order
    is sampled in step."""
    if not limit or limit >= len(cases):
        return cases
    run = len(cases) // limit
    return [cases[i * len(cases) // limit + i % run] for i in range(limit)]
