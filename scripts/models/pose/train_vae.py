#!/usr/bin/env python3
"""Trains the pose autoencoder (vae.py) on the training side of the split; resumable.

    train_vae.py --out build/pose/vae.pt
"""
import argparse
import json
import os
import time

import numpy as np
import torch

import cmu
import make_prior
import skeleton
import synthetic
import vae

SEED = 3
BATCH = 512
MADE_COUNT, MADE_SHARE = 80_000, 0.45
MIXED_SHARE = 0.3
KL_WEIGHT, GEODESIC_WEIGHT, POINT_WEIGHT = 2e-3, 2.0, 4.0
LEARNING_RATE = 1e-3
CHECKPOINT_SECONDS = 600
# Joints (0-based among the 21) of the parts that are exchanged between poses.
PARTS = [np.array([skeleton.INDEX[n] - 1 for n in names.split()]) for names in (
    "left_hip left_knee left_ankle left_foot", "right_hip right_knee right_ankle right_foot",
    "left_collar left_shoulder left_elbow left_wrist", "right_collar right_shoulder right_elbow right_wrist",
    "spine1 spine2 spine3", "neck head")]
NOISE_SD = np.full(21, 0.04, np.float32)
NOISE_SD[[skeleton.INDEX[n] - 1 for n in "left_wrist right_wrist left_ankle right_ankle head neck".split()]] = 0.12


def rarity(poses, rng, centres=400):
    """Sampling probabilities that thin out what the trials hold most of: walking."""
    features = skeleton.body_joints(poses)[:, :22].reshape(len(poses), -1)
    c = features[rng.choice(len(features), centres, replace=False)]
    label = ((features**2).sum(1)[:, None] - 2 * features @ c.T + (c**2).sum(1)).argmin(1)
    weight = np.bincount(label, minlength=centres)[label] ** -0.6
    return weight / weight.sum()


class Pool:
    """Training poses (63 numbers) drawn with noise and with parts of several poses put together."""

    def __init__(self, data):
        rng = np.random.default_rng(SEED)
        measured, _ = make_prior.training_poses(data)
        made, _ = synthetic.poses(MADE_COUNT, SEED)
        probability = rarity(measured, rng)
        self.measured, self.made = (p[:, 1:22].astype(np.float32) for p in (measured, made))
        self.cumulative = np.cumsum(probability)

    def _draw(self, rng, n):
        from_made = rng.random(n) < MADE_SHARE
        index = np.searchsorted(self.cumulative, rng.random(n) * self.cumulative[-1])
        drawn = self.measured[index.clip(max=len(self.measured) - 1)]
        drawn[from_made] = self.made[rng.integers(0, len(self.made), from_made.sum())]
        return drawn

    def batch(self, rng):
        poses = self._draw(rng, BATCH)
        mixed = np.flatnonzero(rng.random(BATCH) < MIXED_SHARE)
        for part in PARTS:
            taken = mixed[rng.random(len(mixed)) < 0.4]
            poses[taken[:, None], part] = self._draw(rng, len(taken))[:, part]
        noisy = rng.random(BATCH) < 0.5
        poses[noisy] += NOISE_SD[:, None] * rng.standard_normal((noisy.sum(), 21, 3)).astype(np.float32)
        return torch.from_numpy(poses.reshape(BATCH, 63))


