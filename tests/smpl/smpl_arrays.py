"""The default body as arrays of the SMPL family's models, at any number of vertices, and their published formulas."""
import numpy as np

FINGERS = {"smplh": (22, 37), "smplx": (25, 40)}
JOINTS = {"smpl": 24, "star": 24, "smplh": 52, "smplx": 55}
MIDDLE_FINGER = 3  # place of middle1 among a hand's 15 joints


def to_dense(body):
    """shapedirs [V,3,K] and posedirs [V,3,207] of tests/models/support.made_body()."""
    posedirs = np.zeros((len(body.v), 3, 207))
    vertex, joint, blocks = body.correctives
    for k in range(9):
        posedirs[vertex, :, 9 * (joint - 1) + k] = blocks[:, :, k]
    return {
        "v_template": body.v.astype(float),
        "shapedirs": np.moveaxis(body.shapedirs, 0, 2).astype(float),
        "posedirs": posedirs,
        "weights": body.weights,
        "J_regressor": body.regressor,
        "f": body.faces.astype(np.uint32),
        "parents": body.raw["parent"].astype(int),
    }


def resampled(model, vertices):
    """The model with more vertices: its longest edges are halved, everything is interpolated."""
    m = {k: v.copy() for k, v in model.items()}
    while len(m["v_template"]) < vertices:
        f = m["f"].astype(int)
        edges = np.sort(np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), 1)
        unique, owner = np.unique(edges, axis=0, return_inverse=True)
        faces_of = np.argsort(owner, kind="stable").reshape(-1, 2) % len(f)
        length = np.linalg.norm(m["v_template"][unique[:, 0]] - m["v_template"][unique[:, 1]], axis=1)
        touched, chosen = np.zeros(len(f), bool), []
        for e in np.argsort(-length):
            if len(chosen) + len(m["v_template"]) >= vertices:
                break
            if not touched[faces_of[e]].any():
                touched[faces_of[e]] = True
                chosen.append(e)
        ends, old = unique[chosen], len(m["v_template"])
        for name in ("v_template", "shapedirs", "posedirs", "weights"):
            m[name] = np.concatenate([m[name], m[name][ends].mean(1)])
        m["J_regressor"] = np.concatenate([m["J_regressor"], np.zeros((len(m["J_regressor"]), len(ends)))], 1)
        new_faces = list(f[~touched])
        for n, e in enumerate(chosen):
            for face in f[faces_of[e]]:
                corner = next(k for k in range(3) if face[k] not in unique[e])
                a, b, c = np.roll(face, -corner)
                new_faces += [np.array([a, b, old + n]), np.array([a, old + n, c])]
        m["f"] = np.array(new_faces, np.uint32)
    return m


def tiny(model, vertices=30):
    """A model with few vertices spread over the body and meaningless faces: small files for tests of damage."""
    kept = np.linspace(0, len(model["v_template"]) - 1, vertices).astype(int)
    m = {k: model[k][kept] for k in ("v_template", "posedirs", "weights")}
    m["shapedirs"] = model["shapedirs"][kept, :, :4]
    m["J_regressor"] = np.eye(24, vertices)
    m["f"] = np.stack([np.arange(vertices), np.roll(np.arange(vertices), 1), np.roll(np.arange(vertices), 2)], 1)
    m["f"] = m["f"].astype(np.uint32)
    m["parents"] = model["parents"]
    return m


def with_columns(model, columns, seed):
    """The model with so many shape directions: the first ones, then small smooth ones made up."""
    m = dict(model)
    have = m["shapedirs"].shape[2]
    random = np.random.default_rng(seed)
    extra = [0.004 * np.sin(m["v_template"] @ random.normal(0, 4, (3, 3)) + random.uniform(0, 6, 3))
             for _ in range(max(0, columns - have))]
    m["shapedirs"] = np.concatenate([m["shapedirs"][:, :, :columns]] + [e[:, :, None] for e in extra], 2)
    return m


def with_dense_correctives(model, seed):
    """Correctives that move every vertex a little with every joint, as the official files have them."""
    noise = np.random.default_rng(seed).normal(0, 2e-4, model["posedirs"].shape)
    return dict(model, posedirs=model["posedirs"] + noise)


