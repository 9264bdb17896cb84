"""Reader for TFLite models (FlatBuffer schema "TFL3"), without generated code.

Reads what the BlazePose models use: one static graph, float16 or float32 constants, block-sparse constants. Slot
numbers below are field positions in TensorFlow Lite's public schema.fbs.
"""

import dataclasses
import struct

import numpy as np


class FormatError(Exception):
    """The file is not a TFLite model, or uses something that no BlazePose model uses."""


class Table:
    """A FlatBuffer table at absolute position `position` of `data`."""

    def __init__(self, data, position):
        self.data = data
        self.position = position
        self.vtable = position - struct.unpack_from("<i", data, position)[0]
        self.vtable_size = struct.unpack_from("<H", data, self.vtable)[0]

    def _field(self, slot):
        """Absolute position of a field, or None when it holds its default."""
        entry = 4 + 2 * slot
        if entry >= self.vtable_size:
            return None
        offset = struct.unpack_from("<H", self.data, self.vtable + entry)[0]
        return self.position + offset if offset else None

    def _target(self, position):
        return position + struct.unpack_from("<I", self.data, position)[0]

    def scalar(self, slot, kind="<i", default=0):
        position = self._field(slot)
        return default if position is None else struct.unpack_from(kind, self.data, position)[0]

    def table(self, slot):
        position = self._field(slot)
        return None if position is None else Table(self.data, self._target(position))

    def _vector(self, slot):
        position = self._field(slot)
        if position is None:
            return 0, 0
        start = self._target(position)
        return start + 4, struct.unpack_from("<I", self.data, start)[0]

    def array(self, slot, dtype="<i4"):
        start, count = self._vector(slot)
        return np.frombuffer(self.data, dtype, count, start) if count else np.zeros(0, dtype)

    def tables(self, slot):
        start, count = self._vector(slot)
        return [Table(self.data, self._target(start + 4 * k)) for k in range(count)]

    def text(self, slot):
        start, count = self._vector(slot)
        return self.data[start:start + count].decode()


OPERATORS = {
    0: "ADD", 2: "CONCATENATION", 3: "CONV_2D", 4: "DEPTHWISE_CONV_2D", 5: "DEPTH_TO_SPACE", 6: "DEQUANTIZE",
    14: "LOGISTIC", 17: "MAX_POOL_2D", 22: "RESHAPE", 23: "RESIZE_BILINEAR", 34: "PAD", 124: "DENSIFY",
}
ELEMENT_TYPES = {0: np.float32, 1: np.float16, 2: np.int32}
INDEX_TYPES = {1: "<i4", 2: "<u2", 3: "u1"}  # union SparseIndexVector


@dataclasses.dataclass
class Tensor:
    name: str
    shape: list
    value: np.ndarray  # None unless constant


@dataclasses.dataclass
class Operator:
    kind: str
    inputs: list
    outputs: list
    options: dict


@dataclasses.dataclass
class Graph:
    tensors: list
    operators: list
    inputs: list
    outputs: list


def _densify(values, shape, sparsity):
    """Dense array of a block-sparse constant (SparsityParameters: 0 traversal order, 1 block map, 2 dimensions).

    The first len(shape) levels are the tensor's own dimensions (counted in blocks where one is blocked), the rest the
    dimensions inside a block; each level is dense or compressed (segments and indices, as in CSR).
    """
    order = sparsity.array(0)
    block_map = sparsity.array(1)
    rank = len(shape)
    coordinates = np.zeros((1, 0), np.int64)  # of the stored elements so far, by level
    parents = np.zeros(1, np.int64)  # index of each within its level
    dense_sizes = []
    for dimension in sparsity.tables(2):
        compressed = dimension.scalar(0, "<b") == 1
        dense_sizes.append(dimension.scalar(1))
        if compressed:
            segments = dimension.table(3).array(0, INDEX_TYPES[dimension.scalar(2, "<B")]).astype(np.int64)
            indices = dimension.table(5).array(0, INDEX_TYPES[dimension.scalar(4, "<B")]).astype(np.int64)
            starts = segments[parents]
            counts = segments[parents + 1] - starts
            repeat = np.repeat(np.arange(len(parents)), counts)
            within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
            parents = starts[repeat] + within
            coordinates = np.concatenate([coordinates[repeat], indices[parents][:, None]], axis=1)
        else:
            size = dense_sizes[-1]
            steps = np.tile(np.arange(size), len(parents))
            coordinates = np.concatenate([np.repeat(coordinates, size, axis=0), steps[:, None]], axis=1)
            parents = np.repeat(parents, size) * size + steps
    if len(coordinates) != len(values):
        raise FormatError("a sparse constant of shape %s stores %d values where its index lists %d"
                          % (shape, len(values), len(coordinates)))
    index = np.zeros((len(values), rank), np.int64)
    for level in range(rank):
        index[:, order[level]] = coordinates[:, level]
    for level in range(rank, len(order)):
        blocked = block_map[order[level] - rank]
        index[:, blocked] = index[:, blocked] * dense_sizes[level] + coordinates[:, level]
    dense = np.zeros(shape, values.dtype)
    dense[tuple(index.T)] = values
    return dense


