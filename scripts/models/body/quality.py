"""Figures by which a made body is judged."""
import numpy as np

from .characters import DENSITY
from .correctives import corrected
from .posing import POSES, dual_quaternion_blend, linear_blend, skinning_transforms
from .surface import volume


def residual_figures(residuals, area):
    """Area-weighted mean, vertex percentile and maxima of distances [N,V] in mm."""
    return {
        "area_mean_mm": round(float((residuals @ (area / area.sum())).mean()), 3),
        "vertex_p95_mm": round(float(np.percentile(residuals, 95)), 2),
        "mean_of_max_mm": round(float(residuals.max(1).mean()), 1),
        "max_mm": round(float(residuals.max()), 1),
    }


def population_figures(mean, directions, faces, prior_mean, prior_precision, rng, count=400):
    """Stature, BMI and span to stature of bodies drawn from a prior: means and standard deviations."""
    root = np.linalg.cholesky(np.linalg.inv(prior_precision))
    beta = prior_mean + rng.normal(size=(count, len(prior_mean))) @ root.T
    stature, span, bmi = np.empty(count), np.empty(count), np.empty(count)
    shapes = mean.astype(np.float32) + np.tensordot(beta.astype(np.float32), directions.astype(np.float32), 1)
    for i, v in enumerate(shapes):
        stature[i], span[i] = np.ptp(v[:, 1]), np.ptp(v[:, 0])
        bmi[i] = volume(v, faces) * DENSITY / stature[i] ** 2
    ratio = span / stature * 100
    figures = {"stature_mm": stature * 1e3, "bmi": bmi, "span_to_stature_percent": ratio}
    return {name: [round(float(x.mean()), 2), round(float(x.std()), 2)] for name, x in figures.items()}


def volume_figures(mean, joints, weights, faces, vertex, joint, block):
    """Volume change in percent by pose: linear blending, dual quaternions, linear blending with correctives."""
    rest, out = volume(mean, faces), {}
    for name, turns in POSES.items():
        transforms = skinning_transforms(joints, turns)
        shapes = (
            linear_blend(mean, weights, transforms),
            dual_quaternion_blend(mean, weights, transforms),
            linear_blend(corrected(mean, turns, vertex, joint, block), weights, transforms),
        )
        out[name] = [round((volume(s, faces) / rest - 1) * 100, 2) for s in shapes]
    return out
