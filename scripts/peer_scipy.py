"""The half Moebius ribbon by scipy's `solve_bvp`, written as its users would, with Jacobians.

The 18 states of eq. (4.5) would be unkind to it: it gets the reduced system too, r and a unit
quaternion with six unknown parameters, analytic Jacobians from CasADi, and the same guess on 21
nodes. The law is Sadowsky's or, with an epsilon, that of eq. (6.1).
"""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np
from scipy.integrate import solve_bvp, solve_ivp


@lru_cache
def _functions(regularized: bool) -> tuple[ca.Function, ca.Function]:
    x, c, epsilon = ca.SX.sym("x", 7), ca.SX.sym("c", 6), ca.SX.sym("epsilon")
    a, b, g, d = x[3], x[4], x[5], x[6]
    d2 = ca.vertcat(2 * (b * g - a * d), a * a - b * b + g * g - d * d, 2 * (g * d + a * b))
    d3 = ca.vertcat(2 * (b * d + a * g), 2 * (g * d - a * b), a * a - b * b - g * g + d * d)
    m = c[3:] + ca.cross(c[:3], x[:3])
    m2, m3 = ca.dot(m, d2), ca.dot(m, d3)
    M, mu = ca.sqrt(m2**2 + m3**2), ca.fabs(m2)
    u2, u3 = ca.sign(m2) * (M + mu) ** 2 / (4 * M), m3 * (M + mu) / (4 * M)
    if regularized:
        u2 = m2 * (M + mu) ** 2 / (2 * M * (2 * mu + epsilon * (M + mu)))
    dq = ca.vertcat(-g * u2 - d * u3, g * u3 - d * u2, a * u2 - b * u3, a * u3 + b * u2) / 2
    f = ca.vertcat(d3, dq)
    ends = ca.SX.sym("x0", 7), ca.SX.sym("x1", 7)
    y = ends[1]
    d1x = y[3] ** 2 + y[4] ** 2 - y[5] ** 2 - y[6] ** 2
    d3x = 2 * (y[4] * y[6] + y[3] * y[5])
    conditions = ca.vertcat(ends[0] - ca.DM([0, 0, 0, 1, 0, 0, 0]), c[0], c[3], y[1:3], d1x, d3x)
    rates = ca.Function("f", [x, c, epsilon], [f, ca.jacobian(f, x), ca.jacobian(f, c)])
    unknowns = [*ends, c]
    bc = ca.Function("b", unknowns, [conditions, *(ca.jacobian(conditions, v) for v in unknowns)])
    return rates, bc


class HalfMoebius:
    """The problem with its guess already integrated, so that only the solve is timed."""

    def __init__(
        self, force: tuple[float, ...], moment: tuple[float, ...], epsilon: float = 0.0
    ) -> None:
        self.epsilon = epsilon
        self._rates, self._conditions = _functions(epsilon > 0)
        self.s = np.linspace(0, 0.5, 21)
        self.c = np.array([*force, *moment])
        start = np.array([0, 0, 0, 1.0, 0, 0, 0])
        path = solve_ivp(
            lambda s, x: self._at(x[:, None], self.c)[0][:, 0],
            (0, 0.5),
            start,
            t_eval=self.s,
            rtol=1e-6,
        )
        self.guess = path.y

    def solve(self, tolerance: float, keep: bool = False) -> tuple[np.ndarray, int]:
        """Return n(0), m(0) and the number of nodes; `tolerance` is solve_bvp's own.

        The answer is the next guess where it is to be kept.
        """
        answer = solve_bvp(
            lambda s, x, c: self._at(x, c)[0],
            lambda a, b, c: np.array(self._conditions(a, b, c)[0]).ravel(),
            self.s,
            self.guess,
            p=self.c,
            fun_jac=self._jacobians,
            bc_jac=lambda a, b, c: tuple(np.array(v) for v in self._conditions(a, b, c)[1:]),
            tol=tolerance,
            max_nodes=200_000,
        )
        if keep:
            assert answer.success, answer.message
            self.s, self.guess, self.c = answer.x, answer.y, answer.p
        return answer.p, len(answer.x)

    def _at(self, x: np.ndarray, c: np.ndarray) -> list[np.ndarray]:
        count = x.shape[1]
        numbers = np.repeat(c[:, None], count, axis=1), np.full((1, count), self.epsilon)
        return [np.array(v) for v in self._rates(x, *numbers)]

    def _jacobians(
        self, s: np.ndarray, x: np.ndarray, c: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        _, fx, fc = self._at(x, c)
        count = x.shape[1]
        fx, fc = fx.reshape(7, count, 7), fc.reshape(7, count, 6)
        return fx.transpose(0, 2, 1), fc.transpose(0, 2, 1)
