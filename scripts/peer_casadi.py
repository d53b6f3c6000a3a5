"""The half Moebius ribbon by CasADi, transcribed as it is usually written.

The 18 states of eq. (4.5), `collocation_points` of degree 3, an unknown for every state at every
point, defects in derivative form, the rates as an SX function in an MX program (as CasADi's own
example has it), Jacobian and exact Hessian by CasADi, IPOPT with its own settings but for the
tolerance. The guess is the same: n(0), m(0), integrated.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

DEGREE = 3


def rates() -> ca.Function:
    """Right-hand side of eq. (4.5) for x = (r, d1, d2, d3, n, m) and Sadowsky's law."""
    x = ca.SX.sym("x", 18)
    _, d1, d2, d3, n, m = ca.vertsplit(x, 3)
    m2, m3 = ca.dot(m, d2), ca.dot(m, d3)
    M, mu = ca.sqrt(m2**2 + m3**2), ca.fabs(m2)
    u2, u3 = ca.sign(m2) * (M + mu) ** 2 / (4 * M), m3 * (M + mu) / (4 * M)
    u = u2 * d2 + u3 * d3
    turned = [ca.cross(u, d) for d in (d1, d2, d3)]
    return ca.Function("f", [x], [ca.vertcat(d3, *turned, ca.SX.zeros(3), ca.cross(n, d3))])


class HalfMoebius:
    """The program, built once; only `solve` is timed."""

    def __init__(self, force: tuple[float, ...], moment: tuple[float, ...], intervals: int) -> None:
        self.intervals = intervals
        f = rates()
        h = 0.5 / intervals
        tau = ca.collocation_points(DEGREE, "legendre")
        C, D, _ = ca.collocation_coeff(tau)
        node = ca.MX.sym("x0", 18)
        unknowns, equations = [node], self._start(node)
        for k in range(intervals):
            points = [ca.MX.sym(f"x{k}_{j}", 18) for j in range(DEGREE)]
            Z = ca.horzcat(node, *points)
            slopes = ca.mtimes(Z, C)
            equations += [h * f(points[j]) - slopes[:, j] for j in range(DEGREE)]
            following = ca.MX.sym(f"x{k + 1}", 18)
            equations.append(ca.mtimes(Z, D) - following)
            unknowns += [*points, following]
            node = following
        _, d1, _, d3, _, _ = ca.vertsplit(node, 3)
        equations += [node[1:3], d1[0], d3[0]]
        problem = {"x": ca.vertcat(*unknowns), "f": 0, "g": ca.vertcat(*equations)}
        options = {
            "print_time": False,
            "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-10},
        }
        self._solver = ca.nlpsol("solver", "ipopt", problem, options)
        self._guess = self._integrated(f, h, [0.0, *tau], force, moment)

    def solve(self) -> tuple[np.ndarray, np.ndarray]:
        """Return n(0) and m(0)."""
        answer = np.array(self._solver(x0=self._guess, lbg=0, ubg=0)["x"]).ravel()
        return answer[12:15], answer[15:18]

    @staticmethod
    def _start(x: ca.MX) -> list[ca.MX]:
        frame = ca.DM(np.eye(3).ravel())
        return [x[:3], x[3:12] - frame, ca.dot(x[12:15], x[3:6]), ca.dot(x[15:18], x[3:6])]

    def _integrated(
        self,
        f: ca.Function,
        h: float,
        tau: list[float],
        force: tuple[float, ...],
        moment: tuple[float, ...],
    ) -> np.ndarray:
        """States of the guess at all nodes and points, by Runge-Kutta steps between them."""
        x = np.concatenate([np.zeros(3), np.eye(3).ravel(), force, moment])
        times = [h * (k + t) for k in range(self.intervals) for t in tau] + [0.5]
        found = [x]
        for step in np.diff(times):
            k1 = np.array(f(x)).ravel()
            k2 = np.array(f(x + step / 2 * k1)).ravel()
            k3 = np.array(f(x + step / 2 * k2)).ravel()
            k4 = np.array(f(x + step * k3)).ravel()
            x = x + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            found.append(x)
        return np.concatenate(found)
