"""Writer and reader of the project's container for numeric arrays (format: models/README.md, "Array file")."""
import hashlib
import os
import struct
import zlib

import numpy as np

MAGIC = b"VITRUARR"
VERSION = 1
HEADER = struct.Struct("<8sI4sQ32s")
HASHED_FROM = HEADER.size
COUNT = struct.Struct("<II")
ENTRY = struct.Struct("<32sII4IIIQQ8x")
TYPES = [np.dtype(t) for t in ("u1", "i1", "<u2", "<i2", "<u4", "<i4", "<f2", "<f4", "<f8")]
STORED, SHUFFLED_ZLIB = 0, 1


class ArrayFileError(ValueError):
    """The file is not an array file of the expected kind, or it is damaged."""


def _type_code(array):
    for code, dtype in enumerate(TYPES):
        if array.dtype.newbyteorder("<") == dtype:
            return code
    raise ArrayFileError(f"no array type for {array.dtype}")


def _shuffled(raw, item_size):
    return np.frombuffer(raw, np.uint8).reshape(-1, item_size).T.tobytes()


def _unshuffled(raw, item_size):
    return np.frombuffer(raw, np.uint8).reshape(item_size, -1).T.tobytes()


def encode(kind, arrays):
    """Bytes of an array file.

    kind: four ASCII characters. arrays: {name: array or text}; text is stored as u8. Every array is compressed if that
    makes it smaller.
    """
    entries, payloads = [], []
    offset = HASHED_FROM + COUNT.size + ENTRY.size * len(arrays)
    for name, value in arrays.items():
        array = np.frombuffer(value.encode(), np.uint8) if isinstance(value, str) else np.asarray(value)
        code = _type_code(array)
        if not 1 <= array.ndim <= 4 or len(name.encode("ascii")) > 31:
            raise ArrayFileError(f"{name}: rank {array.ndim} or name length out of range")
        raw = np.ascontiguousarray(array, TYPES[code]).tobytes()
        packed = zlib.compress(_shuffled(raw, TYPES[code].itemsize), 9)
        encoding, payload = (SHUFFLED_ZLIB, packed) if len(packed) < len(raw) else (STORED, raw)
        payload_padding = -len(payload) % 8
        shape = list(array.shape) + [1] * (4 - array.ndim)
        entries.append(ENTRY.pack(name.encode("ascii"), code, array.ndim, *shape, encoding, 0, offset, len(payload)))
        payloads.append(payload + bytes(payload_padding))
        offset += len(payload) + payload_padding
    body = COUNT.pack(len(arrays), 0) + b"".join(entries) + b"".join(payloads)
    return HEADER.pack(MAGIC, VERSION, kind.encode("ascii"), offset, hashlib.sha256(body).digest()) + body


def decode(data, kind):
    """{name: array} of an array file's bytes, in the file's order, integers as stored."""
    if len(data) < HASHED_FROM + COUNT.size:
        raise ArrayFileError("shorter than an array file's header")
    magic, version, found_kind, size, digest = HEADER.unpack_from(data)
    if magic != MAGIC or version != VERSION:
        raise ArrayFileError("not an array file of version 1")
    if found_kind != kind.encode("ascii"):
        raise ArrayFileError(f"kind is {found_kind!r}, not {kind!r}")
    if size != len(data) or hashlib.sha256(data[HASHED_FROM:]).digest() != digest:
        raise ArrayFileError("truncated or damaged: size or SHA-256 differs")
    count, _ = COUNT.unpack_from(data, HASHED_FROM)
    arrays = {}
    for k in range(count):
        fields = ENTRY.unpack_from(data, HASHED_FROM + COUNT.size + k * ENTRY.size)
        name, code, rank = fields[0].rstrip(b"\0").decode("ascii"), fields[1], fields[2]
        shape, encoding, offset, stored = fields[3:7], fields[7], fields[9], fields[10]
        payload = data[offset : offset + stored]
        if encoding == SHUFFLED_ZLIB:
            payload = _unshuffled(zlib.decompress(payload), TYPES[code].itemsize)
        arrays[name] = np.frombuffer(payload, TYPES[code]).reshape(shape[:rank])
    return arrays


def write(path, kind, arrays):
    """Writes an array file under a temporary name and renames it, so that no reader sees half a file."""
    data = encode(kind, arrays)
    temporary = f"{path}.part"
    with open(temporary, "wb") as f:
        f.write(data)
    os.replace(temporary, path)
    return len(data)


def read(path, kind):
    """{name: array} of the file at path, integers as stored. Raises ArrayFileError."""
    with open(path, "rb") as f:
        return decode(f.read(), kind)


def quantised(values, per_first_axis=False):
    """(i16 array, f32 scale): scale has one value, or one for each index of the first axis; value = integer * scale."""
    values = np.asarray(values, np.float64)
    rows = values.reshape(values.shape[0] if per_first_axis else 1, -1)
    peak = np.abs(rows).max(1) if rows.size else np.zeros(len(rows))
    scale = np.where(peak > 0, peak / 32767, 1.0).astype(np.float32)
    integers = np.clip(np.round(rows / scale.astype(np.float64)[:, None]), -32767, 32767)
    return integers.astype(np.int16).reshape(values.shape), scale


def real(arrays, name):
    """The array as float64, integers times their companion scale."""
    values = arrays[name].astype(np.float64)
    if name + ".scale" in arrays:
        scale = arrays[name + ".scale"].astype(np.float64)
        values = values * scale.reshape(-1, *[1] * (values.ndim - 1))
    return values
