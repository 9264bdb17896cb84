"""A population of adult characters: parameters drawn and calibrated to realistic stature and body mass index."""
import numpy as np
from scipy.special import ndtri

from .package import CUBES, SKIN
from .surface import mirror_partners

DENSITY = 985.0  # kg/m^3, whole body
# Population (US and European surveys, rounded): mean and standard deviation of stature in metres, median and
# logarithmic deviation of the body mass index in kg/m^2.
STATURE = {"female": (1.625, 0.072), "male": (1.755, 0.076)}
STATURE_RANGE = (1.40, 2.10)
BMI = {"female": (25.8, 0.20), "male": (26.3, 0.175)}
BMI_RANGE = (16.5, 43.0)
ASYMMETRY_SD = 0.03
# Share of the characters in which targets that are not admitted are left out; in the others they are completed.
LEFT_OUT_SHARE = 0.4
# Offsets of single modifiers (female, male) that bring hip and waist girths and arm span nearer to the surveys.
DETAIL_MEAN = {
    "hip/hip-scale-horiz": (-0.4, -0.3),
    "hip/hip-scale-depth": (-0.2, -0.2),
    "measure/measure-waist": (0.4, 0.3),
    "armslegs/*-upperarm-scale-horiz": (0.2, 0.07),
    "armslegs/*-lowerarm-scale-horiz": (0.2, 0.07),
}


class Shapes:
    """The characters' skin, restricted to some vertices, and their joint cubes as linear functions of source weights.

    Coordinates are planar: rows 0..V-1 hold x, V..2V-1 y, 2V..3V-1 z; one column a character.
    """

    def __init__(self, package, sources, vertices, joint_lists):
        """vertices: indices into the skin. joint_lists: a joint's rig joints, each a list of package vertices."""
        partner = mirror_partners(package.skin)
        self.base = package.skin[vertices].T.reshape(-1, 1).astype(np.float32)
        self.basis = np.empty((len(sources), 3 * len(vertices)), np.float32)
        rows_of = {i: k for k, i in enumerate([*range(SKIN.start, SKIN.stop), *range(CUBES.start, CUBES.stop)])}
        selector = np.zeros((len(joint_lists), len(rows_of)))
        for row, lists in zip(selector, joint_lists):
            for ids in lists:
                for i in ids:
                    row[rows_of[i]] += 1 / len(ids) / len(lists)
        self.joint_base = selector @ np.concatenate([package.skin, package.cubes])
        self.joint_basis = np.full((len(sources), len(joint_lists), 3), np.nan)
        for k, (name, mirrored) in enumerate(sources):
            skin, cubes = package.skin_target(name), package.cube_target(name)
            if mirrored:
                skin = skin[partner] * np.array([-1, 1, 1], np.float32)
                cubes = None
            self.basis[k] = skin[vertices].T.ravel()
            if cubes is not None:
                self.joint_basis[k] = selector @ np.concatenate([skin, cubes])
        self.joints_known = ~np.isnan(self.joint_basis[:, 0, 0])

    def skin(self, weights):
        """Planar coordinates [3V,N] float32 in metres."""
        out = self.basis.T @ weights.T
        out += self.base
        return out

    def joints(self, weights):
        """Joint centres [N,J,3] from the cubes. Weights of sources without known joints must be 0."""
        known = self.joints_known
        if np.abs(weights[:, ~known]).max(initial=0) > 0:
            raise ValueError("joint cubes of a used target are not admitted")
        return self.joint_base + np.einsum("ns,sjc->njc", weights[:, known].astype(float), self.joint_basis[known])