@torch.no_grad()
def evaluated(model, poses):
    """Reconstruction of poses (N, 63) through the latent mean: mean angle (degrees) and joint distance (mm)."""
    mean, log_variance = model.encode(poses)
    got, true = model.decode(mean), vae.rotation_matrices(poses.reshape(-1, 21, 3))
    angle = torch.rad2deg(vae.geodesic(got, true))
    distance = 1000 * (vae.points(got) - vae.points(true)).norm(dim=-1)[:, :21]
    return {"angle_deg": {"mean": float(angle.mean()), "p95": float(np.percentile(angle, 95))},
            "joint_mm": {"mean": float(distance.mean()), "p95": float(np.percentile(distance, 95))},
            "latent_square_norm": float((mean**2).sum(1).mean()),
            "latent_dimensions_used": int(((log_variance.exp().mean(0)) < 0.5).sum())}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", default=cmu.FULL_DATA)
    parser.add_argument("--out", default=os.path.join(cmu.ROOT, "build/pose/vae.pt"))
    parser.add_argument("--steps", type=int, default=20_000)
    parser.add_argument("--restart", action="store_true", help="do not go on from an earlier checkpoint")
    arguments = parser.parse_args()

    torch.set_num_threads(1)
    torch.manual_seed(SEED)
    pool = Pool(arguments.data)
    test = cmu.load_side(cmu.SUBSET_DATA, "test")["poses"].astype(np.float64)
    rotations = skeleton.matrices(test)
    girdled = skeleton.vectors(synthetic.with_shoulder_girdle(rotations, np.random.default_rng(7)))
    test_sets = {"measured": test, "measured_with_girdle": girdled, "made": synthetic.poses(2000, 99)[0]}
    test_sets = {k: torch.from_numpy(v[:, 1:22].reshape(-1, 63).astype(np.float32)) for k, v in test_sets.items()}

    model = vae.PoseVae()
    optimizer = torch.optim.Adam(model.parameters(), lr=LEARNING_RATE)
    step, about = 0, {}
    if os.path.exists(arguments.out) and not arguments.restart:
        state = torch.load(arguments.out)
        model.load_state_dict(state["model"])
        optimizer.load_state_dict(state["optimizer"])
        step, about = state["step"], state["about"]
        print(f"going on from step {step}", flush=True)
    os.makedirs(os.path.dirname(os.path.abspath(arguments.out)), exist_ok=True)

    def save():
        about.update(steps=step, kl_weight=KL_WEIGHT, test={k: evaluated(model, v) for k, v in test_sets.items()})
        part = arguments.out + ".part"
        torch.save({"model": model.state_dict(), "optimizer": optimizer.state_dict(), "step": step, "about": about}, part)
        os.replace(part, arguments.out)
        print(json.dumps(about), flush=True)

    saved = time.monotonic()
    while step < arguments.steps:
        # Drawn from the step's own seed, so that a resumed run sees what an unbroken one would.
        rng = np.random.default_rng((SEED, step))
        torch.manual_seed(SEED * 1_000_003 + step)
        warm_up = min(1.0, (step + 1) / 300)
        for group in optimizer.param_groups:
            group["lr"] = LEARNING_RATE * warm_up * (0.01 + 0.99 * 0.5 * (1 + np.cos(np.pi * step / arguments.steps)))
        pose = pool.batch(rng)
        mean, log_variance = model.encode(pose)
        z = mean + torch.exp(0.5 * log_variance) * torch.randn_like(mean)
        got, true = model.decode(z), vae.rotation_matrices(pose.reshape(-1, 21, 3))
        turn = vae.geodesic(got, true).mean()
        place = (vae.points(got) - vae.points(true)).abs().mean()
        divergence = 0.5 * (mean**2 + log_variance.exp() - 1 - log_variance).sum(1).mean()
        loss = GEODESIC_WEIGHT * turn + POINT_WEIGHT * place + KL_WEIGHT * min(1.0, step / 2000) * divergence
        optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(model.parameters(), 1.0)
        optimizer.step()
        step += 1
        if step % 500 == 0:
            print(f"{step} loss {loss.item():.4f} angle {np.degrees(turn.item()):.2f} deg, points {1000 * place.item():.1f} mm, "
                  f"divergence {divergence.item():.1f}", flush=True)
        if time.monotonic() - saved > CHECKPOINT_SECONDS:
            save()
            saved = time.monotonic()
    save()


if __name__ == "__main__":
    main()
