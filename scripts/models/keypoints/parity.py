#!/usr/bin/python3
"""Fixed inputs of the keypoint networks and what TFLite makes of them.

usage: parity.py write DIR           raw inputs for tflite_reference.mjs
       parity.py pack DIR OUT.json   the reference file from its raw outputs

Inputs are the images beside the reference file (tests/data/keypoints) and two integer patterns, so that Python, C++ and
JavaScript build the same tensors. The reference holds every 61st heatmap value (61 is prime to 64, so all channels, rows
and columns occur), and the boxes of the 24 best anchors.
"""

import json
import pathlib
import sys

import numpy as np
from PIL import Image

DATA = pathlib.Path(__file__).resolve().parents[3] / "tests" / "data" / "keypoints"
SIZES = {"landmarks": 256, "detector": 224}
INPUTS = {"landmarks": ["front.png", "oblique.png", "noise", "blocks"], "detector": ["front224.png", "noise", "blocks"]}
OUTPUTS = {"landmarks": {"landmarks": 195, "presence": 1, "heatmap": 39 * 64 * 64},
           "detector": {"boxes": 2254 * 12, "scores": 2254}}
HEATMAP_STRIDE = 61
BEST_ANCHORS = 24


def pattern(name, size):
    """A size x size x 3 image of bytes, from integer arithmetic alone."""
    y, x, c = np.meshgrid(*(np.arange(n, dtype=np.uint64) for n in (size, size, 3)), indexing="ij")
    if name == "blocks":
        return ((x // 16 + y // 16 + c) % 4 * 85).astype(np.uint8)
    if name != "noise":
        raise ValueError("no pattern named " + name)
    word = np.uint64(0xFFFFFFFF)
    value = ((x * 73856093) ^ (y * 19349663) ^ (c * 83492791)) & word
    value = ((value ^ (value >> np.uint64(13))) * 0x5BD1E995) & word
    return ((value ^ (value >> np.uint64(15))) & np.uint64(255)).astype(np.uint8)


def image(name, network):
    size = SIZES[network]
    if not name.endswith(".png"):
        return pattern(name, size)
    pixels = np.asarray(Image.open(DATA / name).convert("RGB"))
    if pixels.shape != (size, size, 3):
        raise ValueError("%s: expected %d x %d pixels" % (name, size, size))
    return pixels


def tensor(name, network):
    """size x size x 3 float32, channels last, as the network wants its values."""
    pixels = image(name, network).astype(np.float32)
    return pixels / np.float32(255) if network == "landmarks" else pixels / np.float32(127.5) - np.float32(1)


def _raw(folder, network, name, output):
    return folder / ("%s.%s.%s.f32" % (network, name, output))


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for network, names in INPUTS.items():
        for name in names:
            tensor(name, network).tofile(_raw(folder, network, name, "image"))
    jobs = [{"network": network, "name": name, "outputs": OUTPUTS[network]}
            for network, names in INPUTS.items() for name in names]
    (folder / "jobs.json").write_text(json.dumps(jobs))


def summary(network, outputs):
    """What the reference file keeps of one run's outputs (name -> flat float array)."""
    if network == "landmarks":
        return {"landmarks": outputs["landmarks"], "presence": outputs["presence"],
                "heatmap": outputs["heatmap"][::HEATMAP_STRIDE]}
    anchors = np.argsort(-outputs["scores"], kind="stable")[:BEST_ANCHORS]
    return {"scores": outputs["scores"], "anchors": anchors, "boxes": outputs["boxes"].reshape(-1, 12)[anchors].ravel()}


def pack(folder, destination):
    reference = {"heatmap_stride": HEATMAP_STRIDE, "runs": []}
    for network, names in INPUTS.items():
        for name in names:
            outputs = {}
            for output, size in OUTPUTS[network].items():
                values = np.fromfile(_raw(folder, network, name, output), "<f4")
                if len(values) != size:
                    raise ValueError("%s of %s: expected %d values, found %d" % (output, name, size, len(values)))
                if output == "heatmap":  # TFLite's is channels last
                    values = values.reshape(64, 64, 39).transpose(2, 0, 1).ravel()
                outputs[output] = values
            kept = {key: [round(float(v), 5) if values.dtype.kind == "f" else int(v) for v in values]
                    for key, values in summary(network, outputs).items()}
            reference["runs"].append({"network": network, "input": name, **kept})
    destination.write_text(json.dumps(reference, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "write":
        write(pathlib.Path(sys.argv[2]))
    elif len(sys.argv) == 4 and sys.argv[1] == "pack":
        pack(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
    else:
        sys.exit(__doc__)
