"""What a guess shows before anything is solved: on which sides of the law's switch the ribbon is.

A guess that crosses the switch is tried in phases at once: Newton's method sees a smooth law there,
and nothing is solved without phases that would be solved again in them. Noise on a guess makes it
cross everywhere, and Newton's method meet a kink at every step; averages along the ribbon tell the
side all the same.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.checks.arcs import Arcs, sign_changes
from ribbonopt.guess.unknowns import places_of
from ribbonopt.problem import Ribbon
from ribbonopt.transcription.buffered import Mapped

WINDOW = 0.1  # of the length, over which values are averaged: shorter arcs may be noise
CLEAR = 0.5  # share of the averages' size that is left of them in all, where one side prevails
WHOLE = np.array([0.0, 1.0])


def crosses(attempt: Attempt, w: Array) -> bool:
    """Whether unknowns w (nw,) of an attempt without phases are on both sides of the switch."""
    _, values = _sides_along(attempt, w)
    return bool(values.min() < 0 < values.max())


def phases_shown(attempt: Attempt, w: Array) -> Arcs | None:
    """Return the arcs that unknowns w (nw,) show beyond doubt, if there are several; else None.

    They are if averages along the ribbon show the same.
    """
    means = _averages(*_sides_along(attempt, w))
    shown, signs = sign_changes(attempt.restored(w)), np.sign(means)
    several = 1 < len(shown.kinds) == 1 + np.count_nonzero(signs[1:] != signs[:-1])
    return shown if several else None


def side_shown(attempt: Attempt, w: Array) -> int | None:
    """Return the one side on which unknowns w (nw,) are behind their noise; None if on both."""
    means = _averages(*_sides_along(attempt, w))
    mean = float(means.mean())
    return int(np.sign(mean)) if abs(mean) > CLEAR * np.abs(means).mean() else None


def _averages(fractions: Array, values: Array) -> Array:
    """Averages (k,) of values (k,) over a window that moves along the ribbon."""
    steps = np.diff(fractions)
    sums = np.append(0.0, np.cumsum(steps * (values[1:] + values[:-1]) / 2))
    at = np.linspace(0.0, 1 - WINDOW, len(values))
    before, after = (np.interp(x, fractions, sums) for x in (at, at + WINDOW))
    return np.asarray((after - before) / WINDOW)


def _sides_along(attempt: Attempt, w: Array) -> tuple[Array, Array]:
    """Fractions (k,) of nodes and stages, in order, and values (k,) of the law's switch there."""
    ribbon, layout, blocks = attempt.ribbon, attempt.nlp.layout, attempt.nlp.blocks
    nodes, stages, constants = layout.unpack(w)
    inside = np.concatenate([nodes[:-1, None], stages[..., : layout.nx]], axis=1)
    states = np.concatenate([inside.reshape(-1, layout.nx), nodes[-1:]])
    start, end = attempt.posed.scene.interval
    fractions = places_of(blocks, attempt.p, WHOLE)
    theta, s = layout.theta(attempt.p), start + (end - start) * fractions
    return fractions, ribbon.kept(_sides)(states, constants, theta, s)[0]


def _sides(ribbon: Ribbon) -> Mapped:
    """Return what changes sign where the law switches, of (x, c, theta, s)."""
    x, c = ca.SX.sym("x", len(ribbon.states)), ca.SX.sym("c", len(ribbon.constants))
    stress = ribbon.section(x, c).rod.stress
    value = ca.densify(ribbon.law.switching(stress).value)
    return Mapped(ca.Function("sides", [x, c, ribbon.parameters, ribbon.position], [value]))
