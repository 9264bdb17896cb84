"""Skinning weights of our own: heat from the bones (Baran and Popovic 2007, section 4) over the rest surface."""
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from .surface import cotangent_laplacian, vertex_areas

# Heat exchanged with the nearest bone, H = HEAT / d^2 (the paper's c); larger is sharper.
HEAT = 5.0
# Nearness is shared between bones as d^-SHARPNESS, so that weights stay smooth where two bones are equally near.
SHARPNESS = 10
MAX_INFLUENCES = 4


def segment_distances(points, begin, end):
    """Distances [P,B] of points [P,3] to segments begin[B,3] - end[B,3]."""
    out = np.empty((len(points), len(begin)))
    for k, (a, b) in enumerate(zip(begin, end)):
        d = b - a
        t = np.clip((points - a) @ d / max(d @ d, 1e-12), 0, 1)
        out[:, k] = np.linalg.norm(points - a - t[:, None] * d, axis=1)
    return out


def bone_heat(vertices, faces, begin, end, owner, owner_count, heat=HEAT):
    """Weights [V,owners], nonnegative, rows sum to 1.

    vertices, faces: the rest surface in metres. begin, end [B,3]: bone segments; owner [B]: whose each segment is.
    Distances are straight: the rest pose must keep limbs apart from the trunk (arms lowered by some 45 degrees).
    """
    distance = segment_distances(vertices, begin, end)
    by_owner = np.full((len(vertices), owner_count), np.inf)
    for k, joint in enumerate(owner):
        by_owner[:, joint] = np.minimum(by_owner[:, joint], distance[:, k])
    nearest = np.maximum(by_owner.min(1), 1e-3)
    share = (nearest[:, None] / np.maximum(by_owner, 1e-3)) ** SHARPNESS
    share /= share.sum(1, keepdims=True)
    exchange = vertex_areas(vertices, faces) * heat / nearest**2
    system = (cotangent_laplacian(vertices, faces) + sp.diags(exchange)).tocsc()
    weights = np.maximum(splu(system).solve(exchange[:, None] * share), 0)
    return weights / weights.sum(1, keepdims=True)


def smoothed(weights, faces, amount, passes):
    """Umbrella smoothing: each pass moves a row by amount[V] (0..1) towards the mean of its neighbours."""
    n = len(weights)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = np.concatenate([edges, edges[:, ::-1]])
    graph = sp.csr_matrix((np.ones(len(edges)), edges.T), shape=(n, n))
    graph.data[:] = 1
    mean = sp.diags(1 / np.asarray(graph.sum(1)).ravel()) @ graph
    for _ in range(passes):
        weights = weights + amount[:, None] * (mean @ weights - weights)
    return weights


def limited(weights, count=MAX_INFLUENCES):
    """At most `count` weights a row. The largest dropped weight is subtracted from the kept ones first, so that rows
    change continuously where influences change places."""
    if weights.shape[1] <= count:
        return weights / weights.sum(1, keepdims=True)
    threshold = -np.sort(-weights, 1)[:, count : count + 1]
    kept = np.maximum(weights - threshold, 0)
    return kept / kept.sum(1, keepdims=True)


def symmetric(weights, vertex_mirror, joint_mirror):
    """Mean of the weights and their mirror image."""
    return 0.5 * (weights + weights[vertex_mirror][:, joint_mirror])
