"""A cohort of small scans made from the sample scan: the same person at many sizes, each standing elsewhere."""
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from benchmarks.meshes import read_ply, write_ply  # noqa: E402  (found through the path above)

SAMPLE = ROOT / "models" / "generated" / "sample.ply"


def decimated(vertices, faces, cell):
    """Vertices of one cell of a grid become one; triangles that collapse go."""
    _, first, cluster = np.unique(np.floor(vertices / cell), axis=0, return_index=True, return_inverse=True)
    coarse = cluster[faces]
    kept = (coarse[:, 0] != coarse[:, 1]) & (coarse[:, 1] != coarse[:, 2]) & (coarse[:, 2] != coarse[:, 0])
    return vertices[first], np.unique(coarse[kept], axis=0).astype(np.int32)


def write_cohort(folder, count):
    """Writes `count` scans below `folder`, half of them in a subfolder; returns [(path, size relative to the sample)]."""
    vertices, faces = decimated(*read_ply(SAMPLE), cell=14.0)
    scans = []
    for k in range(count):
        size = 0.92 + 0.16 * k / max(count - 1, 1)
        angle = 2 * np.pi * k / count
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        # Every folder has a scan of the same name, as labs do it.
        path = pathlib.Path(folder) / f"subject {k + 1:02}" / "scan.ply" if k % 2 else pathlib.Path(folder) / f"{k + 1:02}.ply"
        path.parent.mkdir(parents=True, exist_ok=True)
        write_ply(path, size * vertices @ turn.T + [100.0 * k, 0, 0], faces)
        scans.append((path, size))
    return scans
