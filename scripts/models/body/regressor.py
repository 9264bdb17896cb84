"""Joint regressors: joints as convex combinations of nearby skin vertices."""
import numpy as np
from scipy.linalg import cholesky
from scipy.optimize import nnls

from .skeleton import MIRROR

CANDIDATES = 320
MIN_WEIGHT = 2e-3
SUM_WEIGHT, MEAN_WEIGHT = 30.0, 3.0


def _convex_fit(skin, joint, candidates):
    """Nonnegative weights w [C], sum 1, with skin[:, candidates] * w close to joint [N,3] in variation and mean."""
    x = skin[:, candidates].astype(np.float64)
    mean_x, mean_j = x.mean(0), joint.mean(0)
    a = (x - mean_x).transpose(0, 2, 1).reshape(-1, len(candidates))
    b = (joint - mean_j).ravel()
    scale = np.sqrt(len(x))
    a = np.concatenate([a, mean_x.T * scale * MEAN_WEIGHT, np.full((1, len(candidates)), scale * SUM_WEIGHT)])
    b = np.concatenate([b, mean_j * scale * MEAN_WEIGHT, [scale * SUM_WEIGHT]])
    # The same minimum from the normal equations' square root: as many rows as candidates instead of samples.
    gram = a.T @ a
    root = cholesky(gram + 1e-9 * np.trace(gram) / len(gram) * np.eye(len(gram)))
    weights, _ = nnls(root, np.linalg.solve(root.T, a.T @ b), maxiter=20 * len(candidates))
    weights[weights < MIN_WEIGHT] = 0
    return weights / weights.sum()


def fitted_regressor(skin, joints, vertex_mirror, joint_mirror=MIRROR):
    """[J,V] nonnegative, rows sum to 1, symmetric. skin [N,V,3] and joints [N,J,3] samples; both frames alike.

    joint_mirror [J]: partner of each joint. A joint's candidates are the vertices nearest to its mean place.
    """
    count, mirrored = joints.shape[1], np.array([-1, 1, 1])
    mean_skin = skin.mean(0, dtype=np.float64)
    mean_skin = 0.5 * (mean_skin + mean_skin[vertex_mirror] * mirrored)
    mean_joint = joints.mean(0)
    mean_joint = 0.5 * (mean_joint + mean_joint[joint_mirror] * mirrored)
    out = np.zeros((count, skin.shape[1]))
    for j in range(count):
        if joint_mirror[j] < j:
            out[j] = out[joint_mirror[j]][vertex_mirror]
            continue
        nearest = np.argsort(np.linalg.norm(mean_skin - mean_joint[j], axis=1), kind="stable")[:CANDIDATES]
        if joint_mirror[j] == j:
            nearest = np.union1d(nearest, vertex_mirror[nearest])
        out[j, nearest] = _convex_fit(skin, joints[:, j], nearest)
        if joint_mirror[j] == j:
            out[j] = 0.5 * (out[j] + out[j][vertex_mirror])
    return out
