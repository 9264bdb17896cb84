"""The 24 joints of the SMPL form and how the package's 163-bone rig maps onto them."""
import numpy as np

JOINTS = (
    "pelvis left_hip right_hip spine1 left_knee right_knee spine2 left_ankle right_ankle spine3 left_foot right_foot "
    "neck left_collar right_collar head left_shoulder right_shoulder left_elbow right_elbow left_wrist right_wrist "
    "left_hand right_hand"
).split()
PARENT = np.array([-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21])
INDEX = {name: i for i, name in enumerate(JOINTS)}


def mirrored_name(name):
    """Name of the joint on the other side; the name itself on the midline."""
    if name.startswith("left_"):
        return "right_" + name[5:]
    return "left_" + name[6:] if name.startswith("right_") else name


MIRROR = np.array([INDEX[mirrored_name(name)] for name in JOINTS])

# descends[i, j]: joint i is j or hangs below it.
DESCENDS = np.eye(24, dtype=bool)
for _j in range(1, 24):
    DESCENDS[_j] |= DESCENDS[PARENT[_j]]

_MIDLINE_HEADS = {
    "pelvis": ["spine04"], "spine1": ["spine03"], "spine2": ["spine02"], "spine3": ["spine01"], "neck": ["neck01"],
    "head": ["neck03"],
}  # fmt: skip
_SIDE_HEADS = {
    "hip": ["upperleg01"], "knee": ["lowerleg01"], "ankle": ["foot"], "foot": [f"toe{k}-1" for k in range(1, 6)],
    "collar": ["clavicle"], "shoulder": ["upperarm01"], "elbow": ["lowerarm01"], "wrist": ["wrist"],
    "hand": [f"finger{k}-1" for k in range(2, 6)], "index": ["finger2-1"], "pinky": ["finger5-1"],
}  # fmt: skip


def joint_heads():
    """{joint: rig bones whose heads' mean it is}: the 24 joints, and left_/right_ index and pinky knuckles."""
    heads = dict(_MIDLINE_HEADS)
    for side, suffix in (("left", ".L"), ("right", ".R")):
        heads.update({f"{side}_{joint}": [b + suffix for b in bones] for joint, bones in _SIDE_HEADS.items()})
    order = JOINTS + [name for name in heads if name not in INDEX]
    return {name: heads[name] for name in order}


def is_body_bone(bone):
    """False for the tongue and the eyeballs, which lie outside the skin."""
    return not bone.startswith(("tongue", "eye."))


_BONE_JOINT = {
    "root": "pelvis", "spine05": "pelvis", "spine04": "pelvis", "pelvis": "pelvis", "spine03": "spine1",
    "spine02": "spine2", "spine01": "spine3", "breast": "spine3", "neck01": "neck", "neck02": "neck",
    "clavicle": "collar", "shoulder01": "collar", "upperarm01": "shoulder", "upperarm02": "shoulder",
    "lowerarm01": "elbow", "lowerarm02": "elbow", "wrist": "wrist", "upperleg01": "hip", "upperleg02": "hip",
    "lowerleg01": "knee", "lowerleg02": "knee", "foot": "ankle",
}  # fmt: skip


def joint_of_bone(bone):
    """The joint (index) whose motion a rig bone follows; everything above neck03 follows the head."""
    name, side = (bone[:-2], {".L": "left_", ".R": "right_"}[bone[-2:]]) if bone[-2:] in (".L", ".R") else (bone, "")
    if name.startswith("finger"):
        joint = "hand"
    elif name.startswith("metacarpal"):
        joint = "wrist"
    elif name.startswith("toe"):
        joint = "foot"
    else:
        joint = _BONE_JOINT.get(name, "head")
    return INDEX.get(side + joint, INDEX.get(joint))
