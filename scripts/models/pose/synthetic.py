"""Poses of our own making, for what the motion-capture trials lack: scanning stances, sitting, kneeling, squatting,
lying, bending, arms crossed, hugging, hands on the body; and a shoulder girdle that moves with the arm.

Everything is drawn from anatomical ranges; arms whose hand must be somewhere are looked up in a table of random arms.
"""
import functools

import numpy as np
from scipy.spatial import cKDTree

import skeleton
from skeleton import INDEX, REST, about

D = np.pi / 180
SIDES = ("left", "right")
HAND = INDEX["left_hand"]


def uniform(rng, low, high, n):
    return rng.uniform(low, high, n) * D


def normal(rng, mean, sd, n):
    return (mean + sd * rng.standard_normal(n)) * D


def reflected(rotations):
    """The rotations seen in the mirror x -> -x."""
    m = np.diag([-1.0, 1.0, 1.0])
    return m @ rotations @ m


def left_leg(flexion, abduction, spread, twist, knee):
    """Rotations (N, 2, 3, 3) of the left hip and knee, angles in radians.

    flexion: thigh forward; abduction: outwards in the frontal plane; spread: the raised thigh outwards about the
    vertical; twist: about the thigh, positive moves the shin of a bent knee inwards.
    """
    hip = about("y", spread) @ about("z", abduction) @ about("x", -flexion) @ about("y", twist)
    return np.stack([hip, about("x", knee)], 1)


def minimal_rotation(direction):
    """Smallest rotations (N, 3, 3) that take +X to unit directions (N, 3)."""
    axis = np.cross([1.0, 0.0, 0.0], direction)
    s = np.linalg.norm(axis, axis=1, keepdims=True)
    angle = np.arctan2(s, direction[:, :1])
    return skeleton.matrices(axis / np.maximum(s, 1e-9) * angle)


def with_shoulder_girdle(rotations, rng):
    """Moves a share of each arm's elevation and reach into its collar, the upper arm keeping its direction.

    rotations (N, 24, 3, 3), collars as given are kept in front. The share is about a third of what lies above the
    horizontal, half as much below (scapulohumeral rhythm), and a fifth of the reach forwards.
    """
    out = rotations.copy()
    n = len(out)
    for side in SIDES:
        c, s = INDEX[f"{side}_collar"], INDEX[f"{side}_shoulder"]
        whole = out[:, c] @ out[:, s]
        if side == "right":
            whole = reflected(whole)
        arm = whole[:, :, 0]
        elevation = np.arcsin(np.clip(arm[:, 1], -1, 1))
        reach = np.arctan2(arm[:, 2], np.abs(arm[:, 0]) + 0.3) * np.hypot(arm[:, 0], arm[:, 2])
        share = np.clip(normal(rng, 0.30, 0.10, n) / D, 0.0, 0.5) * np.where(elevation > 0, 1.0, 0.5)
        lift = share * elevation + normal(rng, 0, 3, n)
        forward = np.clip(normal(rng, 0.20, 0.08, n) / D, 0.0, 0.4) * reach + normal(rng, 0, 3, n)
        collar = about("y", -forward) @ about("z", lift)
        if side == "right":
            collar, whole = reflected(collar), reflected(whole)
        new = out[:, c] @ collar
        out[:, s] = np.swapaxes(new, -1, -2) @ out[:, c] @ out[:, s]
        out[:, c] = new
    return out


def arm_from(direction, twist, elbow, pronation, wrist):
    """Left-arm rotations (N, 3, 3, 3) of shoulder, elbow, wrist. direction: of the upper arm in the collar's frame;
    twist about it; elbow flexion; pronation of the forearm, split over elbow and wrist; wrist: (N, 2) flexion and
    deviation."""
    shoulder = minimal_rotation(direction) @ about("x", twist)
    bent = about("y", -elbow) @ about("x", 0.3 * pronation)
    hand = about("x", 0.7 * pronation) @ about("z", wrist[:, 0]) @ about("y", wrist[:, 1])
    return np.stack([shoulder, bent, hand], 1)


