"""Triangle meshes: topology, areas, volumes, and the closed, cavity-free skin made from the package's quads."""
from collections import defaultdict

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

# Edges around an eye opening and around the mouth in the package's quad mesh.
EYE_LOOP_EDGES, MOUTH_LOOP_EDGES = 28, 38
MAX_CAVITY_QUADS = 700


def mirror_partners(vertices):
    """Index of each vertex's left-right partner (x -> -x). vertices [V,3] must be exactly symmetric."""
    distance, partner = cKDTree(vertices).query(vertices * [-1, 1, 1])
    if distance.max() > 1e-9 or (partner[partner] != np.arange(len(partner))).any():
        raise ValueError("the mesh is not mirror-symmetric")
    return partner


def half_edges(faces):
    """Directed edges [F*n,2] of faces with n corners."""
    return np.stack([faces, np.roll(faces, -1, 1)], 2).reshape(-1, 2)


def topology(faces, vertex_count):
    """Boundary and non-manifold edges, Euler number, components, and whether the orientation is consistent."""
    directed = half_edges(faces)
    edges, uses = np.unique(np.sort(directed, 1), axis=0, return_counts=True)
    graph = sp.coo_matrix((np.ones(len(edges)), edges.T), shape=(vertex_count, vertex_count))
    return {
        "boundary": int((uses == 1).sum()),
        "non_manifold": int((uses > 2).sum()),
        "euler": vertex_count - len(edges) + len(faces),
        "components": int(connected_components(graph, False)[0]),
        "oriented": len(np.unique(directed, axis=0)) == len(directed),
    }


def face_normals(vertices, faces):
    """Normals of twice the area's length, [F,3]."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def vertex_areas(vertices, faces):
    """A third of the area of the incident triangles, [V]."""
    area = np.linalg.norm(face_normals(vertices, faces), axis=1) / 2
    return np.bincount(faces.ravel(), np.repeat(area / 3, 3), len(vertices))


def vertex_normals(vertices, faces):
    """Area-weighted unit normals, [V,3]."""
    normals = np.zeros_like(vertices)
    flat = np.repeat(face_normals(vertices, faces), 3, 0)
    for k in range(3):
        normals[:, k] = np.bincount(faces.ravel(), flat[:, k], len(vertices))
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)


def volume(vertices, faces):
    """Signed volume of a closed mesh; positive when oriented outward."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def cotangent_laplacian(vertices, faces):
    """Positive semi-definite cotangent matrix L [V,V] (csr): energy x' L x; rows sum to 0."""
    rows, columns, values = [], [], []
    for k in range(3):
        i, j, o = faces[:, (k + 1) % 3], faces[:, (k + 2) % 3], faces[:, k]
        u, v = vertices[i] - vertices[o], vertices[j] - vertices[o]
        cot = np.einsum("ij,ij->i", u, v) / np.maximum(np.linalg.norm(np.cross(u, v), axis=1), 1e-12)
        # Clamped so that slivers cannot make negative weights, which would break the maximum principle.
        half = np.clip(cot, 0.02, 50.0) / 2
        rows += [i, j, i, j]
        columns += [j, i, i, j]
        values += [-half, -half, half, half]
    n = len(vertices)
    return sp.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(n, n))


def _closed_edge_loops(quads, lengths):
    """Closed vertex loops that run straight through four-valent vertices and have one of the given lengths."""
    neighbours, edge_quads = defaultdict(set), defaultdict(list)
    for i, quad in enumerate(quads.tolist()):
        for k in range(4):
            a, b = quad[k], quad[(k + 1) % 4]
            neighbours[a].add(b)
            neighbours[b].add(a)
            edge_quads[frozenset((a, b))].append(i)
    quads = quads.tolist()

    def straight_on(a, b):
        if len(neighbours[b]) != 4:
            return None
        beside = {k for i in edge_quads[frozenset((a, b))] for k in quads[i]}
        ahead = [k for k in neighbours[b] if k not in beside]
        return ahead[0] if len(ahead) == 1 else None

    seen, loops = set(), []
    for edge in edge_quads:
        if edge in seen:
            continue
        loop = list(edge)
        while len(loop) <= max(lengths):
            seen.add(frozenset(loop[-2:]))
            following = straight_on(loop[-2], loop[-1])
            if following is None or following in loop:
                if following == loop[0] and straight_on(loop[-1], loop[0]) == loop[1] and len(loop) in lengths:
                    loops.append(loop)
                break
            loop.append(following)
    return loops, edge_quads


