"""Writes a BlazePose graph (keypoints.tflite) as ONNX, channels first throughout."""

import enum

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

OPSET = 12
IR_VERSION = 7


class Dialect(enum.Enum):
    """Which reader the file is for."""

    STANDARD_FP16 = "fp16"  # weights stored as float16, cast once; arithmetic stays float32, so nothing is lost
    OPENCV = "opencv"  # OpenCV 4.6: float32 weights only, Clip with its bounds as attributes (not valid opset 12)


class UnsupportedGraph(Exception):
    """The graph holds something this writer does not translate."""


def _same_padding(size, kernel, stride, dilation):
    """TensorFlow's SAME padding of one axis: (before, after)."""
    extent = (kernel - 1) * dilation + 1
    total = max((-(-size // stride) - 1) * stride + extent - size, 0)
    return total // 2, total - total // 2


class _Writer:
    def __init__(self, graph, dialect):
        self.graph = graph
        self.dialect = dialect
        self.nodes = []
        self.initializers = {}
        self.names = {}  # tensor index -> name of its channels-first value
        self.constants = {k: t.value for k, t in enumerate(graph.tensors) if t.value is not None}

    def initializer(self, name, array):
        self.initializers.setdefault(name, numpy_helper.from_array(np.ascontiguousarray(array), name))
        return name

    def node(self, kind, inputs, **attributes):
        name = "%s_%d" % (kind.lower(), len(self.nodes))
        self.nodes.append(helper.make_node(kind, inputs, [name], name=name, **attributes))
        return name

    def weight(self, name, array):
        if self.dialect is Dialect.OPENCV:
            return self.initializer(name, array.astype(np.float32))
        half = array.astype(np.float16)
        if not np.array_equal(half.astype(np.float32), array.astype(np.float32)):
            raise UnsupportedGraph("constant %s does not fit float16" % name)
        stored = self.initializer(name + "_half", half)
        if not any(name in n.output for n in self.nodes):
            self.nodes.append(helper.make_node("Cast", [stored], [name], name="cast_" + name, to=TensorProto.FLOAT))
        return name

    def activate(self, value, activation):
        if activation == 0:
            return value
        if activation == 1:
            return self.node("Relu", [value])
        if activation != 3:
            raise UnsupportedGraph("activation %d" % activation)
        if self.dialect is Dialect.OPENCV:
            return self.node("Clip", [value], min=0.0, max=6.0)
        return self.node("Clip", [value, self.initializer("zero", np.float32(0)),
                                  self.initializer("six", np.float32(6))])

    def pad(self, value, nhwc):
        n, h, w, c = nhwc
        amounts = [int(axis[side]) for side in (0, 1) for axis in (n, c, h, w)]
        name = "pads_" + "_".join(map(str, amounts))
        return self.node("Pad", [value, self.initializer(name, np.array(amounts, np.int64))], mode="constant")

    def convolution(self, operator):
        options, shape = operator.options, self.graph.tensors[operator.inputs[0]].shape
        value = self.names[operator.inputs[0]]
        weights = self.constants[operator.inputs[1]]
        kernel = weights.shape[1:3]
        if operator.kind == "CONV_2D":
            groups, weights = 1, weights.transpose(0, 3, 1, 2)
        else:
            groups, weights = shape[3], weights.transpose(3, 0, 1, 2)
            if len(weights) != groups:
                raise UnsupportedGraph("depthwise convolution with a depth multiplier")
        padding = [(0, 0), (0, 0)]
        if options["same"]:
            padding = [_same_padding(shape[1 + k], kernel[k], options["stride"][k], options["dilation"][k])
                       for k in range(2)]
        if any(before != after for before, after in padding):
            # OpenCV rejects asymmetric padding inside a convolution.
            value = self.pad(value, [(0, 0), padding[0], padding[1], (0, 0)])
            padding = [(0, 0), (0, 0)]
        inputs = [value, self.weight("w%d" % operator.inputs[1], weights)]
        if len(operator.inputs) > 2 and operator.inputs[2] >= 0:
            inputs.append(self.weight("b%d" % operator.inputs[2], self.constants[operator.inputs[2]]))
        return self.node("Conv", inputs, kernel_shape=list(kernel), strides=list(options["stride"]),
                         dilations=list(options["dilation"]), group=groups,
                         pads=[padding[0][0], padding[1][0], padding[0][1], padding[1][1]])

    def resize(self, operator, output_shape):
        options, shape = operator.options, self.graph.tensors[operator.inputs[0]].shape
        if options["align_corners"] or not options["half_pixel_centers"]:
            raise UnsupportedGraph("bilinear resize other than with half-pixel centres")
        scales = np.array([1, 1, output_shape[1] / shape[1], output_shape[2] / shape[2]], np.float32)
        name = "scales_%g_%g" % (scales[2], scales[3])
        return self.node("Resize", [self.names[operator.inputs[0]],
                                    self.initializer("no_region", np.zeros(0, np.float32)),
                                    self.initializer(name, scales)],
                         mode="linear", coordinate_transformation_mode="half_pixel")

    def reshape(self, operator, output_shape):
        value, shape = self.names[operator.inputs[0]], self.graph.tensors[operator.inputs[0]].shape
        if len(output_shape) == 4:
            raise UnsupportedGraph("reshape to a feature map")
        if len(shape) == 4 and shape[1] * shape[2] > 1:
            value = self.node("Transpose", [value], perm=[0, 2, 3, 1])  # the file's order is channels last
        name = "shape_" + "_".join(map(str, output_shape))
        return self.node("Reshape", [value, self.initializer(name, np.array(output_shape, np.int64))])

    def translate(self, operator):
        kind, options = operator.kind, operator.options
        output = self.graph.tensors[operator.outputs[0]]
        if kind in ("DEQUANTIZE", "DENSIFY"):
            # float16 and sparse storage of constants; both are already undone.
            self.constants[operator.outputs[0]] = self.constants[operator.inputs[0]]
            return
        if kind in ("CONV_2D", "DEPTHWISE_CONV_2D"):
            value = self.convolution(operator)
        elif kind == "ADD":
            value = self.node("Add", [self.names[k] for k in operator.inputs])
        elif kind == "MAX_POOL_2D":
            shape = self.graph.tensors[operator.inputs[0]].shape
            if options["same"] and any(shape[1 + k] % options["stride"][k] or
                                       options["size"][k] != options["stride"][k] for k in range(2)):
                raise UnsupportedGraph("max pooling that needs padding")
            value = self.node("MaxPool", [self.names[operator.inputs[0]]], kernel_shape=list(options["size"]),
                              strides=list(options["stride"]))
        elif kind == "PAD":
            value = self.pad(self.names[operator.inputs[0]], self.constants[operator.inputs[1]])
        elif kind == "RESIZE_BILINEAR":
            value = self.resize(operator, output.shape)
        elif kind == "DEPTH_TO_SPACE":
            value = self.node("DepthToSpace", [self.names[operator.inputs[0]]], blocksize=options["block"], mode="DCR")
        elif kind == "LOGISTIC":
            value = self.node("Sigmoid", [self.names[operator.inputs[0]]])
        elif kind == "RESHAPE":
            value = self.reshape(operator, output.shape)
        elif kind == "CONCATENATION":
            if len(output.shape) == 4:
                raise UnsupportedGraph("concatenation of feature maps")
            value = self.node("Concat", [self.names[k] for k in operator.inputs], axis=options["axis"])
        else:
            raise UnsupportedGraph("operator %s" % kind)
        self.names[operator.outputs[0]] = self.activate(value, options.get("activation", 0))

    def needed_nodes(self, outputs):
        """The nodes that the named outputs need, in order."""
        needed, kept = set(outputs), []
        for node in reversed(self.nodes):
            if any(name in needed for name in node.output):
                kept.append(node)
                needed.update(node.input)
        return kept[::-1], needed


def write(graph, dialect, output_names, keep):
    """ONNX model of `graph` with input `image` and the outputs of `output_names` (in graph order) that are in `keep`.

    Outputs come in the order of `keep`. Raises UnsupportedGraph.
    """
    if len(output_names) != len(graph.outputs):
        raise UnsupportedGraph("expected %d outputs, the graph has %d" % (len(output_names), len(graph.outputs)))
    writer = _Writer(graph, dialect)
    batch, height, width, channels = graph.tensors[graph.inputs[0]].shape
    writer.names[graph.inputs[0]] = "image"
    for operator in graph.operators:
        writer.translate(operator)

    indices = dict(zip(output_names, graph.outputs))
    internal = {writer.names[indices[name]]: name for name in keep}
    nodes, needed = writer.needed_nodes(internal)
    outputs = []
    for name in keep:
        shape = graph.tensors[indices[name]].shape
        if len(shape) == 4:
            shape = [shape[0], shape[3], shape[1], shape[2]]
        outputs.append(helper.make_tensor_value_info(name, TensorProto.FLOAT, shape))
    for node in nodes:
        for names in (node.input, node.output):
            for k, name in enumerate(names):
                names[k] = internal.get(name, name)

    onnx_graph = helper.make_graph(
        nodes, "blazepose",
        [helper.make_tensor_value_info("image", TensorProto.FLOAT, [batch, channels, height, width])], outputs,
        [value for name, value in writer.initializers.items() if name in needed])
    model = helper.make_model(onnx_graph, opset_imports=[helper.make_opsetid("", OPSET)], producer_name="vitruvian")
    model.ir_version = IR_VERSION
    if dialect is not Dialect.OPENCV:
        onnx.checker.check_model(model, full_check=True)
    return model
