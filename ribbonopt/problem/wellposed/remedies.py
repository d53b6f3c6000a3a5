"""Remedies for what `motions` finds: what to exchange for what."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ModelError

from .linearized import Linearized
from .wording import SMALL, Ends, separated, words

TELLING = 0.3  # share of the largest effect on a motion that makes a condition worth proposing


def motion_refusal(conditions: Linearized, z: Array, free: Array) -> ModelError:
    """Return the error that names free motions (6, k), and what to exchange for what."""
    ends = _ends(conditions, z)
    shifts, turns = separated(free)
    which, key = _superfluous(conditions, z, free.shape[1])
    remedy = _proposal(ends, np.vstack([shifts, turns]))
    hinge = _hinge(conditions, z) if _about_chord(shifts, turns, ends) else ""
    return ModelError(
        f"boundary: the conditions leave the ribbon free {words(shifts, turns, ends)}. Exchange "
        f"{which} for what opposes it, for example {remedy}{hinge}",
        key,
    )


def sliding_refusal(conditions: Linearized, z: Array) -> ModelError:
    """Return the error that names sliding, and the remedy."""
    ends = _ends(conditions, z)
    d1 = ends.frames[0][:, 0]
    axis = int(np.abs(d1).argmax())
    remedies = ["say boundary: {loop: {half_twists: 1}} (or as many as it has)"]
    prescribed = all(f"boundary.end.position.{a}" in conditions.names for a in "xyz")
    if prescribed and abs(d1[axis]) > 1 - SMALL:
        # By symmetry the gap along d1 then closes, see `mechanics.loops`.
        end = conditions.parts(z)[1]
        place = _place(end[:3], [i for i in range(3) if i != axis])
        remedies.insert(
            0,
            f"replace boundary.end.position by {place} and add force: {{d1: 0}} to boundary.start",
        )
    return ModelError(
        "boundary: the loop may slide along itself: its ends are joined wherever it starts; "
        + "; or ".join(remedies),
        "boundary.end.position" if prescribed else "boundary",
    )


def _ends(conditions: Linearized, z: Array) -> Ends:
    states = conditions.parts(z)[:2]
    places = [conditions.ribbon.model.place(x) for x in states]
    r = np.array([r for r, _ in places]) - conditions.reference
    frames = np.array([frame for _, frame in places])
    return Ends(r / conditions.length, frames, -conditions.reference / conditions.length)


def _superfluous(conditions: Linearized, z: Array, count: int) -> tuple[str, str]:
    """Conditions that follow from the others at z (else those on loads), and the last one's key."""
    jacobian = conditions.at(z)[1] * conditions.scales(z)
    left, singular, _ = np.linalg.svd(jacobian / np.linalg.norm(jacobian, axis=1, keepdims=True))
    dependent = left[:, singular < SMALL]
    own = [name.startswith("start: ") for name in conditions.names]
    chosen = np.abs(dependent).max(axis=1, initial=0.0) > SMALL
    if dependent.shape[1] < count:
        chosen = np.array(
            [".force" in n or ".moment" in n or ".also" in n for n in conditions.names]
        )
    names = [n for n, c, o in zip(conditions.names, chosen, own, strict=True) if c and not o]
    if not names:
        names = [n for n, o in zip(conditions.names, own, strict=True) if not o]
    key = names[-1].partition(" ")[0]
    if len(names) == count:
        return _listed(names), key
    return f"{'one' if count == 1 else count} of {_listed(names)}", key


def _listed(names: list[str]) -> str:
    """List names; of components of one vector, the first in full: `a.b.x, .y, .z`."""
    result, last = [], ""
    for name in names:
        stem, _, axis = name.rpartition(".")
        result.append(f".{axis}" if stem == last else name)
        last = stem
    return ", ".join(result)


def _proposal(ends: Ends, motions: Array) -> str:
    """Conditions to add that oppose motions (k, 6): the first in the scene's order that tell."""
    names, rates = [], []
    for end, r, frame in zip(("start", "end"), ends.r, ends.frames, strict=True):
        vectors = {"position": motions[:, :3] + np.cross(motions[:, 3:], r)}
        vectors |= {f"d{i + 1}": np.cross(motions[:, 3:], frame[:, i]) for i in range(3)}
        for quantity, rate in vectors.items():
            names += [(end, quantity, axis) for axis in "xyz"]
            rates.append(rate.T)
    left = np.concatenate(rates)
    chosen: dict[tuple[str, str], list[str]] = {}
    for _ in motions:
        sizes = np.linalg.norm(left, axis=1)
        pick = int((sizes > TELLING * sizes.max()).argmax())
        end, quantity, axis = names[pick]
        chosen.setdefault((end, quantity), []).append(axis)
        unit = left[pick] / sizes[pick]
        left = left - np.outer(left @ unit, unit)
    return " and ".join(_lines(chosen))


def _lines(chosen: dict[tuple[str, str], list[str]]) -> list[str]:
    """Lines of a scene that prescribe zero for components."""
    result = []
    for end in ("start", "end"):
        frame = {q: axes for (e, q), axes in chosen.items() if e == end and q != "position"}
        if sum(map(len, frame.values())) == 3:
            frame = {}
            result.append(f"boundary.{end}.directors: identity")
        place = chosen.get((end, "position"), [])
        if len(place) == 3:
            result.insert(0, f"boundary.{end}.position: [0, 0, 0]")
        elif place:
            frame = {"position": place} | frame
        for quantity, axes in frame.items():
            values = ", ".join(f"{axis}: 0" for axis in sorted(axes))
            result.append(f"boundary.{end}.{quantity}: {{{values}}}")
    return result


def _about_chord(shifts: Array, turns: Array, ends: Ends) -> bool:
    return (len(shifts), len(turns)) == (0, 1) and "ends" in words(shifts, turns, ends)


def _hinge(conditions: Linearized, z: Array) -> str:
    """Remedy for ends that are pinned both: an axis across the line through them."""
    if not all(f"boundary.start.position.{a}" in conditions.names for a in "xyz"):
        return ""
    start, end, _ = conditions.parts(z)
    axis = int(np.abs(end[:3] - start[:3]).argmin())
    along = ", ".join("1" if i == axis else "0" for i in range(3))
    return (
        "; or make one end a hinge: boundary.start: {support: hinged, position: "
        f"{_place(z[:3], [0, 1, 2])}, axis: d2, along: [{along}]}}"
    )


def _place(r: Array, kept: list[int]) -> str:
    """Write components of a position; dots for numbers, which the scene may have in SI."""
    values = {"xyz"[i]: "0" if abs(r[i]) < SMALL else "..." for i in kept}
    if len(kept) == 3:
        return f"[{', '.join(values.values())}]"
    return f"{{{', '.join(f'{axis}: {value}' for axis, value in values.items())}}}"