class ArmTable:
    """Random left arms that stay outside the trunk and head, found by where their hand is (frame of spine3, T-pose
    placement: the positions of `skeleton.REST`)."""

    def __init__(self, rng, count):
        d = rng.standard_normal((4 * count, 3))
        d /= np.linalg.norm(d, axis=1, keepdims=True)
        across = d[:, 0] < -0.35
        keep = (d[:, 2] > -0.65) & (d[:, 0] > -0.75) & ~(across & (d[:, 2] < 0.35))
        d = d[keep][:count]
        n = len(d)
        arm = arm_from(d, normal(rng, 0, 40, n).clip(-85 * D, 85 * D), uniform(rng, 0, 150, n),
                       normal(rng, 0, 35, n).clip(-80 * D, 80 * D),
                       np.stack([normal(rng, 0, 20, n), normal(rng, 0, 10, n)], 1))
        collar = self._collar(d, rng)
        joints = self._chain(collar, arm)
        outside = np.ones(n, bool)
        for a, b in ((1, 2), (2, 3), (3, 4)):
            for t in (0.35, 0.7, 1.0):
                p = joints[:, a] + t * (joints[:, b] - joints[:, a])
                outside &= self._outside(p)
        self.collar, self.arm = collar[outside], arm[outside]
        self.tree = cKDTree(joints[outside, 4])
        self.hands = joints[outside, 4]

    @staticmethod
    def _collar(d, rng):
        n = len(d)
        elevation = np.arcsin(np.clip(d[:, 1], -1, 1))
        share = np.clip(normal(rng, 0.30, 0.10, n) / D, 0, 0.5) * np.where(elevation > 0, 1.0, 0.5)
        reach = np.arctan2(d[:, 2], np.abs(d[:, 0]) + 0.3) * np.hypot(d[:, 0], d[:, 2])
        return (about("y", -np.clip(normal(rng, 0.20, 0.08, n) / D, 0, 0.4) * reach + normal(rng, 0, 3, n))
                @ about("z", share * elevation + normal(rng, 0, 3, n)))

    @staticmethod
    def _chain(collar, arm):
        names = ("left_collar", "left_shoulder", "left_elbow", "left_wrist", "left_hand")
        place = [REST[INDEX[name]] for name in names]
        joints, frame = [np.broadcast_to(place[0], (len(arm), 3))], collar
        for k in range(1, 5):
            joints.append(joints[-1] + frame @ (place[k] - place[k - 1]))
            if k < 4:
                frame = frame @ arm[:, k - 1]
        return np.stack(joints, 1)

    @staticmethod
    def _outside(p):
        trunk = ((p[:, 0] / 0.155) ** 2 + ((p[:, 2] - 0.03) / 0.115) ** 2 < 1) & (p[:, 1] < 0.43) & (p[:, 1] > -0.15)
        head = (p[:, 0] / 0.085) ** 2 + ((p[:, 1] - 0.61) / 0.13) ** 2 + ((p[:, 2] - 0.06) / 0.10) ** 2 < 1
        return ~trunk & ~head

    def reaching(self, targets, rng, neighbours=12, tolerance=0.05):
        """Collars (N, 3, 3), arms (N, 3, 3, 3) whose hands are near targets (N, 3), and which of them were found."""
        distance, index = self.tree.query(targets, k=neighbours)
        pick = index[np.arange(len(targets)), rng.integers(0, neighbours, len(targets))]
        found = np.linalg.norm(self.hands[pick] - targets, axis=1) < tolerance
        return self.collar[pick], self.arm[pick], found


def trunk_rotations(rng, n, bend=(0, 8), side=6, turn=6):
    """Rotations of spine1, spine2, spine3, neck, head (N, 5, 3, 3). bend: mean and sd of the forward bend in degrees,
    spread evenly; side and turn: sd of the side bend and of the twist."""
    total = np.stack([normal(rng, *bend, n), normal(rng, 0, turn, n), normal(rng, 0, side, n)], 1)
    shares = rng.dirichlet([6, 6, 5], n)
    spine = skeleton.matrices(total[:, None] * shares[:, :, None])
    neck = np.stack([normal(rng, 0, 12, n), normal(rng, 0, 16, n), normal(rng, 0, 8, n)], 1)
    share = rng.uniform(0.3, 0.7, (n, 1))
    ends = skeleton.matrices(np.stack([neck * share, neck * (1 - share)], 1))
    return np.concatenate([spine, ends], 1)


