"""Writes model files of the SMPL family from the default body, with what the published formulas make of them.

usage: make_smpl_files.py OUT [own]   (the default body from models/generated, or $VITRUVIAN_MODELS)

OUT/own_*: the default body itself at its own size, with "own" nothing else, but of every kind. The others have the official
files' sizes. NAME.expected.npz holds a pose, coefficients (betas, then expression or soft tissue) and the posed vertices.
"""
import glob
import hashlib
import os
import pickle
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "models"))
import smpl_arrays as arrays  # noqa: E402
import smpl_files as files  # noqa: E402
from support import generated, made_body  # noqa: E402


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def made_of():
    """What the files depend on: the writers and the body."""
    here = os.path.dirname(os.path.abspath(__file__))
    paths = sorted(glob.glob(os.path.join(here, "*.py"))) + [generated("body.vbm")]
    return hashlib.sha256(b"".join(open(path, "rb").read() for path in paths)).hexdigest().encode()


def expect(out, name, model, family, used, seed):
    """Expected vertices at a random pose; `used`: columns of shapedirs that are not zero, in the reader's order."""
    random = np.random.default_rng(seed)
    pose = random.normal(0, 0.35, 3 * arrays.JOINTS[family])
    coefficients = random.normal(0, 1, len(used))
    full = np.zeros(max(used) + 1)
    full[used] = coefficients
    np.savez(os.path.join(out, name + ".expected.npz"), pose=pose, coefficients=coefficients,
             vertices=arrays.forward(model, family, pose, full))


def write_own(out):
    """A file of every kind, all from the default body at its own size."""
    own = arrays.to_dense(made_body())
    files.write_npz(os.path.join(out, "own_smpl.npz"), own, "smpl", compressed=True)
    write(os.path.join(out, "own_smpl.pkl"), files.official_pickle(own, "smpl"))
    files.write_npz(os.path.join(out, "own_smplh.npz"), arrays.with_fingers(own, "smplh"), "smplh", compressed=True)
    files.write_npz(os.path.join(out, "own_star.npz"), arrays.as_star(own), "star", compressed=True)
    files.write_npz(os.path.join(out, "own_smplx.npz"), arrays.with_fingers(own, "smplx"), "smplx", compressed=True)
    random = np.random.default_rng(8)
    np.savez(os.path.join(out, "own_dmpl.npz"), eigvec=0.02 * random.normal(size=own["v_template"].shape + (8,)))
    state = {k: files.Tensor(v) for k, v in files.vposer_state(random).items()}
    files.torch_zip(os.path.join(out, "own_vposer.ckpt"), {"state_dict": state})


def main():
    out = sys.argv[1]
    os.makedirs(out, exist_ok=True)
    if sys.argv[2:] == ["own"]:
        write_own(out)
        return
    done, made_from = os.path.join(out, "done"), made_of()
    if os.path.exists(done) and open(done, "rb").read() == made_from:
        return
    own = arrays.to_dense(made_body())
    own_h = arrays.with_fingers(own, "smplh")
    write(os.path.join(out, "own_smpl.pkl"), files.official_pickle(own, "smpl"))
    files.write_npz(os.path.join(out, "own_smpl.npz"), own, "smpl", compressed=True)
    write(os.path.join(out, "own_smplh.pkl"), files.official_pickle(own_h, "smplh"))
    for protocol in range(6):
        small = {"small": np.arange(6.0).reshape(2, 3), "f": np.arange(3), "half": np.float32(0.5)}
        write(os.path.join(out, f"protocol{protocol}.pkl"), pickle.dumps(small, protocol=protocol))

    tiny = arrays.tiny(own)
    write(os.path.join(out, "tiny_smpl.pkl"), files.official_pickle(tiny, "smpl"))
    write(os.path.join(out, "tiny_smpl2.pkl"), files.plain_pickle(tiny, "smpl", 4))
    files.write_npz(os.path.join(out, "tiny_smpl.npz"), tiny, "smpl", compressed=True)

    sized = arrays.resampled(own, 6890)
    smpl = arrays.with_columns(sized, 10, 1)
    write(os.path.join(out, "basicmodel_f_lbs_10_207_0_v1.1.0.pkl"), files.official_pickle(smpl, "smpl"))
    expect(out, "basicmodel_f_lbs_10_207_0_v1.1.0", smpl, "smpl", list(range(10)), 1)
    smpl_300 = arrays.with_columns(arrays.with_dense_correctives(sized, 12), 300, 2)
    write(os.path.join(out, "SMPL_MALE_300.pkl"), files.plain_pickle(smpl_300, "smpl", 5))
    expect(out, "SMPL_MALE_300", smpl_300, "smpl", list(range(300)), 2)
    smplh = arrays.with_columns(arrays.with_fingers(sized, "smplh"), 16, 3)
    files.write_npz(os.path.join(out, "SMPLH_NEUTRAL.npz"), smplh, "smplh", compressed=True)
    tissue = 0.02 * np.random.default_rng(8).normal(size=(6890, 3, 8))
    np.savez(os.path.join(out, "dmpl.npz"), eigvec=tissue)
    with_tissue = dict(smplh, shapedirs=np.concatenate([smplh["shapedirs"], tissue], 2))
    expect(out, "SMPLH_NEUTRAL", with_tissue, "smplh", list(range(24)), 3)
    star = arrays.with_columns(arrays.as_star(sized), 300, 4)
    files.write_npz(os.path.join(out, "STAR_FEMALE.npz"), star, "star", compressed=True)
    expect(out, "STAR_FEMALE", star, "star", list(range(16)), 4)
    smplx = arrays.with_columns(arrays.with_fingers(arrays.resampled(own, 10475), "smplx"), 400, 6)
    files.write_npz(os.path.join(out, "SMPLX_NEUTRAL.npz"), smplx, "smplx")
    expect(out, "SMPLX_NEUTRAL", smplx, "smplx", list(range(16)) + list(range(300, 310)), 6)
    small_x = dict(smplx, shapedirs=smplx["shapedirs"][:, :, list(range(10)) + list(range(300, 310))])
    write(os.path.join(out, "SMPLX_MALE.pkl"), files.plain_pickle(small_x, "smplx", 4))
    expect(out, "SMPLX_MALE", small_x, "smplx", list(range(20)), 7)

    random = np.random.default_rng(9)
    state = files.vposer_state(random)
    prefixed = {"vp_model." + k: files.Tensor(v, transposed=k.endswith("7.weight")) for k, v in state.items()}
    files.torch_zip(os.path.join(out, "V02_05_epoch=08.ckpt"), {"epoch": 8, "state_dict": prefixed})
    small = {k: files.Tensor(v) for k, v in files.vposer_state(random, neurons=12, latent=4).items()}
    files.torch_zip(os.path.join(out, "tiny_vposer.ckpt"), {"state_dict": small})
    z, pose = random.normal(size=32), random.normal(0, 0.4, 63)
    np.savez(os.path.join(out, "vposer.expected.npz"), z=z, rotations=files.vposer_decode(state, z), pose=pose,
             code=files.vposer_encode(state, pose))
    write(done, made_from)


if __name__ == "__main__":
    main()
