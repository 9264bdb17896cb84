"""Writers of the SMPL family's file formats as their authors' tools wrote them."""
import io
import pickle
import struct
import sys
import types
import zipfile

import numpy as np
import scipy.sparse


class Ch:
    """Stands for chumpy.ch.Ch: its array is .x."""

    def __init__(self, x):
        self.x = x
        self._dirty_vars, self._itr, self._parents = set(), None, {}


class Select:
    """Stands for chumpy.reordering.Select: elements idxs of .a, flattened, in the shape preferred_shape."""

    def __init__(self, a, idxs, preferred_shape):
        self.a, self.idxs, self.preferred_shape = a, idxs, preferred_shape


def _pretend(module, *classes):
    sys.modules[module] = types.ModuleType(module)
    for c in classes:
        c.__module__, c.__qualname__ = module, c.__name__
        setattr(sys.modules[module], c.__name__, c)


_pretend("chumpy")
_pretend("chumpy.ch", Ch)
_pretend("chumpy.reordering", Select)


class Python2Pickler(pickle._Pickler):
    """Protocol 2 as Python 2 wrote it: every string is a byte string."""

    dispatch = dict(pickle._Pickler.dispatch)

    def save_string(self, text):
        raw = text.encode("latin1") if isinstance(text, str) else text
        self.write(b"U" + bytes([len(raw)]) + raw if len(raw) < 256 else b"T" + struct.pack("<i", len(raw)) + raw)
        self.memoize(text)

    dispatch[bytes] = save_string
    dispatch[str] = save_string


def python2_pickle(value):
    scipy.sparse.csc_matrix.__module__ = "scipy.sparse.csc"  # where it lived then
    out = io.BytesIO()
    Python2Pickler(out, 2).dump(value)
    return out.getvalue()


def selected(array):
    """A chumpy selection of the first columns of a larger array, as in the official files."""
    wide = np.concatenate([array, np.zeros(array.shape[:2] + (3,))], 2)
    places = np.arange(wide.size).reshape(wide.shape)[:, :, :array.shape[2]]
    return Select(Ch(wide), places.ravel(), array.shape)


def contents(model, family):
    """The arrays under the names of the official files."""
    parents = model["parents"].astype(np.int64)
    parents[0] = 4294967295
    d = {k: model[k] for k in ("v_template", "shapedirs", "posedirs", "weights", "J_regressor")}
    d["f"] = model["f"]
    d["kintree_table"] = np.stack([parents, np.arange(len(parents))]).astype(np.uint32)
    if family in ("smplh", "smplx"):
        random = np.random.default_rng(5)
        for side in "lr":
            d["hands_mean" + side] = random.normal(0, 0.1, 45)
            d["hands_components" + side] = np.linalg.qr(random.normal(size=(45, 45)))[0]
            d["hands_coeffs" + side] = random.normal(size=(60, 45)) * np.linspace(0.8, 0.05, 45)
    if family == "smplx":
        d["lmk_faces_idx"] = np.arange(51)
        d["joint2num"] = np.array({"Pelvis": 0}, dtype=object)
    return d


def official_pickle(model, family):
    """basicModel_*.pkl: protocol 2, a sparse regressor, chumpy shape directions, other things that nobody needs."""
    d = contents(model, family)
    d["shapedirs"] = selected(d["shapedirs"])
    d["J_regressor"] = scipy.sparse.csc_matrix(d["J_regressor"])
    d["J"] = Ch(model["J_regressor"] @ model["v_template"])
    d["weights_prior"] = scipy.sparse.csr_matrix(d["weights"])
    d["v_template"] = Ch(d["v_template"]) if family == "smplh" else d["v_template"]
    d["posedirs"] = np.asfortranarray(d["posedirs"])
    d["bs_type"], d["bs_style"] = "lrotmin", "lbs"
    d["vert_sym_idxs"] = np.arange(len(model["v_template"]))
    return python2_pickle(d)


def plain_pickle(model, family, protocol):
    return pickle.dumps(contents(model, family), protocol=protocol)


def write_npz(path, model, family, compressed=False):
    (np.savez_compressed if compressed else np.savez)(path, **contents(model, family))


class _TorchPickler(pickle._Pickler):
    """Keeps tensors' numbers outside of the pickle, as torch.save() does."""

    def __init__(self, file):
        super().__init__(file, 2)
        self.storages = []

    def persistent_id(self, value):
        if not isinstance(value, Storage):
            return None
        self.storages.append(value.array)
        return ("storage", FloatStorage, str(len(self.storages) - 1), "cpu", value.array.size)


