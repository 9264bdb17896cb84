"""What a body scanner makes of a surface: noise, and holes where no camera looks."""
import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from .skin_weights import smoothed
from .surface import vertex_normals

AZIMUTHS = np.radians(np.arange(0, 360, 45))
ELEVATIONS = np.radians([-8.0, 8.0])
PIXEL = 0.010
DEPTH_TOLERANCE = 0.018
MIN_COSINE = 0.25


def seen(vertices, faces):
    """Which vertices [V] at least one of sixteen cameras around the body sees. Y up, metres, parallel projection.

    The z-buffer holds vertices, so edges must not be much longer than PIXEL.
    """
    normals = vertex_normals(vertices, faces)
    out = np.zeros(len(vertices), bool)
    for azimuth in AZIMUTHS:
        for elevation in ELEVATIONS:
            toward = np.array(
                [np.sin(azimuth) * np.cos(elevation), np.sin(elevation), np.cos(azimuth) * np.cos(elevation)]
            )
            right = np.array([np.cos(azimuth), 0.0, -np.sin(azimuth)])
            up = np.cross(toward, right)
            depth = vertices @ toward
            column = np.floor(vertices @ right / PIXEL).astype(int)
            row = np.floor(vertices @ up / PIXEL).astype(int)
            cell = (row - row.min()) * (np.ptp(column) + 1) + column - column.min()
            front = np.full(cell.max() + 1, -np.inf)
            np.maximum.at(front, cell, depth)
            out |= (normals @ toward > MIN_COSINE) & (depth > front[cell] - DEPTH_TOLERANCE)
    return out


def with_holes(faces, visible):
    """Faces whose corners are all visible, without loose scraps; the visibility is evened out at the rims first."""
    share = smoothed(visible[:, None].astype(float), faces, np.full(len(visible), 0.5), 4)[:, 0]
    kept = faces[(share > 0.5)[faces].all(1)]
    edges = np.concatenate([kept[:, [0, 1]], kept[:, [1, 2]]])
    graph = sp.coo_matrix((np.ones(len(edges)), edges.T), shape=(len(visible), len(visible)))
    _, label = connected_components(graph, False)
    size = np.bincount(label[kept[:, 0]], minlength=label.max() + 1)
    return kept[size[label[kept[:, 0]]] > 0.02 * len(kept)]


def _lattice_noise(points, cell, rng):
    """Noise [P] of unit variance over space: normal values on a lattice of the given cell size, interpolated."""
    low = np.floor(points.min(0) / cell).astype(int)
    values = rng.normal(size=np.ceil(points.max(0) / cell).astype(int) - low + 2)
    place = points / cell - low
    corner = np.floor(place).astype(int)
    t = place - corner
    total, power = np.zeros(len(points)), np.zeros(len(points))
    for offset in np.ndindex(2, 2, 2):
        share = np.prod(np.where(offset, t, 1 - t), 1)
        total += share * values[tuple((corner + offset).T)]
        power += share**2
    return total / np.sqrt(power)


def noisy(vertices, faces, deviation, rng):
    """Vertices moved along their normals: a quarter of the variance at 4 mm, the rest in waves of some 2 cm."""
    amount = 0.5 * _lattice_noise(vertices, 0.004, rng) + np.sqrt(0.75) * _lattice_noise(vertices, 0.016, rng)
    return vertices + deviation * amount[:, None] * vertex_normals(vertices, faces)