def _cavities(vertices, quads):
    """[(loop, inner quads)] of the mouth and the two eye sockets, each cut at its narrowest closed edge loop."""
    loops, edge_quads = _closed_edge_loops(quads, (EYE_LOOP_EDGES, MOUTH_LOOP_EDGES))
    head_above = vertices[:, 1].max() - 0.25
    families = defaultdict(list)
    for loop in loops:
        points = vertices[loop]
        if points[:, 1].min() < head_above:
            continue
        cut = {frozenset((loop[k - 1], loop[k])) for k in range(len(loop))}
        joined = np.array([pair for edge, pair in edge_quads.items() if edge not in cut])
        graph = sp.coo_matrix((np.ones(len(joined)), joined.T), shape=(len(quads), len(quads)))
        count, label = connected_components(graph, False)
        inner = np.nonzero(label == np.argmin(np.bincount(label)))[0]
        if count != 2 or len(inner) > MAX_CAVITY_QUADS:
            continue
        perimeter = np.linalg.norm(points - np.roll(points, 1, 0), axis=1).sum()
        side = int(np.sign(np.round(points[:, 0].mean(), 2)))
        families[len(loop), side].append((perimeter, loop, inner))
    if sorted(families) != [(EYE_LOOP_EDGES, -1), (EYE_LOOP_EDGES, 1), (MOUTH_LOOP_EDGES, 0)]:
        raise ValueError("the quad mesh has not the expected mouth and eye openings")
    return [min(family, key=lambda entry: entry[0])[1:] for family in families.values()]


def _zipped(a, b, vertices):
    """Triangles between two chains of a loop that end in the same vertex, shortest rungs first."""
    i = j = 0
    triangles = []
    while i < len(a) - 1 or j < len(b) - 1:
        da = np.linalg.norm(vertices[a[i + 1]] - vertices[b[j]]) if i < len(a) - 1 else np.inf
        db = np.linalg.norm(vertices[a[i]] - vertices[b[j + 1]]) if j < len(b) - 1 else np.inf
        if da <= db:
            triangles.append([a[i], a[i + 1], b[j]])
            i += 1
        else:
            triangles.append([a[i], b[j + 1], b[j]])
            j += 1
    return [t for t in triangles if len(set(t)) == 3]


def _chains_to_left_corner(loop, vertices):
    """The loop's two chains that end in its vertex of largest x; they start on the midline, or else at smallest x."""
    x = vertices[loop][:, 0]
    n, last = len(loop), int(np.argmax(x))
    start = int(np.argmin(x)) if x.min() > 0 else None

    def chain(step):
        indices = [last]
        while indices[-1] != start and not (start is None and x[indices[-1]] == 0):
            indices.append((indices[-1] + step) % n)
        return [loop[k] for k in reversed(indices)]

    return chain(-1), chain(1)


def opened_and_capped(vertices, quads):
    """(quads without mouth and eye cavities, triangles [C,3] that close the three openings)."""
    dropped = np.zeros(len(quads), bool)
    caps = []
    partner = mirror_partners(vertices)
    for loop, inner in _cavities(vertices, quads):
        dropped[inner] = True
        if vertices[loop][:, 0].mean() < -1e-3:
            continue
        # The cap's winding: each edge of the loop runs against the kept quad beside it.
        kept_edges = set(map(tuple, half_edges(np.delete(quads, inner, 0)).tolist()))
        outward = loop if (loop[1], loop[0]) in kept_edges else loop[::-1]
        half = _zipped(*_chains_to_left_corner(outward, vertices), vertices)
        caps += half + [partner[t[::-1]].tolist() for t in half]
    return quads[~dropped], np.array(caps)


def closed_skin(vertices, quads):
    """The skin without mouth and eye cavities, closed, triangulated, exactly symmetric.

    vertices [N,3] symmetric shape that decides cuts and diagonals. Returns (faces [F,3] indexing into `kept`,
    kept [V] indices into vertices).
    """
    q, caps = opened_and_capped(vertices, quads)
    short = np.linalg.norm(vertices[q[:, 0]] - vertices[q[:, 2]], axis=1) <= 1e-9 + np.linalg.norm(
        vertices[q[:, 1]] - vertices[q[:, 3]], axis=1
    )
    first = np.concatenate([q[short][:, [0, 1, 2]], q[~short][:, [0, 1, 3]]])
    second = np.concatenate([q[short][:, [0, 2, 3]], q[~short][:, [1, 2, 3]]])
    kept, faces = np.unique(np.concatenate([first, second, caps]), return_inverse=True)
    return faces.reshape(-1, 3), kept
