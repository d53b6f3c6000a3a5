"""The Moebius ribbon by CasADi as it is usually written: with IPOPT, or its Newton (`rootfinder`).

Gauss collocation in the derivative form of CasADi's examples: an unknown for every state at every
point, constants once. For IPOPT the rates are an SX function in an MX program, as CasADi's own
example has it, Jacobian and exact Hessian by CasADi, its own settings but for the tolerance; for
`rootfinder` all is one SX graph. Equations and guess are those of `peer_states.py`.
"""

from __future__ import annotations

import casadi as ca
import numpy as np
from peer_states import Ribbon

IPOPT, NEWTON = "CasADi IPOPT", "CasADi rootfinder"


class Collocated:
    """The system, built once; only `solve` is timed."""

    def __init__(
        self, ribbon: Ribbon, solver: str, intervals: int, degree: int, tolerance: float
    ) -> None:
        parts, moving, h = ribbon.equations, ribbon.moving, ribbon.length / intervals
        symbol = ca.SX.sym if solver == NEWTON else ca.MX.sym
        tau = ca.collocation_points(degree, "legendre")
        C, D, _ = ca.collocation_coeff(tau)
        c = symbol("c", ribbon.states - moving)
        node = symbol("x0", moving)
        unknowns, defects = [c, node], [parts["start"](ca.vertcat(node, c))]
        for k in range(intervals):
            points = [symbol(f"x{k}_{j}", moving) for j in range(degree)]
            Z = ca.horzcat(node, *points)
            rates = [parts["rates"](ca.vertcat(x, c), ribbon.epsilon)[:moving] for x in points]
            defects.append(ca.vec(h * ca.horzcat(*rates) - ca.mtimes(Z, C)))
            node = symbol(f"x{k + 1}", moving)
            defects.append(ca.mtimes(Z, D) - node)
            unknowns += [*points, node]
        defects.append(parts["end"](ca.vertcat(node, c)))
        x, g = ca.vertcat(*unknowns), ca.vertcat(*defects)
        starts = h * np.arange(intervals + 1)
        along = [
            starts[:1],
            *(np.append(start + h * np.array(tau), start + h) for start in starts[:-1]),
        ]
        states = ribbon.guess_at(np.concatenate(along))
        self._guess = np.concatenate([states[0, moving:], states[:, :moving].ravel()])
        first = len(states[0, moving:]) or moving
        self._loads = slice(first - 6, first)  # constants, or the last states of the first node
        if solver == NEWTON:
            options = {"abstol": tolerance, "linear_solver": "csparse", "error_on_fail": True}
            self._newton = ca.rootfinder("solver", "newton", {"x": x, "g": g}, options)
        else:
            ipopt = {"print_level": 0, "sb": "yes", "tol": tolerance}
            options = {"print_time": False, "error_on_fail": True, "ipopt": ipopt}
            self._ipopt = ca.nlpsol("solver", "ipopt", {"x": x, "f": 0, "g": g}, options)
        self._is_newton = solver == NEWTON

    def solve(self) -> list[float]:
        """Return n(0), m(0)."""
        if self._is_newton:
            answer = self._newton(self._guess, [])
        else:
            answer = self._ipopt(x0=self._guess, lbg=0, ubg=0)["x"]
        loads: list[float] = np.array(answer[self._loads]).ravel().tolist()
        return loads
