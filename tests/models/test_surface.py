"""Mesh tools of the makers on small closed meshes."""
import unittest

import numpy as np

import support  # noqa: F401  (sets the import path)
from body import decimate, skin_weights, subdivide, surface

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
CUBE_QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def ball(steps=3):
    """A closed, mirror-symmetric, outward triangle mesh near a ball."""
    vertices, quads = CUBE, CUBE_QUADS
    for _ in range(steps):
        vertices, quads = subdivide.catmull_clark(vertices, [quads])
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return vertices, triangles, quads


class Subdivision(unittest.TestCase):
    def test_catmull_clark_keeps_the_mesh_closed_and_converges(self):
        vertices, triangles, quads = ball()
        self.assertEqual(len(quads), 6 * 4**3)
        counts = surface.topology(quads, len(vertices))
        self.assertEqual((counts["boundary"], counts["non_manifold"], counts["euler"]), (0, 0, 2))
        self.assertTrue(counts["oriented"])
        radius = np.linalg.norm(vertices, axis=1)
        self.assertLess(np.ptp(radius) / radius.mean(), 0.15)
        self.assertGreater(surface.volume(vertices, triangles), 0)

    def test_open_meshes_are_refused(self):
        with self.assertRaises(ValueError):
            subdivide.catmull_clark(CUBE, [CUBE_QUADS[:5]])

    def test_splitting_long_edges_moves_no_surface(self):
        vertices, triangles, _ = ball(1)
        fine, faces = subdivide.split_long_edges(np.concatenate([vertices, vertices * 2], 1), triangles, 0.2)
        np.testing.assert_allclose(fine[:, 3:], fine[:, :3] * 2)
        self.assertEqual(surface.topology(faces, len(fine))["euler"], 2)
        self.assertTrue(surface.topology(faces, len(fine))["oriented"])
        self.assertAlmostEqual(surface.volume(fine[:, :3], faces), surface.volume(vertices, triangles), 9)
        edges = surface.half_edges(faces)
        self.assertLessEqual(np.linalg.norm(fine[edges[:, 0], :3] - fine[edges[:, 1], :3], axis=1).max(), 0.2)


class Simplification(unittest.TestCase):
    def test_symmetric_and_closed(self):
        vertices, triangles, _ = ball(3)
        vertices = np.round(vertices, 12)
        triangles = symmetric_triangles(vertices)
        mirror = surface.mirror_partners(vertices)
        area = surface.vertex_areas(vertices, triangles)
        faces, kept = decimate.simplified(vertices, [vertices], triangles, area, mirror, 200)
        self.assertTrue(150 < len(kept) <= 200)
        counts = surface.topology(faces, len(kept))
        self.assertEqual((counts["boundary"], counts["non_manifold"], counts["euler"]), (0, 0, 2))
        index = {k: i for i, k in enumerate(kept.tolist())}
        partner = np.array([index[m] for m in mirror[kept].tolist()])
        present = set(map(tuple, np.sort(faces, 1).tolist()))
        self.assertTrue(all(tuple(sorted(f)) in present for f in partner[faces].tolist()))
        volume = surface.volume(vertices, triangles)
        self.assertLess(abs(surface.volume(vertices[kept], faces) / volume - 1), 0.05)


def symmetric_triangles(vertices):
    """Triangles of the ball with mirrored diagonals: those of the half x >= 0 and their images."""
    _, triangles, _ = ball(3)
    mirror = surface.mirror_partners(vertices)
    half = triangles[vertices[triangles][:, :, 0].min(1) > -1e-9]
    return np.concatenate([half, mirror[half[:, ::-1]]])


class Heat(unittest.TestCase):
    def test_weights_follow_the_nearer_bone_and_change_smoothly(self):
        vertices, triangles, _ = ball(3)
        begin, end = np.array([[-0.5, 0, 0], [0.1, 0, 0]]), np.array([[-0.1, 0, 0], [0.5, 0, 0]])
        weights = skin_weights.bone_heat(vertices, triangles, begin, end, np.array([0, 1]), 2)
        np.testing.assert_allclose(weights.sum(1), 1)
        self.assertGreater(weights[vertices[:, 0] > 0.5, 1].min(), 0.8)
        self.assertGreater(weights[vertices[:, 0] < -0.5, 0].min(), 0.8)
        np.testing.assert_allclose(weights[np.abs(vertices[:, 0]) < 1e-9], 0.5, atol=0.02)

    def test_limiting_is_continuous_where_influences_change_places(self):
        a = np.array([[0.4, 0.3, 0.15, 0.0751, 0.0749]])
        b = np.array([[0.4, 0.3, 0.15, 0.0749, 0.0751]])
        self.assertLess(np.abs(skin_weights.limited(a) - skin_weights.limited(b)).max(), 1e-3)
        self.assertEqual((skin_weights.limited(a) > 0).sum(), 4)


if __name__ == "__main__":
    unittest.main()