def draw(modifiers, count, rng, detail_mean=None, left_out_share=LEFT_OUT_SHARE):
    """Random adult parameters: half women, half men, 18 to 82 years. Height and weight are left to `calibrated`.

    detail_mean: offsets of modifiers (female, male), by default DETAIL_MEAN.
    """
    male = rng.random(count) < 0.5
    androgyny = np.abs(rng.normal(0, 0.07, count))
    age = np.clip((rng.triangular(18, 30, 82, count) - 25) / 65, 0, 1)
    muscle = np.where(male, rng.normal(0.5, 0.2, count), rng.normal(0.42, 0.18, count)).clip(0.05, 0.95)
    means = DETAIL_MEAN if detail_mean is None else detail_mean
    centre = np.zeros((2, len(modifiers.detail_names)))
    for name, by_sex in means.items():
        centre[:, modifiers.detail_names.index(name)] = by_sex

    def by_sex(table, k):
        return np.where(male, table["male"][k], table["female"][k])

    # Normal quantiles in random order: the spread of stature and BMI is exact in every draw.
    normal = np.empty((2, count))
    for members in (np.nonzero(male)[0], np.nonzero(~male)[0]):
        for row in normal:
            row[members] = ndtri((rng.permutation(len(members)) + 0.5) / max(len(members), 1))
    detail = centre[male.astype(int)] + rng.normal(size=(count, len(centre[0]))) * modifiers.detail_sd
    return {
        "male": male,
        "gender": np.where(male, 1 - androgyny, androgyny).clip(0, 1),
        "age": age,
        "muscle": muscle,
        "weight": np.full(count, 0.7),
        "height": np.full(count, 0.5),
        "proportions": rng.normal(0.5, 0.22, count).clip(0, 1),
        "cup": rng.normal(0.5, 0.22, count).clip(0, 1),
        "firmness": (rng.normal(0.55, 0.2, count) - 0.25 * age).clip(0, 1),
        "race": rng.dirichlet([0.6, 0.6, 0.6], count),
        "detail": detail.clip(-1, 1),
        "asymmetry": rng.normal(0, ASYMMETRY_SD, (count, len(centre[0]))),
        "stature": (by_sex(STATURE, 0) + by_sex(STATURE, 1) * normal[0]).clip(*STATURE_RANGE),
        "completed": (rng.random(count) >= left_out_share).astype(float),
        "bmi": (by_sex(BMI, 0) * np.exp(by_sex(BMI, 1) * normal[1])).clip(*BMI_RANGE),
    }


def statures(planar):
    """Crown to sole, [N]."""
    y = planar[len(planar) // 3 : 2 * len(planar) // 3]
    return y.max(0) - y.min(0)


def volumes(planar, faces, block=128):
    """Volumes [N] of a closed mesh in many shapes: the flux of (0, 0, z)."""
    x, y, z = planar.reshape(3, -1, planar.shape[1])
    out = np.empty(planar.shape[1])
    for begin in range(0, len(out), block):
        s = slice(begin, begin + block)
        (x0, x1, x2), (y0, y1, y2) = (np.ascontiguousarray(c[:, s])[faces.T] for c in (x, y))
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        height = np.ascontiguousarray(z[:, s])[faces.T].sum(0)
        out[s] = np.einsum("fn,fn->n", area, height, dtype=np.float64) / 6
    return out


def calibrated(modifiers, shapes, faces, p, rounds=8):
    """Solves height and weight parameters for the drawn stature and BMI; changes p. Returns (weights, planar skin)."""
    previous = None
    for k in range(rounds + 1):
        weights = modifiers.weights(p)
        planar = shapes.skin(weights)
        if k == rounds:
            break
        stature = statures(planar)
        bmi = volumes(planar, faces) * DENSITY / stature**2
        # The package's stature per unit of its height parameter: about 0.73 m below 0.5 and 1.44 m above.
        p["height"] = p["height"] + (p["stature"] - stature) / np.where(p["height"] > 0.5, 1.44, 0.73)
        lack = p["bmi"] - bmi
        if previous is None:
            step = lack / 10
        else:
            change = p["weight"] - previous[0]
            slope = (bmi - previous[1]) / np.where(np.abs(change) < 1e-6, 1e-6, change)
            step = lack / np.clip(slope, 4, 45)
        previous = (p["weight"], bmi)
        p["weight"] = (p["weight"] + step.clip(-0.4, 0.4)).clip(-0.15, 1.35)
        # Muscle is heavy in the package: who cannot get heavy by weight alone has less of it.
        stuck = (p["weight"] >= 1.349) & (lack > 0.5)
        p["muscle"] = np.where(stuck, (p["muscle"] - 0.12).clip(0, 1), p["muscle"])
    return weights, planar
