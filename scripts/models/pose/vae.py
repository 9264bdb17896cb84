"""Variational autoencoder of body poses with the structure of VPoser (Pavlakos et al. 2019, SMPL-X, section 3.3).

The 21 body joints' axis-angle numbers (63) -> 512 -> 512 -> mean and log-variance of 32 latent numbers -> 512 -> 512 ->
a 3x2 matrix a joint, whose columns become a rotation by Gram-Schmidt (Zhou et al. 2019). Leaky ReLU, slope 0.01.
"""
import numpy as np
import torch
from torch import nn

import skeleton

JOINTS, LATENT, WIDTH, SLOPE = 21, 32, 512, 0.01


def rotations_from_columns(six):
    """(..., 6) row-major 3x2 -> (..., 3, 3): first column normalised, second made orthogonal, third their product."""
    a = six.reshape(*six.shape[:-1], 3, 2)
    first = nn.functional.normalize(a[..., 0], dim=-1, eps=1e-8)
    second = a[..., 1] - (first * a[..., 1]).sum(-1, keepdim=True) * first
    second = nn.functional.normalize(second, dim=-1, eps=1e-8)
    return torch.stack([first, second, torch.cross(first, second, dim=-1)], -1)


class PoseVae(nn.Module):
    def __init__(self):
        super().__init__()
        self.encoder = nn.Sequential(nn.Linear(3 * JOINTS, WIDTH), nn.LeakyReLU(SLOPE), nn.Linear(WIDTH, WIDTH),
                                     nn.LeakyReLU(SLOPE))
        self.mean = nn.Linear(WIDTH, LATENT)
        self.log_variance = nn.Linear(WIDTH, LATENT)
        self.decoder = nn.Sequential(nn.Linear(LATENT, WIDTH), nn.LeakyReLU(SLOPE), nn.Linear(WIDTH, WIDTH),
                                     nn.LeakyReLU(SLOPE), nn.Linear(WIDTH, 6 * JOINTS))
        with torch.no_grad():
            self.decoder[-1].bias.copy_(torch.tensor([1.0, 0, 0, 1, 0, 0]).repeat(JOINTS))
            self.decoder[-1].weight.mul_(0.1)

    def encode(self, pose):
        """(N, 63) -> mean, log-variance (N, 32)."""
        h = self.encoder(pose)
        return self.mean(h), self.log_variance(h).clamp(-12, 6)

    def decode(self, z):
        """(N, 32) -> rotations (N, 21, 3, 3)."""
        return rotations_from_columns(self.decoder(z).reshape(-1, JOINTS, 6))


def rotation_matrices(v):
    """(..., 3) axis-angle -> (..., 3, 3)."""
    squared = (v * v).sum(-1)[..., None, None]
    angle = torch.sqrt(squared + 1e-12)
    x, y, z = v.unbind(-1)
    zero = torch.zeros_like(x)
    k = torch.stack([zero, -z, y, z, zero, -x, -y, x, zero], -1).reshape(*v.shape, 3)
    return torch.eye(3) + torch.sin(angle) / angle * k + (1 - torch.cos(angle)) / (squared + 1e-12) * (k @ k)


# Ends of the chains that no joint marks: fingertips, toes, top of the head; offsets (m) in the T-pose.
TIPS = ((20, (0.18, 0, 0)), (21, (-0.18, 0, 0)), (10, (0, -0.02, 0.07)), (11, (0, -0.02, 0.07)), (15, (0, 0.18, 0.03)))


def points(rotations):
    """Joints 1..21 and five tips, (N, 26, 3) m, pelvis at the origin; rotations (N, 21, 3, 3) of joints 1..21."""
    rest = torch.tensor(skeleton.REST, dtype=rotations.dtype)
    world, place = [None], [torch.zeros(len(rotations), 3, dtype=rotations.dtype)]
    for j in range(1, JOINTS + 1):
        p = int(skeleton.PARENT[j])
        bone = rest[j] - rest[p]
        if world[p] is None:
            world.append(rotations[:, j - 1])
            place.append(place[p] + bone)
        else:
            world.append(world[p] @ rotations[:, j - 1])
            place.append(place[p] + world[p] @ bone)
    tips = [place[j] + world[j] @ torch.tensor(offset, dtype=rotations.dtype) for j, offset in TIPS]
    return torch.stack(place[1:] + tips, 1)


def geodesic(a, b):
    """Angles (...) rad between rotations, with a gradient that stays finite where they agree."""
    chord = torch.sqrt(((a - b) ** 2).sum((-1, -2)) + 1e-8)
    return 2 * torch.asin((chord / (2 * 2**0.5)).clamp(max=1 - 1e-6))


def exported(checkpoint):
    """Arrays of the model file in f16, [out, in] weights, and what the checkpoint says of itself."""
    state = torch.load(checkpoint, map_location="cpu")
    names = {"encoder.0": "encoder_0", "encoder.2": "encoder_1", "mean": "mean", "log_variance": "log_variance",
             "decoder.0": "decoder_0", "decoder.2": "decoder_1", "decoder.4": "decoder_2"}
    arrays = {f"vae_{new}_{kind}": state["model"][f"{old}.{kind}"].numpy().astype(np.float16)
              for old, new in names.items() for kind in ("weight", "bias")}
    return arrays, state["about"]
