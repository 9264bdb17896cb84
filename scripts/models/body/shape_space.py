"""Symmetric, area-weighted principal components of T-pose characters, and priors over them."""
import numpy as np

MIRRORED = np.array([-1, 1, 1], np.float32)


def symmetrised(skin, vertex_mirror):
    """Mean of [...,V,3] shapes and their mirror images."""
    return 0.5 * (skin + skin[..., vertex_mirror, :] * MIRRORED)


def components(skin, area, count):
    """(mean [V,3], directions [count,V,3]); coefficients of the samples along a direction have unit variance.

    skin [N,V,3] symmetric samples; area [V] weighs the squared errors.
    """
    n = len(skin)
    mean = skin.mean(0, dtype=np.float64)
    weight = np.sqrt(area / area.sum()).astype(np.float32)[:, None]
    flat = ((skin - mean.astype(np.float32)) * weight).reshape(n, -1)
    gram = (flat @ flat.T).astype(np.float64)
    value, vector = np.linalg.eigh(gram)
    leading = np.argsort(-value)[:count]
    value, vector = value[leading], vector[:, leading]
    # A direction's sign is arbitrary; fixed so that growth upward is positive.
    directions = (vector.T.astype(np.float32) @ flat).reshape(count, -1, 3) / weight / np.float32(np.sqrt(n - 1))
    sign = np.where(np.einsum("kv,v->k", directions[:, :, 1], mean[:, 1] * area) < 0, -1, 1)
    return mean, directions.astype(np.float64) * sign[:, None, None]


def coefficients(skin, mean, directions, area):
    """Least-squares coefficients [N,K] of shapes [N,V,3], squared errors weighted by area."""
    weight = np.sqrt(area / area.sum())[:, None]
    basis = (directions * weight).reshape(len(directions), -1)
    target = ((skin - mean.astype(np.float32)) * weight.astype(np.float32)).reshape(len(skin), -1)
    return np.linalg.solve(basis @ basis.T, basis.astype(np.float32) @ target.T).T


def residuals_mm(skin, mean, directions, area):
    """Distances [N,V] in mm between shapes and their best fits."""
    beta = coefficients(skin, mean, directions, area).astype(np.float32)
    fit = mean.astype(np.float32) + np.tensordot(beta, directions.astype(np.float32), 1)
    return np.linalg.norm(skin - fit, axis=2) * 1e3


def prior(beta):
    """(mean [K], precision [K,K]) of a normal distribution fitted to coefficients [N,K]."""
    precision = np.linalg.inv(np.cov(beta.T))
    return beta.mean(0), 0.5 * (precision + precision.T)