def assemble(rng, trunk, legs, n):
    """Rotations (N, 24, 3, 3) from a trunk (N, 5, 3, 3) and two legs, each (N, 2, 3, 3) in left form."""
    r = np.broadcast_to(np.eye(3), (n, 24, 3, 3)).copy()
    for k, name in enumerate(("spine1", "spine2", "spine3", "neck", "head")):
        r[:, INDEX[name]] = trunk[:, k]
    for side, leg in zip(SIDES, legs):
        leg = leg if side == "left" else reflected(leg)
        r[:, INDEX[f"{side}_hip"]], r[:, INDEX[f"{side}_knee"]] = leg[:, 0], leg[:, 1]
        ankle = np.stack([normal(rng, 8, 16, n), normal(rng, 0, 8, n), normal(rng, 0, 6, n)], 1)
        r[:, INDEX[f"{side}_ankle"]] = skeleton.matrices(ankle)
        r[:, INDEX[f"{side}_foot"]] = about("x", normal(rng, 0, 8, n))
    return r


def set_arm(r, side, collar, arm):
    if side == "right":
        collar, arm = reflected(collar), reflected(arm)
    r[:, INDEX[f"{side}_collar"]] = collar
    for k, joint in enumerate(("shoulder", "elbow", "wrist")):
        r[:, INDEX[f"{side}_{joint}"]] = arm[:, k]


# --- legs: each returns (trunk, (left leg, right leg in left form)) ---

def _pair(rng, n, flexion, abduction, spread, twist, knee, likeness=0.7):
    """Two legs drawn uniformly from the same ranges (degrees); `likeness` of the difference between them is removed."""
    draws = [[uniform(rng, *span, n) for span in (flexion, abduction, spread, twist, knee)] for _ in range(2)]
    first, second = draws
    second = [likeness * a + (1 - likeness) * b for a, b in zip(first, second)]
    return left_leg(*first), left_leg(*second)


def standing(rng, n):
    return trunk_rotations(rng, n, (2, 6)), _pair(rng, n, (-8, 12), (-2, 22), (0, 0), (-20, 12), (0, 12))


def sitting(rng, n):
    return trunk_rotations(rng, n, (12, 14)), _pair(rng, n, (60, 110), (0, 0), (-8, 40), (-15, 20), (50, 125))


def sitting_on_floor(rng, n):
    return trunk_rotations(rng, n, (20, 15)), _pair(rng, n, (60, 125), (0, 0), (-5, 50), (-15, 25), (0, 145), 0.5)


def cross_legged(rng, n):
    return trunk_rotations(rng, n, (22, 12)), _pair(rng, n, (65, 100), (0, 0), (30, 65), (45, 85), (100, 145))


def leg_over_knee(rng, n):
    trunk, (low, _) = sitting(rng, n)
    high = left_leg(uniform(rng, 80, 110, n), np.zeros(n), uniform(rng, -20, 40, n), uniform(rng, 0, 75, n),
                    uniform(rng, 50, 110, n))
    return trunk, (low, high)


def squatting(rng, n):
    return trunk_rotations(rng, n, (28, 14)), _pair(rng, n, (80, 135), (0, 0), (0, 45), (-10, 25), (90, 150), 0.8)


def kneeling(rng, n):
    return trunk_rotations(rng, n, (10, 12)), _pair(rng, n, (-10, 40), (0, 15), (0, 0), (-10, 15), (75, 125))


def heel_sitting(rng, n):
    return trunk_rotations(rng, n, (15, 15)), _pair(rng, n, (50, 100), (0, 0), (0, 25), (-20, 20), (130, 155), 0.85)


def half_kneeling(rng, n):
    up = left_leg(uniform(rng, 70, 115, n), np.zeros(n), uniform(rng, -5, 30, n), normal(rng, 0, 8, n),
                  uniform(rng, 70, 120, n))
    down = left_leg(uniform(rng, -20, 30, n), uniform(rng, 0, 12, n), np.zeros(n), normal(rng, 0, 8, n),
                    uniform(rng, 75, 125, n))
    return trunk_rotations(rng, n, (12, 14)), (up, down)


def all_fours(rng, n):
    return trunk_rotations(rng, n, (5, 16)), _pair(rng, n, (60, 110), (0, 0), (-5, 20), (-10, 10), (70, 115))


