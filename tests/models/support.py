"""What the tests of the makers share: import path, the generated folder, the made body as dense arrays."""
import functools
import os
import sys
from types import SimpleNamespace

import numpy as np

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(REPOSITORY, "scripts", "models"))
GENERATED = os.environ.get("VITRUVIAN_MODELS", os.path.join(REPOSITORY, "models", "generated"))

import array_file  # noqa: E402  (found through the path above)


def generated(name):
    """Path of a generated file; its absence is an error, not a reason to skip."""
    path = os.path.join(GENERATED, name)
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path}: make the models first, or set VITRUVIAN_MODELS to their folder")
    return path


@functools.lru_cache(None)
def made_body():
    """The made body: raw arrays, and v [V,3], shapedirs [K,V,3], weights [V,24], regressor [24,V], blocks."""
    raw = array_file.read(generated("body.vbm"), "BODY")
    v = array_file.real(raw, "v_template")
    weights = np.zeros((len(v), 24))
    np.add.at(weights, (np.arange(len(v))[:, None], raw["skin_joint"]), raw["skin_weight"] / 65535.0)
    regressor = np.zeros((24, len(v)))
    regressor[raw["regressor_joint"], raw["regressor_vertex"]] = raw["regressor_weight"]
    blocks = array_file.real(raw, "corrective").reshape(-1, 3, 9)
    return SimpleNamespace(
        raw=raw,
        v=v,
        shapedirs=array_file.real(raw, "shapedirs"),
        faces=raw["faces"].astype(int),
        mirror=raw["mirror"].astype(int),
        weights=weights / weights.sum(1, keepdims=True),
        regressor=regressor,
        correctives=(raw["corrective_vertex"].astype(int), raw["corrective_joint"].astype(int), blocks),
    )
