"""The package's shape modifiers: how parameters of a character become weights of targets.

A target that is not admitted is left out, or completed from admitted ones: a corner of the macro grid from the
parallelograms of its neighbours, one side of a pair from the mirror image of the other, one sense of a modifier from
the negative of the other. A character has either (parameter "completed", 0..1); a population has some of both.
"""
import itertools

import numpy as np

PREFIX, SUFFIX = "data/targets/", ".target"

AXES = {
    "race": ["caucasian", "asian", "african"],
    "gender": ["female", "male"],
    "age": ["young", "old"],  # 25 and 90 years; the package's child and baby are never used
    "muscle": ["minmuscle", "averagemuscle", "maxmuscle"],
    "weight": ["minweight", "averageweight", "maxweight"],
    "height": ["minheight", "maxheight"],
    "proportions": ["uncommonproportions", "idealproportions"],
    "cup": ["mincup", "averagecup", "maxcup"],
    "firmness": ["minfirmness", "averagefirmness", "maxfirmness"],
}
_BODY = ("gender", "age", "muscle", "weight")
# Family: (axes, file name of a grid corner).
MACRO_FAMILIES = {
    "race": (("race", "gender", "age"), "macrodetails/{race}-{gender}-{age}"),
    "universal": (_BODY, "macrodetails/universal-{gender}-{age}-{muscle}-{weight}"),
    "height": (_BODY + ("height",), "macrodetails/height/{gender}-{age}-{muscle}-{weight}-{height}"),
    "proportions": (
        _BODY + ("proportions",),
        "macrodetails/proportions/{gender}-{age}-{muscle}-{weight}-{proportions}",
    ),
    "breast": (_BODY + ("cup", "firmness"), "breast/{gender}-{age}-{muscle}-{weight}-{cup}-{firmness}"),
}


def _details():
    """(stem with * for the side, suffix of the negative and of the positive sense, standard deviation)."""
    rows = []

    def add(stems, senses, sd):
        rows.extend((stem, *senses.split(), sd) for stem in stems.split())

    limbs = ("lowerarm", "upperarm", "lowerleg", "upperleg")
    for limb in limbs:
        add(f"armslegs/*-{limb}-scale-depth armslegs/*-{limb}-scale-horiz", "decr incr", 0.2)
        add(f"armslegs/*-{limb}-scale-vert", "decr incr", 0.12 if "arm" in limb else 0.15)
        add(f"armslegs/*-{limb}-muscle", "decr incr", 0.25)
        add(f"armslegs/*-{limb}", "skinny fat", 0.25)
    add("armslegs/*-upperarm-shoulder-muscle", "decr incr", 0.3)
    add("armslegs/*-leg-genu", "valgus varun", 0.3)
    for part in ("scale", "scale-depth", "scale-horiz", "scale-vert"):
        add(f"armslegs/*-foot-{part}", "decr incr", 0.2)
    for part in ("fingers-diameter", "fingers-distance", "fingers-length", "scale"):
        add(f"armslegs/*-hand-{part}", "decr incr", 0.2)
    add("buttocks/buttocks-volume", "decr incr", 0.35)
    add("hip/hip-scale-depth hip/hip-scale-vert", "decr incr", 0.2)
    add("hip/hip-scale-horiz", "decr incr", 0.25)
    add("hip/hip-waist", "down up", 0.3)
    add("pelvis/pelvis-tone stomach/stomach-tone", "decr incr", 0.3)
    add("pelvis/bulge", "decr incr", 0.2)
    add("stomach/stomach-pregnant", "decr incr", 0.12)
    add("torso/torso-muscle-dorsi torso/torso-muscle-pectoral", "decr incr", 0.3)
    add("torso/torso-scale-depth torso/torso-scale-horiz torso/torso-scale-vert", "decr incr", 0.2)
    add("torso/torso-vshape", "less more", 0.3)
    add("neck/neck-scale-depth neck/neck-scale-horiz neck/neck-scale-vert", "less more", 0.25)
    add("neck/neck-back-scale-depth", "less more", 0.25)
    add("neck/neck-double", "less more", 0.15)
    add("neck/neck-trans-depth", "forward backward", 0.3)
    add("head/head-scale-depth head/head-scale-horiz head/head-scale-vert head/head-age", "less more", 0.2)
    add("head/head-back-scale-depth", "less more", 0.25)
    add("head/head", "skinny fat", 0.25)
    add("head/head-trans", "backward forward", 0.25)
    add("breast/breast-dist breast/breast-point", "min max", 0.25)
    add("breast/breast-trans-vert", "down up", 0.3)
    add("breast/breast-volume-vert", "down up", 0.25)
    add("nose/nose-scale-vert nose/nose-scale-horiz nose/nose-scale-depth", "decr incr", 0.25)
    add("chin/chin-width chin/chin-height", "min max", 0.25)
    add("chin/chin-prominent", "less more", 0.25)
    for part in (
        "ankle bust calf frontchest hips kneecirc napetowaist neckcirc shoulder thighcirc underbust upperarm waist "
        "waisttohip wrist"
    ).split():
        add(f"measure/measure-{part}", "decrease increase", 0.18)
    add("measure/measure-lowerarmlenght measure/measure-upperarmlenght", "decrease increase", 0.1)
    add("measure/measure-lowerlegheight measure/measure-upperlegheight", "decrease increase", 0.15)
    return rows


