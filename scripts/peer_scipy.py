"""The Moebius ribbon by scipy's `solve_bvp`, written as its users would, with analytic Jacobians.

On 18 states all are unknown along s; on 13 the six that do not change are its unknown parameters.
Equations, Jacobians by CasADi and the guess on 21 nodes are those of `peer_states.py`.
"""

from __future__ import annotations

import numpy as np
from peer_states import Ribbon
from scipy.integrate import solve_bvp


class Scipy:
    """The problem with its guess already integrated, so that only the solve is timed."""

    def __init__(self, ribbon: Ribbon, epsilon: float | None = None) -> None:
        self.ribbon, self.epsilon = ribbon, ribbon.epsilon if epsilon is None else epsilon
        self._f = ribbon.equations
        self.s, x = ribbon.guess(self.epsilon)
        self._x, self._c = x.T[: ribbon.moving], x[0, ribbon.moving :]

    def solve(self, tolerance: float, keep: bool = False) -> tuple[list[float], int]:
        """Return n(0), m(0) and the number of nodes; `tolerance` is solve_bvp's own.

        The answer is the next guess where it is to be kept; RuntimeError where there is none.
        """
        answer = solve_bvp(
            *(self._rates, self._conditions, self.s, self._x),
            p=self._c if len(self._c) else None,
            fun_jac=self._slopes,
            bc_jac=self._slopes_of_conditions,
            tol=tolerance,
            max_nodes=200_000,
        )
        if not answer.success:
            raise RuntimeError(f"solve_bvp: {answer.message}")
        c = np.array([]) if answer.p is None else answer.p
        if keep:
            self.s, self._x, self._c = answer.x, answer.y, c
        loads: list[float] = np.append(answer.y[:, 0], c)[-6:].tolist()
        return loads, len(answer.x)

    def _rates(self, s: np.ndarray, x: np.ndarray, *c: np.ndarray) -> np.ndarray:
        return np.array(self._f["rates"](*self._all(x, c)))[: len(x)]

    def _slopes(self, s: np.ndarray, x: np.ndarray, *c: np.ndarray) -> np.ndarray | tuple:
        moving, states = len(x), self.ribbon.states
        slopes = np.array(self._f["rates_x"](*self._all(x, c))).reshape(states, -1, states)
        slopes = slopes[:moving].transpose(0, 2, 1)
        return (slopes[:, :moving], slopes[:, moving:]) if c else slopes

    def _all(self, x: np.ndarray, c: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray]:
        """All states and epsilon, a column for each place."""
        constants = np.repeat(np.reshape(c, (-1, 1)), x.shape[1], axis=1)
        return np.concatenate([x, constants]), np.full((1, x.shape[1]), self.epsilon)

    def _conditions(self, a: np.ndarray, b: np.ndarray, *c: np.ndarray) -> np.ndarray:
        ends = zip(("start", "end"), (a, b), strict=True)
        return np.concatenate([np.array(self._f[e](np.append(x, c))).ravel() for e, x in ends])

    def _slopes_of_conditions(self, a: np.ndarray, b: np.ndarray, *c: np.ndarray) -> tuple:
        start, end = (
            np.array(self._f["start_x"](np.append(a, c))),
            np.array(self._f["end_x"](np.append(b, c))),
        )
        moving, none = len(a), np.zeros
        found = [
            np.vstack([start[:, :moving], none((len(end), moving))]),
            np.vstack([none((len(start), moving)), end[:, :moving]]),
        ]
        return (*found, np.vstack([start, end])[:, moving:]) if c else tuple(found)