class FloatStorage:
    pass


class Storage:
    def __init__(self, array):
        self.array = np.ascontiguousarray(array, "<f4").ravel()


def _rebuild_tensor_v2(*arguments):
    raise AssertionError("only named, never called")


class Tensor:
    def __init__(self, array, transposed=False):
        self.array, self.transposed = np.asarray(array), transposed

    def __reduce__(self):
        from collections import OrderedDict

        shape = self.array.shape
        strides = tuple(int(np.prod(shape[k + 1:])) for k in range(len(shape)))
        stored = self.array
        if self.transposed:  # a view with the axes exchanged, which is legal
            stored, strides = self.array.T, strides[::-1] if len(shape) < 2 else (1, shape[0])
        return _rebuild_tensor_v2, (Storage(stored), 0, shape, strides, False, OrderedDict())


_pretend("torch", FloatStorage)
_pretend("torch._utils")
_rebuild_tensor_v2.__module__ = "torch._utils"
sys.modules["torch._utils"]._rebuild_tensor_v2 = _rebuild_tensor_v2


def torch_zip(path, value):
    """A torch.save() file: archive/data.pkl and one member of raw numbers for each storage."""
    out = io.BytesIO()
    pickler = _TorchPickler(out)
    pickler.dump(value)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as file:
        file.writestr("archive/data.pkl", out.getvalue())
        file.writestr("archive/byteorder", b"little")
        for k, array in enumerate(pickler.storages):
            file.writestr(f"archive/data/{k}", array.tobytes())
        file.writestr("archive/version", b"3\n")


def vposer_state(random, neurons=512, latent=32):
    """state_dict of a VPoser v2 checkpoint with made-up numbers, and its decoder and encoder by the published layers."""
    from collections import OrderedDict

    state = OrderedDict()

    def linear(name, outputs, inputs):
        state[name + ".weight"] = random.normal(0, 1 / np.sqrt(inputs), (outputs, inputs)).astype(np.float32)
        state[name + ".bias"] = random.normal(0, 0.1, outputs).astype(np.float32)

    def batch_norm(name, size):
        state[name + ".weight"] = random.uniform(0.5, 1.5, size).astype(np.float32)
        state[name + ".bias"] = random.normal(0, 0.2, size).astype(np.float32)
        state[name + ".running_mean"] = random.normal(0, 0.3, size).astype(np.float32)
        state[name + ".running_var"] = random.uniform(0.3, 2, size).astype(np.float32)

    batch_norm("encoder_net.1", 63)
    linear("encoder_net.2", neurons, 63)
    batch_norm("encoder_net.4", neurons)
    linear("encoder_net.6", neurons, neurons)
    linear("encoder_net.7", neurons, neurons)
    linear("encoder_net.8.mu", latent, neurons)
    linear("encoder_net.8.logvar", latent, neurons)
    linear("decoder_net.0", neurons, latent)
    linear("decoder_net.3", neurons, neurons)
    linear("decoder_net.5", 126, neurons)
    return state


def vposer_decode(state, z):
    """Rotations [21,3,3] of a latent code."""
    def dense(name, x):
        return state[name + ".weight"] @ x + state[name + ".bias"]

    def leaky(x):
        return np.where(x > 0, x, 0.01 * x)

    x = dense("decoder_net.5", leaky(dense("decoder_net.3", leaky(dense("decoder_net.0", z))))).reshape(21, 3, 2)
    b1 = x[:, :, 0] / np.linalg.norm(x[:, :, 0], axis=1, keepdims=True)
    b2 = x[:, :, 1] - (b1 * x[:, :, 1]).sum(1, keepdims=True) * b1
    b2 /= np.linalg.norm(b2, axis=1, keepdims=True)
    return np.stack([b1, b2, np.cross(b1, b2)], 2)


def vposer_encode(state, pose):
    """Mean latent code of 63 axis-angle numbers."""
    def dense(name, x):
        return state[name + ".weight"] @ x + state[name + ".bias"]

    def norm(name, x):
        scale = state[name + ".weight"] / np.sqrt(state[name + ".running_var"] + 1e-5)
        return (x - state[name + ".running_mean"]) * scale + state[name + ".bias"]

    x = dense("encoder_net.2", norm("encoder_net.1", pose))
    x = norm("encoder_net.4", np.where(x > 0, x, 0.01 * x))
    return dense("encoder_net.8.mu", dense("encoder_net.7", dense("encoder_net.6", x)))
