"""The half Moebius ribbon by CasADi's own Newton (`rootfinder`) on the 13 states, from 21 nodes.

Gauss collocation of the seven states that change, the six loads at the start as constants, in the
derivative form of CasADi's examples, one SX graph, Jacobian by CasADi. Equations and guess are
those of `peer_states.py`.
"""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
from peer_states import equations, guess, length

MOVING = 7


class HalfMoebius:
    """The system, built once; only `solve` is timed."""

    def __init__(self, intervals: int, degree: int, tolerance: float) -> None:
        parts, h = equations(False), length(False) / intervals
        tau = ca.collocation_points(degree, "legendre")
        C, D, _ = ca.collocation_coeff(tau)
        c = ca.SX.sym("c", 6)
        node = ca.SX.sym("x0", MOVING)
        unknowns, defects = [c, node], [parts["start"](ca.vertcat(node, c))]
        for k in range(intervals):
            points = [ca.SX.sym(f"x{k}_{j}", MOVING) for j in range(degree)]
            Z = ca.horzcat(node, *points)
            rates = [parts["rates"](ca.vertcat(x, c), 0)[:MOVING] for x in points]
            defects.append(ca.vec(h * ca.horzcat(*rates) - ca.mtimes(Z, C)))
            node = ca.SX.sym(f"x{k + 1}", MOVING)
            defects.append(ca.mtimes(Z, D) - node)
            unknowns += [*points, node]
        defects.append(parts["end"](ca.vertcat(node, c)))
        problem = {"x": ca.vertcat(*unknowns), "g": ca.vertcat(*defects)}
        options = {"abstol": tolerance, "linear_solver": "csparse", "error_on_fail": True}
        self._solver = ca.rootfinder("solver", "newton", problem, options)
        s, x = guess(False)
        starts = h * np.arange(intervals + 1)
        along = starts[0:1]
        for start in starts[:-1]:
            along = np.concatenate([along, start + h * np.array(tau), [start + h]])
        states = np.array([np.interp(along, s, values) for values in x.T[:MOVING]]).T
        self._guess = np.concatenate([x[0, MOVING:], states.ravel()])

    def solve(self) -> list[float]:
        """Return n(0), m(0)."""
        found: list[Any] = np.array(self._solver(self._guess, [])[:6]).ravel().tolist()
        return found