def bending(rng, n):
    return trunk_rotations(rng, n, (60, 25)), _pair(rng, n, (20, 110), (0, 5), (0, 15), (-10, 10), (0, 40), 0.85)


def curled_up(rng, n):
    return trunk_rotations(rng, n, (55, 18)), _pair(rng, n, (75, 130), (0, 0), (-8, 15), (-10, 10), (70, 145))


def lying(rng, n):
    return trunk_rotations(rng, n, (0, 10), 12, 12), _pair(rng, n, (-10, 50), (-5, 40), (0, 0), (-35, 20), (0, 75), 0.3)


def splits(rng, n):
    straight, side = uniform(rng, 0, 25, n), uniform(rng, 15, 60, n)
    sideways = left_leg(uniform(rng, -5, 30, n), side, np.zeros(n), uniform(rng, -40, 10, n), straight)
    front = left_leg(uniform(rng, 30, 120, n), np.zeros(n), uniform(rng, -5, 25, n), normal(rng, 0, 12, n),
                     uniform(rng, 0, 60, n))
    back = left_leg(uniform(rng, -45, 5, n), uniform(rng, 0, 15, n), np.zeros(n), normal(rng, -8, 10, n),
                    uniform(rng, 0, 70, n))
    both_sideways = rng.random(n) < 0.4
    left = np.where(both_sideways[:, None, None, None], sideways, front)
    return trunk_rotations(rng, n, (8, 18), 10, 12), (left, np.where(both_sideways[:, None, None, None], sideways, back))


# --- arms: each sets both arms of r; `table` is an ArmTable. Returns which poses came out right. ---

def _free(direction_sampler):
    @functools.wraps(direction_sampler)
    def arms(r, table, rng):
        n = len(r)
        alike = rng.random(n) < 0.7
        first = None
        for side in SIDES:
            d, twist, elbow, pronation = direction_sampler(rng, n)
            if first is None:
                first = (d, twist, elbow, pronation)
            else:
                d = np.where(alike[:, None], first[0] + 0.08 * rng.standard_normal((n, 3)), d)
                twist, elbow, pronation = (np.where(alike, a + normal(rng, 0, 5, n), b)
                                           for a, b in zip(first[1:], (twist, elbow, pronation)))
            d /= np.linalg.norm(d, axis=1, keepdims=True)
            wrist = np.stack([normal(rng, 0, 12, n), normal(rng, 0, 8, n)], 1)
            set_arm(r, side, np.broadcast_to(np.eye(3), (n, 3, 3)), arm_from(d, twist, elbow.clip(0, 150 * D), pronation, wrist))
        r[:] = with_shoulder_girdle(r, rng)
        return np.ones(n, bool)
    return arms


def _direction(elevation, forwards):
    """Unit vectors from elevation above the horizontal and angle forwards from the side."""
    return np.stack([np.cos(elevation) * np.cos(forwards), np.sin(elevation), np.cos(elevation) * np.sin(forwards)], 1)


@_free
def arms_hanging(rng, n):
    return (_direction(uniform(rng, -88, -60, n), normal(rng, 20, 40, n)), normal(rng, 0, 18, n), uniform(rng, 0, 35, n),
            normal(rng, 0, 30, n))


@_free
def arms_in_a_pose(rng, n):
    return (_direction(uniform(rng, -70, -15, n), normal(rng, 5, 12, n)), normal(rng, 0, 18, n), uniform(rng, 0, 15, n),
            normal(rng, 0, 35, n))


@_free
def arms_in_t_pose(rng, n):
    return _direction(normal(rng, 0, 8, n), normal(rng, 5, 10, n)), normal(rng, 0, 15, n), uniform(rng, 0, 12, n), normal(rng, 0, 30, n)


@_free
def arms_raised(rng, n):
    return (_direction(uniform(rng, 15, 85, n), uniform(rng, -15, 90, n)), normal(rng, 0, 25, n), uniform(rng, 0, 90, n),
            normal(rng, 0, 30, n))


@_free
def arms_forward(rng, n):
    return (_direction(uniform(rng, -50, 40, n), uniform(rng, 50, 110, n)), normal(rng, 0, 25, n), uniform(rng, 0, 110, n),
            normal(rng, 0, 35, n))