def with_fingers(model, family):
    """SMPL+H or SMPL-X: the hand's joint becomes the middle finger's first; the others are joints nobody follows."""
    first = FINGERS[family]
    joints = JOINTS[family]
    target = np.arange(24)
    target[22], target[23] = first[0] + MIDDLE_FINGER, first[1] + MIDDLE_FINGER
    m = dict(model)
    m["weights"] = np.zeros((len(model["v_template"]), joints))
    m["weights"][:, target] = model["weights"]
    m["posedirs"] = np.zeros(model["posedirs"].shape[:2] + (9 * (joints - 1),))
    for j in range(1, 24):
        t = target[j]
        m["posedirs"][:, :, 9 * (t - 1):9 * t] = model["posedirs"][:, :, 9 * (j - 1):9 * j]
    m["J_regressor"] = np.zeros((joints, len(model["v_template"])))
    m["J_regressor"][target] = model["J_regressor"]
    parents = np.full(joints, -1)
    parents[:22] = model["parents"][:22]
    for side in (0, 1):
        for k in range(15):
            j = first[side] + k
            parents[j] = 20 + side if k % 3 == 0 else j - 1
            if k != MIDDLE_FINGER:
                m["J_regressor"][j] = model["J_regressor"][22 + side]
    if family == "smplx":
        parents[22:25] = 15
        m["J_regressor"][22:25] = model["J_regressor"][15]
        head = model["weights"][:, 15] > 0.9
        lower = head & (model["v_template"][:, 1] < np.median(model["v_template"][head, 1]))
        m["weights"][lower, 22], m["weights"][lower, 15] = 0.4 * m["weights"][lower, 15], 0.6 * m["weights"][lower, 15]
    m["parents"] = parents
    return m


def as_star(model):
    """STAR: correctives by quaternions, linear parts equal at rest, and one more by the second beta."""
    m = dict(model)
    turns = np.zeros((9, 4))  # d vec(R) / d (x, y, z, w)
    for k, (row, column, sign) in enumerate([((2, 1), (1, 2), 1), ((0, 2), (2, 0), 1), ((1, 0), (0, 1), 1)]):
        turns[3 * row[0] + row[1], k], turns[3 * column[0] + column[1], k] = 2 * sign, -2 * sign
    blocks = model["posedirs"].reshape(len(model["v_template"]), 3, 23, 9) @ turns
    blocks[..., 3] = -0.5 * np.abs(blocks[..., :3]).sum(-1)
    second_beta = 0.002 * np.sin(7 * model["v_template"])
    m["posedirs"] = np.concatenate([blocks.reshape(len(second_beta), 3, 92), second_beta[:, :, None]], 2)
    return m


def rotations(pose):
    theta = pose.reshape(-1, 3)
    angle = np.linalg.norm(theta, axis=1)[:, None, None]
    x, y, z = (theta / np.maximum(angle[:, :, 0], 1e-12)).T
    zero = np.zeros_like(x)
    k = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], 1).reshape(-1, 3, 3)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def forward(model, family, pose, coefficients):
    """Posed vertices by the published formulas; coefficients go with the first columns of shapedirs."""
    turns = rotations(pose)
    shaped = model["v_template"] + model["shapedirs"][:, :, :len(coefficients)] @ coefficients
    joints = model["J_regressor"] @ shaped
    if family == "star":
        theta = pose.reshape(-1, 3)
        angle = np.linalg.norm(theta, axis=1, keepdims=True)
        quaternions = np.concatenate([np.sin(angle / 2) * theta / np.maximum(angle, 1e-12), np.cos(angle / 2) - 1], 1)
        feature = np.append(quaternions[1:].ravel(), coefficients[1])
    else:
        feature = (turns[1:] - np.eye(3)).ravel()
    rest = shaped + model["posedirs"] @ feature
    world = np.zeros((len(turns), 4, 4))
    for j, parent in enumerate(model["parents"]):
        local = np.eye(4)
        local[:3, :3] = turns[j]
        local[:3, 3] = joints[j] - (joints[parent] if parent >= 0 else 0)
        world[j] = world[parent] @ local if parent >= 0 else local
    offsets = world[:, :3, 3] - np.einsum("jab,jb->ja", world[:, :3, :3], joints)
    blended = np.einsum("vj,jab->vab", model["weights"], world[:, :3, :3])
    return np.einsum("vab,vb->va", blended, rest) + model["weights"] @ offsets
