"""Phases of a solution in words."""

from __future__ import annotations

from ribbonopt.scene import Scene
from ribbonopt.scene.sized import OfWidth
from ribbonopt.solution.solution import Solution


def phase_words(kinds: tuple[int, ...], switch: str = "m2") -> str:
    """Return the kinds of phases in words; `switch` is what changes sign from one to the next."""
    words = {1: f"{switch} > 0", -1: f"{switch} < 0", 0: f"{switch} = 0 (mixture)"}
    # At a single place where something acts or holds two of one kind meet.
    turns = (kind for i, kind in enumerate(kinds) if not i or kind != kinds[i - 1])
    return ", ".join(words[kind] for kind in turns) or "one, without a sign change"


def switch_of(scene: Scene) -> str:
    """Return what changes sign where phases of a scene meet: m2, but for laws and natural strains.

    T = m2 + K11 + K22 with these, A across the generatrices of a ribbon that has a width.
    """
    if isinstance(scene.law, OfWidth):
        return "m2 + eta m3" if scene.natural is None else "A"
    return "m2" if scene.natural is None else "T"


def changed_phases(before: Solution, after: Solution) -> str:
    """Say which phases there are instead of those before; "" if the same.

    One on one side of the law is the same as none: the law tells the side itself.
    """
    sheets = before.sheets, after.sheets
    one_side = len({*sheets[0], *sheets[1]}) == 1 and 0 not in (*sheets[0], *sheets[1])
    if before.sheets == after.sheets or (one_side and () in sheets):
        return ""
    old, new = (phase_words(one.sheets, switch_of(one.scene)) for one in (before, after))
    return f"phases: {new}; at the point before: {old}"
