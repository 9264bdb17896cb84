"""What the verdict's confidence is computed from, and how it is calibrated: the counterpart of core/measure/verdict_model.cpp.

Logistic regression on numbers of `verdict.features` in registration.json. Every input grows with what speaks against a fit,
and its weight is held at 0 or above: no finding may speak for a fit by being bad.
"""
from statistics import median

import numpy as np
from scipy.optimize import minimize

from .measures import SMPL

SEEN = 0.5  # share of a segment's vertices that meets the scan, or lies over a hole of it
FREE = ("typical",)  # clothes excuse some distance: more of it may speak for a fit
PENALTY = 5e-2  # ridge, of standardised weights


def _log(value, unit):
    return float(np.log1p(max(0.0, value) / unit))


def inputs(features):
    """{name: number} of one registration's features."""
    parts = features["segments"]
    met = [p for p in parts if p["observed"] >= SEEN * (1 - p["unseen"])]
    lost = sum(p["observed"] + p["unseen"] < SEEN for p in parts)
    # Where a part was not met by the scan the detector guessed as the fit did.
    seen = {name for name, part in zip(SMPL, parts) if part["observed"] >= SEEN}
    worst = lambda key: max((p[key] for p in met), default=0.0)
    return {
        "model_to_scan_p95": _log(features["model_to_scan_p95_mm"], 5),
        "scan_to_model_p95": _log(features["scan_to_model_p95_mm"], 5),
        "typical": _log(features["typical_mm"], 10),
        "unexplained": _log(features["unexplained_share"], 0.01),
        "opposed": _log(features["opposed_share"], 0.01),
        "part_model_to_scan": _log(worst("model_to_scan_p95_mm"), 10),
        "uneven": _log(worst("model_to_scan_p95_mm"), 1 + 2 * median(p["model_to_scan_p95_mm"] for p in met) if met else 1.0),
        "part_scan_to_model": _log(worst("scan_to_model_p95_mm"), 10),
        "part_opposed": _log(worst("opposed_share"), 0.1),
        "limb_misfit": _log(max(features["limb_misfit"].values()), 1),
        "joint_limits": _log(max(features["joint_limit_excess_rad"].values(), default=0), 0.2),
        "disagreement": _log(max((value for joint, value in features["keypoint_disagreement_m"].items() if joint in seen), default=0), 0.1),
        "inside": _log(features["inside_share"], 0.01),
        "lost_parts": _log(lost, 1),
    }


def fit(x, wrong, bare, names):
    """Weights and bias such that 1 / (1 + exp(bias + x . weights)) is the probability that a fit is right. Right and wrong
    ones count alike, whatever their numbers, and so do bare bodies and others among either."""
    x, wrong = np.asarray(x, float), np.asarray(wrong, float)
    mean, scale = x.mean(0), x.std(0) + 1e-9
    z = (x - mean) / scale
    share = np.zeros(len(wrong))
    for status in (0, 1):
        groups = [own for own in ((wrong == status) & bare, (wrong == status) & ~bare) if own.any()]
        for own in groups:
            share[own] = 0.5 / len(groups) / own.sum()

    def loss(p):
        score = p[0] + z @ p[1:]
        value = np.sum(share * (np.logaddexp(0, score) - wrong * score)) + PENALTY / 2 * p[1:] @ p[1:]
        slope = share * (1 / (1 + np.exp(-score)) - wrong)
        return value, np.concatenate([[slope.sum()], z.T @ slope + PENALTY * p[1:]])

    start = np.zeros(1 + z.shape[1])
    found = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=[(None, None)] + [(None if name in FREE else 0, None) for name in names]).x
    weights = found[1:] / scale
    return float(found[0] - weights @ mean), dict(zip(names, weights))


def confidence(x, bias, weights):
    """x: {name: number}."""
    return float(1 / (1 + np.exp(min(700.0, bias + sum(weights[name] * x[name] for name in weights)))))
