"""Scans of what is no human being: boxes, cylinders, balls, lumps, furniture, four-legged animals, trees."""
import json

import numpy as np
from scipy.spatial.transform import Rotation

from . import meshes
from .cases import Case, generator
from .measures import MM

SEED = 53
SPACING = 0.015  # m between the points of a surface


def _grid(rows, columns, around):
    """Triangles of a grid of points; its last column joins the first when it goes `around`."""
    cell = np.arange(rows * columns).reshape(rows, columns)
    if around:
        cell = np.concatenate([cell, cell[:, :1]], 1)
    a, b, c, d = cell[:-1, :-1].ravel(), cell[:-1, 1:].ravel(), cell[1:, :-1].ravel(), cell[1:, 1:].ravel()
    return np.concatenate([np.stack([a, b, c], 1), np.stack([b, d, c], 1)])


def box(low, high):
    """A box between two corners."""
    low, high = np.array(low, float), np.array(high, float)
    vertices, faces = [], []
    for axis in range(3):
        u, v = [k for k in range(3) if k != axis]
        nu, nv = (max(2, int((high[k] - low[k]) / SPACING)) for k in (u, v))
        grid = np.stack(np.meshgrid(np.linspace(low[u], high[u], nu), np.linspace(low[v], high[v], nv), indexing="ij"), -1).reshape(-1, 2)
        for place in (low, high):
            side = np.empty((len(grid), 3))
            side[:, u], side[:, v], side[:, axis] = grid[:, 0], grid[:, 1], place[axis]
            faces.append(_grid(nu, nv, False) + sum(map(len, vertices)))
            vertices.append(side)
    return np.concatenate(vertices), np.concatenate(faces)


def tube(path, radii):
    """A round tube along a path (N,3) with a radius at each of its points, its ends drawn together."""
    path, radii = np.array(path, float), np.array(radii, float)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    at = np.linspace(0, length[-1], max(6, int(length[-1] / SPACING)))
    centre = np.stack([np.interp(at, length, path[:, k]) for k in range(3)], 1)
    radius = np.interp(at, length, radii)
    end = np.minimum(at, length[-1] - at)
    radius = radius * np.sqrt(np.clip(2 * end / radius - (end / radius) ** 2, 0, 1) * (end < radius) + (end >= radius))
    along = np.gradient(centre, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    helper = np.eye(3)[np.abs(along.mean(0)).argmin()]
    across = np.cross(along, helper)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    count = max(8, int(2 * np.pi * radii.max() / SPACING))
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    ring = np.cos(angle)[None, :, None] * across[:, None] + np.sin(angle)[None, :, None] * np.cross(along, across)[:, None]
    vertices = centre[:, None] + np.maximum(radius, 1e-3)[:, None, None] * ring
    return vertices.reshape(-1, 3), _grid(len(at), count, True)


def ball(radii, random=None, lumps=0.0):
    """An ellipsoid; with lumps, its radius waves by that share."""
    rings = max(20, int(np.pi * max(radii) / SPACING))
    theta, phi = np.meshgrid(np.linspace(0.001, np.pi - 0.001, rings), np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False), indexing="ij")
    unit = np.stack([np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], -1).reshape(-1, 3)
    size = np.ones(len(unit))
    if lumps:
        for _ in range(8):
            wave = random.normal(0, 2.2, 3)
            size += lumps * 0.5 * np.sin(unit @ wave + random.uniform(0, 2 * np.pi))
    return unit * np.maximum(size, 0.2)[:, None] * np.array(radii), _grid(rings, 2 * rings, True)


def together(parts):
    offset, vertices, faces = 0, [], []
    for v, f in parts:
        vertices.append(v)
        faces.append(f + offset)
        offset += len(v)
    return np.concatenate(vertices), np.concatenate(faces).astype(np.int32)


def _box(random):
    size = random.uniform([0.3, 0.8, 0.2], [0.9, 2.0, 0.7])
    return [box(-size / 2, size / 2)]