def _options(kind, table):
    """Options of an operator by name; activations: 0 none, 1 ReLU, 3 ReLU6."""
    if table is None:
        return {}
    if kind == "CONV_2D":
        return {"same": table.scalar(0, "<b") == 0, "stride": (table.scalar(2), table.scalar(1)),
                "activation": table.scalar(3, "<b"), "dilation": (table.scalar(5, default=1), table.scalar(4, default=1))}
    if kind == "DEPTHWISE_CONV_2D":
        return {"same": table.scalar(0, "<b") == 0, "stride": (table.scalar(2), table.scalar(1)),
                "activation": table.scalar(4, "<b"), "dilation": (table.scalar(6, default=1), table.scalar(5, default=1))}
    if kind == "MAX_POOL_2D":
        return {"same": table.scalar(0, "<b") == 0, "stride": (table.scalar(2), table.scalar(1)),
                "size": (table.scalar(4), table.scalar(3)), "activation": table.scalar(5, "<b")}
    if kind == "ADD":
        return {"activation": table.scalar(0, "<b")}
    if kind == "CONCATENATION":
        return {"axis": table.scalar(0), "activation": table.scalar(1, "<b")}
    if kind == "RESIZE_BILINEAR":
        return {"align_corners": table.scalar(2, "<b"), "half_pixel_centers": table.scalar(3, "<b")}
    if kind == "DEPTH_TO_SPACE":
        return {"block": table.scalar(0)}
    return {}


def read(data):
    """Graph of a TFLite file's bytes, all tensors NHWC as stored. Raises FormatError."""
    if data[4:8] != b"TFL3":
        raise FormatError("not a TFLite model: the magic TFL3 is missing at byte 4")
    model = Table(data, struct.unpack_from("<I", data, 0)[0])
    subgraphs = model.tables(2)
    if len(subgraphs) != 1:
        raise FormatError("expected one subgraph, found %d" % len(subgraphs))
    subgraph = subgraphs[0]
    buffers = model.tables(4)

    kinds = []
    for code in model.tables(1):
        number = max(code.scalar(0, "<b"), code.scalar(3))  # old files hold it in the first field, new ones in both
        if number not in OPERATORS:
            raise FormatError("operator %d is not one that BlazePose uses" % number)
        kinds.append(OPERATORS[number])

    tensors = []
    for table in subgraph.tables(0):
        shape = [int(v) for v in table.array(0)]
        value = None
        raw = buffers[table.scalar(2, "<I")].array(0, "u1")
        if len(raw):
            element = table.scalar(1, "<b")
            if element not in ELEMENT_TYPES:
                raise FormatError("tensor %s has element type %d" % (table.text(3), element))
            value = raw.view(ELEMENT_TYPES[element])
            sparsity = table.table(6)
            value = value.reshape(shape) if sparsity is None else _densify(value, shape, sparsity)
        tensors.append(Tensor(table.text(3), shape, value))

    operators = []
    for table in subgraph.tables(3):
        kind = kinds[table.scalar(0, "<I")]
        operators.append(Operator(kind, [int(v) for v in table.array(1)], [int(v) for v in table.array(2)],
                                  _options(kind, table.table(4))))
    return Graph(tensors, operators, [int(v) for v in subgraph.array(1)], [int(v) for v in subgraph.array(2)])
