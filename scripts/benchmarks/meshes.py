"""Meshes and clouds of the benchmark: files, finer and coarser surfaces, what one camera sees."""
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

TYPES = {"float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8", "uchar": "u1", "uint8": "u1",
         "int": "<i4", "int32": "<i4", "uint": "<u4", "short": "<i2", "ushort": "<u2", "char": "i1"}
NO_FACES = np.zeros((0, 3), np.int32)


def read_ply(path):
    """Vertices (N,3) float64 and faces (F,3) int32 of a binary little-endian triangle PLY or cloud."""
    data = Path(path).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    elements = []
    for line in data[:end].decode("ascii").splitlines():
        words = line.split()
        if words[0] == "format" and words[1] != "binary_little_endian":
            raise SystemExit(f"{path}: only binary little-endian PLY is read here")
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property" and words[1] == "list":
            elements[-1][2].extend([("n", TYPES[words[2]]), ("i", TYPES[words[3]], 3)])
        elif words[0] == "property":
            elements[-1][2].append((words[2], TYPES[words[1]]))
    arrays = {}
    for name, count, fields in elements:
        arrays[name] = np.frombuffer(data, np.dtype(fields), count, end)
        end += arrays[name].nbytes
    vertex = arrays["vertex"]
    faces = arrays["face"]["i"].astype(np.int32) if "face" in arrays and len(arrays["face"]) else NO_FACES
    return np.stack([vertex[axis] for axis in "xyz"], 1).astype(np.float64), faces


def write_ply(path, vertices, faces=NO_FACES, colours=None):
    """Binary little-endian PLY, float32; colours (N,3) bytes if given; no face element for a cloud."""
    fields = [("xyz", "<f4", 3)] + ([("rgb", "u1", 3)] if colours is not None else [])
    vertex = np.zeros(len(vertices), fields)
    vertex["xyz"] = vertices
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {axis}" for axis in "xyz"]
    if colours is not None:
        vertex["rgb"] = colours
        header += [f"property uchar {name}" for name in ("red", "green", "blue")]
    rows = np.zeros(len(faces), [("n", "u1"), ("i", "<i4", 3)])
    if len(faces):
        rows["n"], rows["i"] = 3, faces
        header += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
    Path(path).write_bytes("\n".join(header + ["end_header", ""]).encode() + vertex.tobytes() + rows.tobytes())


def subdivide(vertices, faces):
    """Each triangle into four; the old vertices stay first."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1)
    unique, inverse = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (inverse.reshape(3, -1) + len(vertices)).astype(np.int32)
    a, b, c = faces.T
    fine = np.concatenate([np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return np.concatenate([vertices, vertices[unique].mean(1)]), fine


def with_vertex_count(vertices, faces, count, random):
    """The surface with `count` vertices, or those it has if they are more, and 0.3 mm of noise."""
    while 3 * len(vertices) < count:
        vertices, faces = subdivide(vertices, faces)
    while len(vertices) < count:
        chosen = random.permutation(len(faces))[:count - len(vertices)]
        middles = vertices[faces[chosen]].mean(1)
        new = (len(vertices) + np.arange(len(chosen))).astype(np.int32)
        a, b, c = faces[chosen].T
        kept = np.delete(faces, chosen, 0)
        faces = np.concatenate([kept] + [np.stack(t, 1) for t in ((a, b, new), (b, c, new), (c, a, new))])
        vertices = np.concatenate([vertices, middles])
    return vertices + random.normal(0, 3e-4, vertices.shape), faces


def clustered(vertices, faces, cell):
    """Vertices that share a cell of a grid become their mean; triangles that lose a corner go."""
    _, group = np.unique(np.floor(vertices / cell).astype(np.int64), axis=0, return_inverse=True)
    group = group.ravel()
    size = np.bincount(group)
    means = np.stack([np.bincount(group, vertices[:, k]) / size for k in range(3)], 1)
    coarse = group[faces].astype(np.int32) if len(faces) else faces
    whole = (coarse[:, 0] != coarse[:, 1]) & (coarse[:, 1] != coarse[:, 2]) & (coarse[:, 2] != coarse[:, 0])
    return means, np.unique(coarse[whole], axis=0)


def coarsened(vertices, faces, count):
    """The mesh clustered to about `count` vertices."""
    low, high = 0.0, float(np.ptp(vertices, axis=0).max())
    for _ in range(18):
        cell = (low + high) / 2
        if len(np.unique(np.floor(vertices / cell).astype(np.int64), axis=0)) > count:
            low = cell
        else:
            high = cell
    return clustered(vertices, faces, high)


def restricted(vertices, faces, keep):
    """Vertices with keep[N] and the triangles all of whose corners are kept; a mesh also loses what no triangle uses."""
    if len(faces):
        faces = faces[keep[faces].all(1)]
        used, inverse = np.unique(faces, return_inverse=True)
        return vertices[used], inverse.reshape(-1, 3).astype(np.int32)
    return vertices[keep], faces


def seen_from(vertices, faces, toward, pixel):
    """Which vertices (N) a camera in direction `toward` sees, parallel projection; `pixel` in the vertices' unit.

    The z-buffer holds vertices: of the mesh divided until its edges are about a pixel.
    """
    fine, fine_faces = vertices, faces
    while len(fine_faces):
        edge = np.linalg.norm(fine[fine_faces[:, 0]] - fine[fine_faces[:, 1]], axis=1)
        if np.percentile(edge, 98) <= pixel or len(fine) > 400_000:
            break
        fine, fine_faces = subdivide(fine, fine_faces)
    toward = toward / np.linalg.norm(toward)
    helper = np.eye(3)[np.abs(toward).argmin()]
    right = np.cross(helper, toward)
    right /= np.linalg.norm(right)
    up = np.cross(toward, right)
    plane = np.floor(np.stack([fine @ right, fine @ up], 1) / pixel).astype(int)
    plane -= plane.min(0)
    cell = plane[:, 1] * (plane[:, 0].max() + 1) + plane[:, 0]
    depth = fine @ toward
    front = np.full(cell.max() + 1, -np.inf)
    np.maximum.at(front, cell, depth)
    visible = depth[:len(vertices)] > front[cell[:len(vertices)]] - 1.8 * pixel
    if len(faces):
        visible &= normals(vertices, faces) @ toward > 0.1
    return visible


def normals(vertices, faces):
    """Area-weighted unit normals (N,3)."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    flat = np.repeat(np.cross(b - a, c - a), 3, 0)
    out = np.stack([np.bincount(faces.ravel(), flat[:, k], len(vertices)) for k in range(3)], 1)
    return out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-30)


def with_patches_cut(vertices, faces, share, radius, random):
    """The scan without round patches of about `radius` that hold `share` of its vertices together."""
    keep = np.ones(len(vertices), bool)
    tree = cKDTree(vertices)
    while keep.mean() > 1 - share:
        centre = vertices[random.integers(len(vertices))]
        keep[tree.query_ball_point(centre, radius * random.uniform(0.5, 1.3))] = False
    return restricted(vertices, faces, keep)
