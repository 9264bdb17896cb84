"""The converted keypoint networks: their structure, and their values against the TFLite runtime's."""

import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import onnx
from onnx import numpy_helper

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "models"))

from keypoints import parity, tflite  # noqa: E402

MODELS = pathlib.Path(os.environ.get("VITRUVIAN_DATA", ROOT / "models" / "generated"))


def model(network, dialect):
    path = MODELS / ("blazepose_%s.%s.onnx" % (network, dialect))
    if not path.is_file():
        raise FileNotFoundError("%s is missing: run scripts/models/make_keypoint_networks.py" % path)
    return onnx.load(str(path))


def evaluate(network, image):
    """Outputs of an ONNX model by name, computed with torch; only the operators that the networks use."""
    import torch
    from torch.nn import functional

    values = {i.name: torch.from_numpy(np.array(numpy_helper.to_array(i))) for i in network.graph.initializer}
    values["image"] = torch.from_numpy(image)
    for node in network.graph.node:
        a = {k.name: onnx.helper.get_attribute_value(k) for k in node.attribute}
        x = [values[name] for name in node.input]
        if node.op_type == "Cast":
            y = x[0].float()
        elif node.op_type == "Conv":
            if a["pads"][:2] != a["pads"][2:]:
                raise ValueError("asymmetric padding in a convolution")
            y = functional.conv2d(x[0], x[1], x[2] if len(x) > 2 else None, a["strides"], a["pads"][:2], a["dilations"],
                                  a["group"])
        elif node.op_type == "Clip":
            y = x[0].clamp(a.get("min", 0.0), a.get("max", 6.0)) if a else x[0].clamp(float(x[1]), float(x[2]))
        elif node.op_type == "Add":
            y = x[0] + x[1]
        elif node.op_type == "MaxPool":
            y = functional.max_pool2d(x[0], a["kernel_shape"], a["strides"])
        elif node.op_type == "Pad":
            begin, end = x[1][:4].tolist(), x[1][4:].tolist()
            y = functional.pad(x[0], [p for axis in (3, 2, 1, 0) for p in (begin[axis], end[axis])])
        elif node.op_type == "Resize":
            y = functional.interpolate(x[0], scale_factor=x[2][2:].tolist(), mode="bilinear", align_corners=False)
        elif node.op_type == "DepthToSpace":
            n, c, h, w = x[0].shape
            b = a["blocksize"]
            y = x[0].reshape(n, b, b, c // b // b, h, w).permute(0, 3, 4, 1, 5, 2).reshape(n, -1, h * b, w * b)
        elif node.op_type == "Reshape":
            y = x[0].reshape(x[1].tolist())
        elif node.op_type == "Transpose":
            y = x[0].permute(a["perm"])
        elif node.op_type == "Concat":
            y = torch.cat(x, a["axis"])
        elif node.op_type == "Sigmoid":
            y = x[0].sigmoid()
        else:
            raise ValueError("operator " + node.op_type)
        values[node.output[0]] = y
    return {o.name: values[o.name].numpy().ravel() for o in network.graph.output}


class StructureTest(unittest.TestCase):
    def test_interface(self):
        shapes = {"landmarks": {"image": [1, 3, 256, 256], "landmarks": [1, 195], "presence": [1, 1],
                                "heatmap": [1, 39, 64, 64]},
                  "detector": {"image": [1, 3, 224, 224], "boxes": [1, 2254, 12], "scores": [1, 2254, 1]}}
        for network, expected in shapes.items():
            for dialect in ("fp16", "opencv"):
                graph = model(network, dialect).graph
                found = {v.name: [d.dim_value for d in v.type.tensor_type.shape.dim]
                         for v in list(graph.input) + list(graph.output)}
                self.assertEqual(found, expected, (network, dialect))
                self.assertEqual(list(found), list(expected), "outputs are in another order")

    def test_standard_file_is_valid_onnx(self):
        for network in parity.INPUTS:
            onnx.checker.check_model(model(network, "fp16"), full_check=True)

    def test_opencv_file_keeps_to_what_opencv_reads(self):
        for network in parity.INPUTS:
            graph = model(network, "opencv").graph
            self.assertNotIn(onnx.TensorProto.FLOAT16, {i.data_type for i in graph.initializer})
            self.assertTrue(all(len(n.input) == 1 for n in graph.node if n.op_type == "Clip"))

    def test_both_dialects_hold_the_same_weights(self):
        for network in parity.INPUTS:
            half = {i.name: numpy_helper.to_array(i) for i in model(network, "fp16").graph.initializer}
            full = {i.name: numpy_helper.to_array(i) for i in model(network, "opencv").graph.initializer}
            weights = [name for name in half if name.endswith("_half")]
            self.assertGreater(len(weights), 100)
            for name in weights:
                np.testing.assert_array_equal(half[name].astype(np.float32), full[name[:-len("_half")]])


class ParityTest(unittest.TestCase):
    """Against tests/data/keypoints/networks.json, which the TFLite C++ runtime made."""

    @classmethod
    def setUpClass(cls):
        cls.reference = json.loads((parity.DATA / "networks.json").read_text())

    def run_all(self, network, tolerances):
        loaded = model(network, "fp16")
        runs = [r for r in self.reference["runs"] if r["network"] == network]
        self.assertEqual([r["input"] for r in runs], parity.INPUTS[network])
        for run in runs:
            image = np.ascontiguousarray(parity.tensor(run["input"], network).transpose(2, 0, 1)[None])
            outputs = evaluate(loaded, image)
            if network == "detector":
                boxes = outputs["boxes"].reshape(-1, 12)[run["anchors"]].ravel()
                found = {"scores": outputs["scores"], "boxes": boxes}
            else:
                found = parity.summary(network, outputs)
            for name, tolerance in tolerances.items():
                np.testing.assert_allclose(found[name], run[name], rtol=0, atol=tolerance,
                                           err_msg="%s of %s" % (name, run["input"]))

    def test_landmarks(self):
        self.run_all("landmarks", {"landmarks": 0.02, "presence": 1e-4, "heatmap": 0.005})

    def test_detector(self):
        self.run_all("detector", {"scores": 0.005, "boxes": 0.01})


class MakerTest(unittest.TestCase):
    MAKER = ROOT / "scripts" / "models" / "make_keypoint_networks.py"

    def run_maker(self, package, out):
        return subprocess.run([sys.executable, str(self.MAKER), "--package", str(package), "--out", str(out)],
                              capture_output=True, text=True, check=False)

    def test_refuses_a_missing_or_changed_package(self):
        with tempfile.TemporaryDirectory() as folder:
            package, out = pathlib.Path(folder) / "package", pathlib.Path(folder) / "out"
            package.mkdir()
            result = self.run_maker(package, out)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("pose_landmark_full.tflite: No such file", result.stderr)
            (package / "pose_landmark_full.tflite").write_bytes(b"TFL3" * 100)
            result = self.run_maker(package, out)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("expected e9a5c5cb", result.stderr)
            self.assertEqual(list(out.iterdir()), [])


class TfliteReaderTest(unittest.TestCase):
    def test_refuses_what_is_not_tflite(self):
        for data in (b"", b"TFL3", bytes(64)):
            with self.assertRaises(tflite.FormatError):
                tflite.read(data)

    def test_block_sparse_constant(self):
        # A 4 x 4 matrix in 2 x 2 blocks, block rows dense, block columns compressed; the lower left block is absent.
        class Fields:
            def __init__(self, *fields):
                self.fields = fields

            def scalar(self, slot, kind=None, default=0):
                return self.fields[slot]

            array = table = tables = lambda self, slot, dtype=None: self.fields[slot]

        def indices(*values):
            return Fields(np.array(values, np.uint8))

        dense = Fields(0, 2, 0, None, 0, None)
        compressed = Fields(1, 0, 3, indices(0, 2, 3), 3, indices(0, 1, 1))
        sparsity = Fields(np.array([0, 1, 2, 3]), np.array([0, 1]), [dense, compressed, dense, dense])
        stored = np.arange(1, 13, dtype=np.float16)
        np.testing.assert_array_equal(
            tflite._densify(stored, [4, 4], sparsity),
            [[1, 2, 5, 6], [3, 4, 7, 8], [0, 0, 9, 10], [0, 0, 11, 12]])
        with self.assertRaises(tflite.FormatError):
            tflite._densify(stored[:-1], [4, 4], sparsity)

    def test_patterns_are_fixed(self):
        # The C++ tests build the same patterns; their bytes must never change.
        digest = hashlib.sha256(parity.pattern("noise", 256).tobytes() + parity.pattern("blocks", 224).tobytes())
        self.assertEqual(digest.hexdigest(), "973120099e8b14541c127846e2d89d98695bb6bd00d6fd4394e21f0dadd59c92")


if __name__ == "__main__":
    unittest.main()
