"""Newton's method for all steps at once, meshes that see every layer, and two of them to compare.

Unknown are the force n, the moment m0 at the start, places and frames where steps meet, and the
points where phases meet. A phase is an arc on one sheet of the law, kind +1 or -1, or a mixture, 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from .newton import Conditions, converged
from .path import Path, rotation
from .phases import changes, invalid, without_short
from .rod import Array, Law, along

SHARE = 0.3  # of the distance to the nearest singularity that a step may be long
LONGEST = 1 / 48
LOCAL = 3e-15  # error of one step that is let be
SAMPLES = 2001

Start = Callable[[Array], tuple[Array, Array]]


@dataclass(frozen=True, eq=False)
class Truth:
    """What came out.

    Attributes
    ----------
    verdict
        `found`; `undecided`: why not; `none`: no equilibrium near, or an invalid one.
    reason
        In words, unless found.
    path, coarse
        The equilibrium, and that on steps twice as long: their difference is the error of the
        latter, and bounds that of the former.
    moved
        How far the places and frames moved from the start, at most.
    """

    verdict: str
    reason: str = ""
    path: Path | None = None
    coarse: Path | None = None
    moved: float = np.nan


def polish(
    law: Law,
    n: Array,
    m0: Array,
    start: Start,
    end: tuple[Array, Array] | Conditions,
    *,
    length: float = 1.0,
    kinds: Sequence[int] = (),
    switches: Sequence[float] = (),
    again: int = 2,
) -> Truth:
    """Find the equilibrium near a given one.

    Parameters
    ----------
    law, length
        What ribbon.
    n, m0
        Force and moment at the start (3,), lab frame, about.
    start
        Gives places (k, 3) and frames (k, 3, 3), directors in their rows, at arclengths (k,).
        Those at 0 are prescribed.
    end
        Place (3,) and frame (3, 3) prescribed at the far end; or six conditions, a function of
        place and frame there, n and m0.
    kinds, switches
        Kinds of the phases and where they meet; as m2 changes sign, where none are given.
    again
        How often a new mesh is made where what was found does not suit the mesh.
    """
    n, m0 = np.asarray(n, float), np.asarray(m0, float)
    s = np.linspace(0, length, SAMPLES)
    if law.switched and not len(kinds):
        kinds, switches = changes(s, n, m0, *start(s))
        if law.name == "sadowsky" and len(kinds) > 12:
            return Truth("undecided", f"m2 changes sign {len(kinds) - 1} times: a mixture?")
    if not law.switched:
        kinds, switches = (1,), ()
    kinds, switches = without_short(list(kinds), list(switches), length)
    if 0 in (kinds[0], kinds[-1]):
        return Truth("undecided", "a mixture reaches an end")
    path = first_path(law, n, m0, start, tuple(kinds), np.array(switches, float), length)
    conditions = end if callable(end) else clamped(*end)
    try:
        path = converged(path, conditions)
        before = np.inf
        for _ in range(4):
            parts, worst = wanted_parts(path)
            # In layers rounding is more than what is wanted: how much of it, `coarse` tells.
            if parts.max() == 1 or worst > before / 4:
                break
            path, before = converged(path.split(parts), conditions), worst
        coarse, path = path, converged(path.split(np.full(len(path.kind), 2)), conditions)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return Truth("none", str(error))
    wrong = invalid(path)
    too_long = float((path.h / path.length_scales()).max())
    if (wrong or too_long > SHARE) and again:
        other = () if wrong and law.name == "regularized" else path.kinds
        return polish(
            *(law, path.n, path.m0, path.places, end),
            length=length,
            kinds=other,
            switches=path.switches if other else (),
            again=again - 1,
        )
    if too_long > SHARE:
        return Truth("undecided", f"a step is {too_long:.2g} times the width of a layer")
    places = start(path.s)
    moved = max(float(np.abs(a - b).max()) for a, b in zip(places, path.at_joints, strict=True))
    if wrong:
        return Truth("none", wrong, path, coarse, moved)
    return Truth("found", "", path, coarse, moved)


def clamped(place: Array, frame: Array) -> Conditions:
    """Return the conditions of a clamp."""

    def conditions(r: Array, d: Array, n: Array, m0: Array) -> Array:
        return np.concatenate([r - place, rotation(d, frame)])

    return conditions


def first_path(
    law: Law,
    n: Array,
    m0: Array,
    start: Start,
    kinds: tuple[int, ...],
    switches: Array,
    length: float,
) -> Path:
    """Return a path with joints as near to each other as layers ask for."""
    s = np.linspace(0, length, SAMPLES)
    r, frames = start(s)
    if not law.switched:
        near = np.array(changes(s, n, m0, r, frames)[1])
    else:
        near = switches
    # Near changes of sign samples must be as dense as a layer is thin.
    offsets = np.geomspace(1e-7, 1e-2, 60) * length
    s = np.concatenate([s, *(x + side * offsets for x in near for side in (-1, 1)), near, switches])
    s = np.unique(np.clip(s, 0, length))
    r, frames = start(s)
    d = np.moveaxis(frames, 0, 2)
    own = along(d, (m0 + np.cross(n, r - r[0])).T)
    force = along(d, n[:, None] + 0 * s)
    phase = np.searchsorted(switches, s, side="right")
    kind = np.array(kinds)[phase]
    h = np.minimum(SHARE * 0.8 * law.distance(kind, own, force), LONGEST * length)
    count = np.concatenate([[0], np.cumsum(np.diff(s) * 2 / (h[1:] + h[:-1]))])
    ends = np.concatenate([[0.0], switches, [length]])
    fractions, phases = [], []
    for i, (a, b) in enumerate(pairwise(ends)):
        c = np.interp([a, b], s, count)
        parts = int(np.ceil(c[1] - c[0])) + 2
        joints = np.interp(np.linspace(*c, parts + 1), count, s)
        widths = np.diff(joints)
        fractions.append(widths / widths.sum())
        phases += [i] * parts
    path = Path(
        law=law,
        kinds=kinds,
        fractions=np.concatenate(fractions),
        phases=np.array(phases),
        switches=switches,
        length=length,
        n=n,
        m0=m0,
        r=np.zeros((3, 0)),
        frames=np.zeros((3, 3, 0)),
    )
    r, frames = start(np.clip(path.s, 0, length))
    return replace(path, r=r.T.copy(), frames=np.moveaxis(frames, 0, 2).copy())


def wanted_parts(path: Path) -> tuple[Array, float]:
    """Parts (K,) into which steps are to be split, from what halves make of them; worst error."""
    way, frame, energy = path.steps()
    half = path.split(np.full(len(path.kind), 2))
    way2, frame2, energy2 = half.steps()
    error = np.abs(way - way2[:, ::2] - way2[:, 1::2]).max(axis=0)
    error = np.maximum(error, np.abs(frame - frame2[:, :, 1::2]).max(axis=(0, 1)))
    error = np.maximum(error, np.abs(energy - energy2[::2] - energy2[1::2]) / (1 + energy.sum()))
    parts = np.ceil((np.maximum(error / LOCAL, 1e-9)) ** (1 / 9) * 1.1)
    return np.where(error > LOCAL, np.maximum(parts, 2), 1).astype(int), float(error.max())
