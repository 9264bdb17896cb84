"""Finer meshes: Catmull-Clark subdivision and splitting of long edges."""
import numpy as np


def catmull_clark(vertices, polygons):
    """One step over a closed mesh (Catmull and Clark 1978). polygons: list of arrays [F,n], n may differ between them.

    Returns (vertices [V + F + E, 3], quads [Q,4]); the first V vertices are the old ones, moved.
    """
    count = len(vertices)
    face_points = np.concatenate([vertices[p].mean(1) for p in polygons])
    first = np.cumsum([0] + [len(p) for p in polygons])
    tail = np.concatenate([p.ravel() for p in polygons])
    head = np.concatenate([np.roll(p, -1, 1).ravel() for p in polygons])
    face = np.concatenate([np.repeat(np.arange(len(p)) + f, p.shape[1]) for p, f in zip(polygons, first)])
    edges, edge = np.unique(np.sort(np.stack([tail, head], 1), 1), axis=0, return_inverse=True)
    edge = edge.ravel()
    if (np.bincount(edge) != 2).any():
        raise ValueError("Catmull-Clark subdivision needs a closed mesh")

    def sums(index, values, size):
        return np.stack([np.bincount(index, values[:, k], size) for k in range(3)], 1)

    midpoints = vertices[edges].mean(1)
    edge_points = (2 * midpoints + sums(edge, face_points[face], len(edges))) / 4
    valence = np.bincount(tail, minlength=count)[:, None].astype(float)
    around_faces = sums(tail, face_points[face], count) / valence
    around_edges = (sums(edges[:, 0], midpoints, count) + sums(edges[:, 1], midpoints, count)) / valence
    moved = (around_faces + 2 * around_edges + (valence - 3) * vertices) / valence
    # A corner's quad: corner, following edge point, face point, preceding edge point.
    preceding = np.concatenate(
        [np.roll(edge[s : s + p.size].reshape(p.shape), 1, 1).ravel() for p, s in zip(polygons, _starts(polygons))]
    )
    edge_base = count + len(face_points)
    quads = np.stack([tail, edge_base + edge, count + face, edge_base + preceding], 1)
    return np.concatenate([moved, face_points, edge_points]), quads


def _starts(polygons):
    return np.cumsum([0] + [p.size for p in polygons])[:-1]


def split_long_edges(vertices, faces, longest):
    """Halves edges longer than `longest` until none is left. Returns (vertices, faces [F,3]); old vertices stay first.

    vertices [V,3+A]: positions, which decide, and any attributes, which are halved along.
    """
    while True:
        pairs = np.sort(np.stack([faces, np.roll(faces, -1, 1)], 2), 2)
        long = np.linalg.norm(vertices[pairs[..., 0], :3] - vertices[pairs[..., 1], :3], axis=2) > longest
        if not long.any():
            return vertices, faces
        edges, index = np.unique(pairs[long], axis=0, return_inverse=True)
        middle = np.full(faces.shape, -1)
        middle[long] = len(vertices) + index.ravel()
        vertices = np.concatenate([vertices, vertices[edges].mean(1)])
        faces = _split(vertices[:, :3], faces, middle)


def _split(vertices, faces, middle):
    """Faces cut at the given edge midpoints (-1: edge not cut)."""
    out = [faces[(middle < 0).all(1)]]
    for k in range(3):
        a, b, c = (faces[:, (k + i) % 3] for i in range(3))
        ab, bc, ca = (middle[:, (k + i) % 3] for i in range(3))
        one = (ab >= 0) & (bc < 0) & (ca < 0)
        out += [np.stack([x[one] for x in t], 1) for t in ((a, ab, c), (ab, b, c))]
        two = (ab >= 0) & (bc >= 0) & (ca < 0)
        # The quadrilateral a, ab, bc, c beside the cut corner b gets its shorter diagonal.
        out.append(np.stack([ab[two], b[two], bc[two]], 1))
        p, q, r, s = a[two], ab[two], bc[two], c[two]
        pr = np.linalg.norm(vertices[p] - vertices[r], axis=1) <= np.linalg.norm(vertices[q] - vertices[s], axis=1)
        out.append(np.where(pr[:, None], np.stack([p, q, r], 1), np.stack([p, q, s], 1)))
        out.append(np.where(pr[:, None], np.stack([p, r, s], 1), np.stack([q, r, s], 1)))
    three = (middle >= 0).all(1)
    f, m = faces[three], middle[three]
    out += [np.stack([f[:, k], m[:, k], m[:, k - 1]], 1) for k in range(3)] + [m]
    return np.concatenate(out)