def _reach(r, table, rng, targets):
    """targets: {side: (N, 3)} in the frame of spine3 at its rest place."""
    good = np.ones(len(r), bool)
    for side in SIDES:
        t = targets[side] * ([1, 1, 1] if side == "left" else [-1, 1, 1])
        collar, arm, found = table.reaching(t, rng)
        set_arm(r, side, collar, arm)
        good &= found
    return good


def _around(rng, n, centre, spread=0.035):
    return np.asarray(centre) + spread * rng.standard_normal((n, 3))


def _places(name, left_places, spread=0.035):
    """Both hands at places given for the left hand (x mirrored for the right one), each drawn at random."""
    def arms(r, table, rng):
        n, choice = len(r), {}
        same = rng.random(n) < 0.6
        first = rng.integers(0, len(left_places), n)
        for side in SIDES:
            pick = first if side == "left" else np.where(same, first, rng.integers(0, len(left_places), n))
            place = np.asarray(left_places, float)[pick] * ([1, 1, 1] if side == "left" else [-1, 1, 1])
            choice[side] = _around(rng, n, place, spread)
        return _reach(r, table, rng, choice)
    arms.__name__ = name
    return arms


# Where a left hand rests on a standing body (m, body frame at the T-pose), a few centimetres off the skin.
hands_on_hips = _places("hands_on_hips", [[0.20, 0.02, 0.06], [0.21, -0.05, 0.02], [0.19, 0.04, -0.02]])
hands_on_chest = _places("hands_on_chest", [[0.05, 0.33, 0.19], [-0.05, 0.30, 0.20], [0.06, 0.15, 0.19], [-0.02, 0.05, 0.19], [0.03, -0.02, 0.18]])
hands_behind = _places("hands_behind", [[0.05, -0.05, -0.14], [0.0, 0.05, -0.14], [0.12, -0.10, -0.13]], 0.03)
hands_on_head = _places("hands_on_head", [[0.06, 0.70, 0.03], [0.12, 0.62, 0.05], [0.10, 0.55, 0.10], [0.04, 0.56, -0.10], [0.06, 0.50, 0.14]])
hands_on_shoulders = _places("hands_on_shoulders", [[-0.16, 0.46, 0.10], [-0.18, 0.36, 0.14], [0.14, 0.46, 0.10]])
hugging = _places("hugging", [[-0.05, 0.35, 0.32], [0.0, 0.25, 0.40], [-0.12, 0.40, 0.30], [0.08, 0.30, 0.45], [-0.10, 0.15, 0.30]], 0.05)
hands_together = _places("hands_together", [[0.02, 0.20, 0.28], [0.02, 0.35, 0.25], [0.02, 0.0, 0.25], [0.02, -0.15, 0.20]], 0.03)


def _one_hand(name, places, other_places, spread=0.04):
    """One hand at one set of places, the other at another; which hand is drawn at random. For tests alone: the prior was
    made without them."""
    def arms(r, table, rng):
        n = len(r)
        left_acts = rng.random(n) < 0.5
        acting = np.asarray(places, float)[rng.integers(0, len(places), n)]
        resting = np.asarray(other_places, float)[rng.integers(0, len(other_places), n)]
        targets = {side: _around(rng, n, np.where((left_acts == (side == "left"))[:, None], acting, resting)
                                 * ([1, 1, 1] if side == "left" else [-1, 1, 1]), spread) for side in SIDES}
        return _reach(r, table, rng, targets)
    arms.__name__ = name
    return arms


_HANGING = [[0.30, -0.10, 0.05], [0.34, -0.06, 0.12], [0.28, -0.12, 0.0]]
shaking_hands = _one_hand("shaking_hands", [[0.05, 0.15, 0.50], [0.0, 0.22, 0.52], [0.12, 0.10, 0.45]], _HANGING)
pushing = _places("pushing", [[0.14, 0.35, 0.52], [0.18, 0.28, 0.50], [0.16, 0.42, 0.45], [0.12, 0.22, 0.42]], 0.04)


