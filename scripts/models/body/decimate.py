"""Mirror-symmetric mesh simplification that keeps vertices of the original (quadric errors, Garland and Heckbert 1997).

Half-edge collapses onto existing vertices, so that all linear functions of the vertices (shapes, weights) restrict to
the kept rows. Quadrics are summed over several poses, so that what bends keeps its vertices.
"""
import heapq

import numpy as np

from .surface import face_normals

# Penalty on edge length times area, relative to the quadric error: keeps the density of the trunk and limbs.
LENGTH_PENALTY = 2e-3
MAX_VALENCE = 9
MIN_NORMAL_COSINE = 0.35
MIN_TRIANGLE_SHAPE = 0.18


def _quadrics(vertices, faces):
    normal = face_normals(vertices, faces)
    area = np.linalg.norm(normal, axis=1) / 2
    normal /= np.maximum(2 * area[:, None], 1e-15)
    plane = np.concatenate([normal, -(normal * vertices[faces[:, 0]]).sum(1, keepdims=True)], 1)
    quadric = np.einsum("fi,fj,f->fij", plane, plane, area)
    out = np.zeros((len(vertices), 4, 4))
    for k in range(3):
        np.add.at(out, faces[:, k], quadric)
    return out


class _Mesh:
    def __init__(self, rest, poses, faces, area):
        self.rest, self.area = rest, area.copy()
        self.points = np.stack([np.concatenate([p, np.ones((len(p), 1))], 1) for p in poses], 1)
        self.quadric = np.stack([_quadrics(p, faces) for p in poses], 1)
        self.faces = faces.tolist()
        self.alive = [True] * len(self.faces)
        self.incident = [set() for _ in rest]
        for i, face in enumerate(self.faces):
            for k in face:
                self.incident[k].add(i)

    def neighbours(self, u):
        return {k for i in self.incident[u] for k in self.faces[i]} - {u}

    def cost(self, u, v):
        point = self.points[v]
        error = np.einsum("pi,pij,pj->", point, self.quadric[u] + self.quadric[v], point)
        return error + LENGTH_PENALTY * self.area[u] * ((self.rest[u] - self.rest[v]) ** 2).sum() + 1e-12

    def allowed(self, u, v):
        """Whether collapsing u into v keeps the mesh closed, unfolded and free of slivers."""
        around_u, around_v = self.neighbours(u), self.neighbours(v)
        if len(around_u & around_v) != 2 or len(around_u | around_v) - 2 > MAX_VALENCE:
            return False
        for i in self.incident[u]:
            face = self.faces[i]
            if v in face:
                continue
            old = self.rest[face]
            new = self.rest[[v if k == u else k for k in face]]
            before, after = (np.cross(p[1] - p[0], p[2] - p[0]) for p in (old, new))
            size = np.sqrt(after @ after)
            longest = max(((new[k] - new[k - 1]) ** 2).sum() for k in range(3))
            turned = before @ after < MIN_NORMAL_COSINE * np.sqrt(before @ before) * size
            if turned or size < MIN_TRIANGLE_SHAPE * longest:
                return False
        return True

    def collapse(self, u, v):
        for i in list(self.incident[u]):
            face = self.faces[i]
            if v in face:
                self.alive[i] = False
                for k in face:
                    self.incident[k].discard(i)
            else:
                face[face.index(u)] = v
                self.incident[u].discard(i)
                self.incident[v].add(i)
        self.quadric[v] += self.quadric[u]
        self.area[v] += self.area[u]

    def snapshot(self, u, v):
        """What collapse(u, v) will change, for restore()."""
        touched = list(self.incident[u])
        corners = {k for i in touched for k in self.faces[i]} | {v}
        return (
            [(i, list(self.faces[i]), self.alive[i]) for i in touched],
            [(k, set(self.incident[k])) for k in corners],
            (v, self.quadric[v].copy(), self.area[v]),
        )

    def restore(self, snapshot):
        faces, incident, (v, quadric, area) = snapshot
        for i, face, alive in faces:
            self.faces[i], self.alive[i] = face, alive
        for k, around in incident:
            self.incident[k] = around
        self.quadric[v], self.area[v] = quadric, area


def simplified(rest, poses, faces, area, mirror, target):
    """(faces [F,3] into `kept`, kept [V]) with V at most `target` and every face's mirror image present.

    rest [N,3]; poses: list of [N,3], the rest among them; area [N]; mirror [N] left-right partners.
    """
    mesh = _Mesh(rest, poses, faces, area)
    midline = mirror == np.arange(len(rest))
    version, dead = np.zeros(len(rest), int), np.zeros(len(rest), bool)
    heap = [(mesh.cost(u, v), u, v, 0, 0) for u in range(len(rest)) for v in mesh.neighbours(u)]
    heapq.heapify(heap)

    def merge(u, v):
        mesh.collapse(u, v)
        dead[u] = True
        version[v] += 1

    def requeue(v):
        for w in mesh.neighbours(v):
            for a, b in ((v, w), (w, v)):
                heapq.heappush(heap, (mesh.cost(a, b), a, b, version[a], version[b]))

    count = len(rest)
    while count > target and heap:
        _, u, v, version_u, version_v = heapq.heappop(heap)
        if dead[u] or dead[v] or version[u] != version_u or version[v] != version_v or v not in mesh.neighbours(u):
            continue
        mu, mv = int(mirror[u]), int(mirror[v])
        if v == mu or (midline[u] and not midline[v]) or not mesh.allowed(u, v):
            continue
        if mu == u:
            merge(u, v)
            count -= 1
            requeue(v)
        # Both halves of a pair go or none does; a pair that touches itself may only go to the midline.
        elif mu not in mesh.neighbours(u) or midline[v]:
            before = mesh.snapshot(u, v)
            mesh.collapse(u, v)
            possible = mesh.allowed(mu, mv)
            mesh.restore(before)
            if not possible:
                continue
            merge(u, v)
            merge(mu, mv)
            count -= 2
            requeue(v)
            if mv != v:
                requeue(mv)
    kept = np.nonzero(~dead)[0]
    index = np.full(len(rest), -1)
    index[kept] = np.arange(len(kept))
    return index[np.array([f for f, alive in zip(mesh.faces, mesh.alive) if alive])], kept