DETAILS = _details()


def hats(x):
    """Piecewise linear weights of the anchors 0, 0.5 and 1, [N,3]; beyond [0, 1] they extrapolate linearly."""
    x = np.asarray(x, float)
    return np.stack([np.maximum(0, 1 - 2 * x), 1 - np.abs(2 * x - 1), np.maximum(0, 2 * x - 1)], -1)


def _axis_weights(p):
    """Weights of every value of every axis, {axis: [N,values]}, for parameters p (see characters.draw)."""
    height, proportions = p["height"], p["proportions"]
    return {
        "race": p["race"],
        "gender": np.stack([1 - p["gender"], p["gender"]], -1),
        "age": np.stack([1 - p["age"], p["age"]], -1),
        "muscle": hats(p["muscle"]),
        "weight": hats(p["weight"]),
        "height": np.stack([np.maximum(0, 1 - 2 * height), np.maximum(0, 2 * height - 1)], -1),
        "proportions": np.stack([np.maximum(0, 1 - 2 * proportions), np.maximum(0, 2 * proportions - 1)], -1),
        "cup": hats(p["cup"]),
        "firmness": hats(p["firmness"]),
    }


def _completed_grid(package, axes, name_of):
    """{corner: {source: factor}} for every corner of a macro grid that is admitted or can be completed.

    A corner without a target of its own does not move (the package has none for average cups of average firmness).
    """
    sizes = [range(len(AXES[a])) for a in axes]
    known = {}
    for corner in itertools.product(*sizes):
        name = name_of(corner)
        if package.is_admitted(name):
            known[corner] = {(name, False): 1.0}
        elif not package.has_target(name):
            known[corner] = {}
    # Sex is never crossed within a family of bodies, and never together with age: old women stoop, old men do not.
    free = [k for k, axis in enumerate(axes) if axis != "gender" or "race" in axes]
    pairs = [(i, j) for i, j in itertools.combinations(free, 2) if {axes[i], axes[j]} != {"gender", "age"}]
    while True:
        found = {}
        for corner in itertools.product(*sizes):
            if corner not in known:
                combination = _parallelograms(corner, pairs, sizes, known)
                if combination:
                    found[corner] = combination
        if not found:
            break
        known.update(found)
    age = axes.index("age")
    for corner in itertools.product(*sizes):
        other = corner[:age] + (1 - corner[age],) + corner[age + 1 :]
        if corner not in known and other in known:
            known[corner] = known[other]
    return known