def arms_crossed(r, table, rng):
    n = len(r)
    height = rng.uniform(0.10, 0.27, n)
    targets = {}
    for side, sign in (("left", -1.0), ("right", 1.0)):
        over = rng.random(n) < 0.5
        depth = np.where(over, 0.21, 0.14)
        targets[side] = np.stack([sign * rng.uniform(0.10, 0.22, n), height + rng.normal(0, 0.03, n),
                                  depth + rng.normal(0, 0.02, n)], 1)
    return _reach(r, table, rng, targets)


def arms_to_legs(r, table, rng):
    """Hands on the thighs, knees, shins or ankles, wherever the legs are."""
    n = len(r)
    world, joints = skeleton.forward(r)
    spine3 = INDEX["spine3"]
    targets = {}
    for side in SIDES:
        other = rng.random(n) < 0.15
        path = {s: np.stack([joints[:, INDEX[f"{s}_{j}"]] for j in ("hip", "knee", "ankle")], 1) for s in SIDES}
        legs = np.where(other[:, None, None], path["right" if side == "left" else "left"], path[side])
        along = rng.uniform(0.3, 1.7, n)
        part = (along >= 1).astype(int)
        at = np.arange(n)
        t = (along - part)[:, None]
        p = legs[at, part] * (1 - t) + legs[at, part + 1] * t
        # Off the bone, towards the shoulders: the hand lies on the skin.
        out = joints[:, INDEX[f"{side}_shoulder"]] - p
        p = p + 0.09 * out / np.linalg.norm(out, axis=1, keepdims=True)
        targets[side] = np.einsum("nji,nj->ni", world[:, spine3], p - joints[:, spine3]) + REST[spine3]
    return _reach(r, table, rng, targets)


def arms_anywhere(r, table, rng):
    n = len(r)
    for side in SIDES:
        pick = rng.integers(0, len(table.arm), n)
        set_arm(r, side, table.collar[pick], table.arm[pick])
    return np.ones(n, bool)


UPRIGHT_ARMS = ((arms_in_a_pose, 4), (arms_in_t_pose, 2), (arms_hanging, 3), (arms_raised, 2), (arms_forward, 2),
                (arms_crossed, 2), (hands_on_hips, 2), (hands_on_chest, 2), (hands_behind, 1), (hands_on_head, 1.5),
                (hands_on_shoulders, 1), (hugging, 2), (hands_together, 1.5), (arms_anywhere, 1))
LOW_ARMS = ((arms_to_legs, 6), (arms_hanging, 1), (arms_forward, 1), (arms_crossed, 1), (hands_on_head, 0.7),
            (hands_together, 1), (hands_on_chest, 0.7), (hugging, 0.5), (arms_raised, 0.7), (arms_anywhere, 0.7))
LEGS = ((standing, UPRIGHT_ARMS, 8), (sitting, LOW_ARMS, 4), (leg_over_knee, LOW_ARMS, 1.5),
        (sitting_on_floor, LOW_ARMS, 2), (cross_legged, LOW_ARMS, 1.5), (squatting, LOW_ARMS, 3),
        (kneeling, UPRIGHT_ARMS, 1.5), (heel_sitting, LOW_ARMS, 1.5), (half_kneeling, LOW_ARMS, 1.5),
        (all_fours, ((arms_forward, 1),), 1), (bending, LOW_ARMS, 2.5), (curled_up, LOW_ARMS, 1),
        (lying, UPRIGHT_ARMS, 1.5), (splits, UPRIGHT_ARMS, 2))


def poses(count, seed):
    """About `count` poses (N, 24, 3), root zero, hands straight; and the name of the kind of each."""
    rng = np.random.default_rng(seed)
    table = ArmTable(rng, 400_000)
    total = sum(weight for _, _, weight in LEGS)
    parts, kinds = [], []
    for legs, arms, weight in LEGS:
        share = sum(w for _, w in arms)
        for arm, w in arms:
            n = max(1, round(count * weight / total * w / share))
            trunk, both_legs = legs(rng, n)
            r = assemble(rng, trunk, both_legs, n)
            good = arm(r, table, rng)
            parts.append(skeleton.vectors(r[good]))
            kinds += [f"{legs.__name__}, {arm.__name__}"] * int(good.sum())
    result = np.concatenate(parts)
    swap = rng.random(len(result)) < 0.5
    result[swap] = skeleton.mirrored(result[swap])
    return result, np.array(kinds)
