"""Phases of a ribbon: where m2 changes its sign, and whether an equilibrium is one of its law."""

from __future__ import annotations

import numpy as np

from .path import Path
from .rod import Array, along, stiffness

SHORT = 1e-6  # of the length: no phase


def changes(
    s: Array, n: Array, m0: Array, r: Array, frames: Array
) -> tuple[tuple[int, ...], list[float]]:
    """Kinds of phases and where m2 changes sign, about."""
    m2 = np.einsum("kj,kj->k", frames[:, 1], m0 + np.cross(n, r - r[0]))
    signs = np.where(m2 >= 0, 1, -1)
    at = np.flatnonzero(signs[1:] != signs[:-1])
    places = s[at] + (s[at + 1] - s[at]) * m2[at] / (m2[at] - m2[at + 1])
    return (int(signs[0]), *(int(signs[i + 1]) for i in at)), places.tolist()


def without_short(
    kinds: list[int], switches: list[float], length: float
) -> tuple[list[int], list[float]]:
    """Drop phases so short that their length is an accident: where it is zero is a double root."""
    ends = [0.0, *switches, length]
    for i in reversed(range(len(kinds))):
        if len(kinds) > 1 and ends[i + 1] - ends[i] < SHORT * length:
            del kinds[i], switches[max(i - 1, 0)]
            ends = [0.0, *switches, length]
    for i in reversed(range(len(switches))):
        if kinds[i] == kinds[i + 1]:
            del kinds[i + 1], switches[i]
    return kinds, switches


def invalid(path: Path) -> str:
    """Return what is wrong with an equilibrium of sheets and mixtures, if anything."""
    if not path.law.switched:
        return ""
    half = path.split(np.full(len(path.kind), 2))
    d = half.frames[:, :, :-1]
    own, force = along(d, half.moments[:, :-1]), along(d, half.n[:, None] + 0 * half.h)
    inside = np.ones(len(half.kind), bool)
    inside[np.flatnonzero(np.diff(half.phases)) + 1] = False
    kind, small = half.kind, 1e-9 * np.abs(own).max()
    if (kind * own[1] < -small)[inside].any():
        return "m2 has the wrong sign on a sheet"
    mixed = kind == 0
    if mixed.any():
        u2, u3 = half.law.strains(kind, own, force)
        if (stiffness(own, force)[mixed] < -small).any():
            return "K < 0 in a mixture"
        if (np.abs(u2) > np.abs(u3) * (1 + 1e-9))[mixed].any():
            return "|u2| > |u3| in a mixture"
    return ""