def _parallelograms(corner, pairs, sizes, known):
    """Mean of the nearest parallelograms (one + two - both) over pairs of axes that complete a corner, or {}."""
    candidates = []
    for i, j in pairs:
        for a, b in itertools.product(sizes[i], sizes[j]):
            one, two, both = list(corner), list(corner), list(corner)
            one[i] = both[i] = a
            two[j] = both[j] = b
            if a != corner[i] and b != corner[j] and all(tuple(c) in known for c in (one, two, both)):
                candidates.append((abs(a - corner[i]) + abs(b - corner[j]), tuple(one), tuple(two), tuple(both)))
    nearest = [c[1:] for c in candidates if c[0] == min(d[0] for d in candidates)]
    combination = {}
    for one, two, both in nearest:
        for c, sign in ((one, 1.0), (two, 1.0), (both, -1.0)):
            for source, factor in known[c].items():
                combination[source] = combination.get(source, 0.0) + sign * factor / len(nearest)
    return combination


class Modifiers:
    """Linear map from character parameters to weights of admitted sources.

    sources: [(target, mirrored)]; a mirrored source is the left-right image of the target.
    detail_names, detail_sd: the admitted detail modifiers. left_out: targets that could not be completed.
    """

    def __init__(self, package):
        self._column, self.sources, self.left_out = {}, [], []
        self._grids = []
        for axes, pattern in MACRO_FAMILIES.values():

            def name_of(corner, axes=axes, pattern=pattern):
                values = {axis: AXES[axis][k] for axis, k in zip(axes, corner)}
                return PREFIX + pattern.format(**values) + SUFFIX

            grid = _completed_grid(package, axes, name_of)
            corners = [
                (c, self._columns(combination), list(combination) not in ([], [(name_of(c), False)]))
                for c, combination in grid.items()
            ]
            self._grids.append((axes, corners))
        self.detail_names, sd, self._details = [], [], []
        for stem, negative, positive, deviation in DETAILS:
            both = ("l", "r") if "*" in stem else ("",)
            sides = [self._detail_side(package, stem, side, negative, positive) for side in both]
            if all(sides):
                self.detail_names.append(stem)
                sd.append(deviation)
                self._details.append(sides)
        self.detail_sd = np.array(sd)

    def _columns(self, combination):
        columns = []
        for source, factor in combination.items():
            if source not in self._column:
                self._column[source] = len(self.sources)
                self.sources.append(source)
            columns.append((self._column[source], factor))
        return columns

    def _detail_side(self, package, stem, side, negative, positive):
        """For the negative and the positive sense (columns, whether completed), or None when neither is to be had."""

        def one(sense):
            name = f"{PREFIX}{stem.replace('*', side)}-{sense}{SUFFIX}"
            if package.is_admitted(name):
                return name, False
            other = f"{PREFIX}{stem.replace('*', {'l': 'r', 'r': 'l', '': ''}[side])}-{sense}{SUFFIX}"
            self.left_out.append(name)
            return (other, True) if side and package.is_admitted(other) else None

        low, high = one(negative), one(positive)
        if not low and not high:
            return None
        return tuple(
            (self._columns({own: 1.0} if own else {opposite: -1.0}), own is None or own[1])
            for own, opposite in ((low, high), (high, low))
        )

    def weights(self, p):
        """Weights of the sources, float32 [N,S]. p: parameters as from characters.draw; with "asymmetry" [N,details]
        the left side gets detail + asymmetry."""
        axis = _axis_weights(p)
        out = np.zeros((len(p["gender"]), len(self.sources)), np.float64)
        for axes, corners in self._grids:
            for corner, columns, completed in corners:
                w = np.prod([axis[a][:, k] for a, k in zip(axes, corner)], 0)
                w = w * p["completed"] if completed else w
                for column, factor in columns:
                    out[:, column] += factor * w
        for i, sides in enumerate(self._details):
            for side, (low, high) in enumerate(sides):
                value = p["detail"][:, i] + (p["asymmetry"][:, i] if len(sides) == 2 and side == 0 else 0)
                for (columns, completed), amount in ((low, np.maximum(0, -value)), (high, np.maximum(0, value))):
                    amount = amount * p["completed"] if completed else amount
                    for column, factor in columns:
                        out[:, column] += factor * amount
        return out.astype(np.float32)