def _cylinder(random):
    height, radius = random.uniform(0.9, 2.0), random.uniform(0.08, 0.4)
    return [tube([[0, 0, 0], [0, height, 0]], [radius, radius * random.uniform(0.4, 1.6)])]


def _ball(random):
    return [ball(random.uniform(0.4, 1.0) * np.ones(3))]


def _lump(random):
    return [ball(random.uniform([0.25, 0.6, 0.2], [0.6, 1.0, 0.5]), random, random.uniform(0.15, 0.4))]


def _chair(random):
    width, depth, seat, back = random.uniform([0.38, 0.38, 0.4, 0.8], [0.6, 0.6, 0.55, 1.3])
    leg = random.uniform(0.03, 0.06)
    parts = [box([0, seat - 0.05, 0], [width, seat, depth]), box([0, seat, 0], [width, back, 0.05])]
    return parts + [box([x, 0, z], [x + leg, seat - 0.05, z + leg]) for x in (0, width - leg) for z in (0, depth - leg)]


def _animal(random):
    """Trunk lying, four legs, neck, head and tail."""
    length, height, thick = random.uniform([0.6, 0.45, 0.1], [1.4, 1.0, 0.22])
    parts = [tube([[0, height, 0], [length, height * random.uniform(0.95, 1.1), 0]], [thick, thick])]
    for x in (thick / 2, length - thick / 2):
        for z in (-0.6 * thick, 0.6 * thick):
            step = random.uniform(-0.15, 0.15)
            parts.append(tube([[x, height, z], [x + step, height / 2, z], [x + step / 2, 0, z]], [0.4 * thick, 0.3 * thick, 0.25 * thick]))
    top = np.array([length + random.uniform(0.15, 0.35), height * random.uniform(1.2, 1.7), 0])
    parts.append(tube([[length, height, 0], top], [0.6 * thick, 0.4 * thick]))
    parts.append(tube([top, top + [0.25, -0.05, 0]], [0.5 * thick, 0.3 * thick]))
    return parts + [tube([[0, height, 0], [-random.uniform(0.2, 0.5), height * random.uniform(0.6, 1.2), 0]], [0.15 * thick, 0.08 * thick])]


def _tree(random):
    height = random.uniform(1.2, 2.0)
    parts = [tube([[0, 0, 0], [0, height, 0]], [0.1, 0.05])]
    for _ in range(random.integers(4, 9)):
        at = random.uniform(0.35, 0.95) * height
        way = random.normal(0, 1, 3) * [1, 0.3, 1]
        way *= random.uniform(0.3, 0.7) / np.linalg.norm(way)
        parts.append(tube([[0, at, 0], [way[0], at + abs(way[1]) + 0.1, way[2]]], [0.05, 0.03]))
    return parts


def _vase(random):
    profile = random.uniform(0.1, 0.4, 6)
    height = random.uniform(0.9, 1.9)
    return [tube(np.stack([np.zeros(6), np.linspace(0, height, 6), np.zeros(6)], 1), profile)]


KINDS = {"box": _box, "cylinder": _cylinder, "ball": _ball, "lump": _lump, "chair": _chair, "animal": _animal, "tree": _tree,
         "vase": _vase}


def cases(count):
    """`count` objects, one of each kind in turn, turned about and in a unit at random; their truth holds no joints."""

    def case(k):
        kind = list(KINDS)[k % len(KINDS)]
        name = f"object_{k:03}_{kind}"

        def make(folder):
            random = generator(SEED, k)
            vertices, faces = together(KINDS[kind](random))
            unit = random.choice(list(MM))
            turn = Rotation.random(random_state=random.integers(2**31)).as_matrix()
            vertices = vertices @ turn.T + random.normal(0, 0.0005, vertices.shape)
            meshes.write_ply(folder / f"{name}.ply", vertices * 1e3 / MM[unit], faces)
            (folder / f"{name}.truth.json").write_text(json.dumps({"frame": "scan", "unit": unit, "joints": {}}))

        return Case(name, make, "no human")

    return [case(k) for k in range(count)]
