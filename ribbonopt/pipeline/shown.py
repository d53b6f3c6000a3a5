"""What a guess shows before anything is solved: on which sides of the law's switch the ribbon is.

A guess that crosses the switch is tried in phases at once: Newton's method sees a smooth law there,
and nothing is solved without phases that would be solved again in them.
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

MOST = 4  # phases of a guess: more of them are noise
WHOLE = np.array([0.0, 1.0])


def sides_along(attempt: Attempt, w: Array) -> Array:
    """Value (k,) of the law's switch at nodes and stages, in order, of unknowns w (nw,).

    Of an attempt without phases; Dw = L = 1.
    """
    ribbon, layout, blocks = attempt.ribbon, attempt.nlp.layout, attempt.nlp.blocks
    nodes, stages, constants = layout.unpack(w)
    inside = np.concatenate([nodes[:-1, None], stages[..., : layout.nx]], axis=1)
    states = np.concatenate([inside.reshape(-1, layout.nx), nodes[-1:]])
    start, end = attempt.posed.scene.interval
    s = start + (end - start) * places_of(blocks, attempt.p, WHOLE)
    (values,) = ribbon.kept(_sides)(states, constants, layout.theta(attempt.p), s)
    return values


def phases_shown(attempt: Attempt, w: Array) -> Arcs | None:
    """Return the arcs that unknowns w (nw,) show; None where there is one, or too many of them."""
    values = sides_along(attempt, w)
    if not (values.min() < 0 < values.max()):
        return None
    arcs = sign_changes(attempt.restored(w))
    return arcs if 1 < len(arcs.kinds) <= MOST else None


def side_shown(attempt: Attempt, w: Array) -> int:
    """Return the side on which most of the ribbon is, by unknowns w (nw,) that may be noisy."""
    return 1 if np.sign(sides_along(attempt, w)).sum() >= 0 else -1


def _sides(ribbon: Ribbon) -> Mapped:
    """Return what changes sign where the law switches, of (x, c, theta, s)."""
    x, c = ca.SX.sym("x", len(ribbon.states)), ca.SX.sym("c", len(ribbon.constants))
    stress = ribbon.section(x, c).rod.stress
    value = ca.densify(ribbon.law.switching(stress).value)
    return Mapped(ca.Function("sides", [x, c, ribbon.parameters, ribbon.position], [value]))
