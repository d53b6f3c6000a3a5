"""Where a linear rod in the place of a ribbon buckles: where to start looking for its own loads.

The rod has the stiffnesses that the law has in bending and in twist alone. Its deflection is a
linear problem: solutions from the start, brought along the ribbon by Runge and Kutta, meet the
conditions where a determinant vanishes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.problem import Ribbon

from .infinitesimal import Deflected

STEPS = 40  # of the rod's length
SCAN = 120  # loads at which the determinant is looked at
BISECTIONS = 24
DEPENDENT = 1e-11  # singular value, over the largest, of conditions that hold at any load


def pure_stiffnesses(ribbon: Ribbon, theta: Array) -> Array:
    """Moment over strain (3,) where only one moment acts, at numbers theta; 1 where it has none."""
    result, law, inputs = np.ones(3), ribbon.law, [ribbon.parameters, ribbon.position]
    for i in law.components:
        strain = law.strain(Stress.of_moment(ca.SX(np.eye(3)[i])))[i]
        value = float(ca.Function("u", inputs, [strain])(theta, 0.5))
        if np.isfinite(value) and value > 0:
            result[i] = 1 / value
    return result


@dataclass(frozen=True, eq=False)
class RodBuckling:
    """The rod in the place of a ribbon, between the loads a and b.

    Attributes
    ----------
    deflected : Deflected
        The ribbon, whose own law is not asked.
    stiffnesses : (3,) array
        Of the rod, along the directors.
    a, b : (nx + nc + nt,) arrays
        Start, constants and parameters of the straight state at either load.
    """

    deflected: Deflected
    stiffnesses: Array
    a: Array
    b: Array

    def loads(self) -> Iterator[tuple[float, Array]]:
        """Yield loads p from 0 to 1 with the mode [xi; gamma] (nx + nc,) at the start."""
        grid = np.linspace(0.0, 1.0, SCAN + 1)
        matrices = self.matrices(grid)
        sizes = np.linalg.svd(matrices, compute_uv=False)
        if (sizes[:, -1] <= DEPENDENT * sizes[:, 0]).all():
            return
        signs = np.linalg.slogdet(matrices)[0]
        for i in np.flatnonzero(signs[1:] * signs[:-1] < 0):
            low, high = grid[i], grid[i + 1]
            for _ in range(BISECTIONS):
                middle = (low + high) / 2
                same = np.linalg.slogdet(self.matrices(np.array([middle])))[0][0] == signs[i]
                low, high = (middle, high) if same else (low, middle)
            load = (low + high) / 2
            *_, right = np.linalg.svd(self.matrices(np.array([load]))[0])
            yield load, right[-1]

    def matrices(self, loads: Array) -> Array:
        """Matrices (k, n, n) that the mode at the start must not change to zero, n = nx + nc."""
        values = np.array([self._matrix(load, self.a, self.b).full() for load in loads])
        largest = np.abs(values).max(axis=2, keepdims=True)
        return np.asarray(values / np.where(largest > 0, largest, 1.0))

    def along(self, load: float, mode: Array) -> Array:
        """States [x; xi] (STEPS + 1, 2 nx) at evenly spaced places."""
        nx, _, _ = self.deflected.sizes
        x, Y = (np.array(part) for part in self._states(load, self.a, self.b))
        Y = Y.T.reshape(STEPS + 1, -1, nx).swapaxes(1, 2)
        return np.hstack([x.T, Y @ mode])

    @cached_property
    def _symbolic(self) -> tuple[ca.SX, ca.SX, ca.SX]:
        """[x; xi]' of the rod, and its Jacobians by xi and gamma."""

        def strain(stress: Stress) -> ca.SX:
            free = self.deflected.ribbon.law.components
            found: ca.SX = ca.vertcat(
                *(stress.m[i] / self.stiffnesses[i] if i in free else 0 for i in range(3))
            )
            return found

        nx, _, _ = self.deflected.sizes
        rates, parts = self.deflected.dynamics(strain), self.deflected.parts
        change = rates[nx:]
        return rates, ca.jacobian(change, parts["xi"]), ca.jacobian(change, parts["gamma"])

    @cached_property
    def _states(self) -> ca.Function:
        """Function (load, a, b) of x (nx, STEPS + 1) and of all solutions, column by column."""
        deflected, parts = self.deflected, self.deflected.parts
        nx, nc, _ = deflected.sizes
        rates, by_xi, by_gamma = self._symbolic
        numbers = [parts["load"], parts["a"], parts["b"]]
        s = deflected.ribbon.position
        Y = ca.SX.sym("Y", nx, nx + nc)
        slope = ca.mtimes(by_xi, Y) + ca.horzcat(ca.SX.zeros(nx, nx), by_gamma)
        still = [parts["xi"], parts["gamma"]]
        both = ca.vertcat(rates[:nx], ca.vec(ca.densify(slope)))
        both = ca.substitute([both], still, [ca.SX.zeros(nx), ca.SX.zeros(nc)])[0]
        state = ca.vertcat(parts["x"], ca.vec(Y))
        f = ca.Function("f", [state, s, *numbers], [both])
        start, end = deflected.interval
        h = (end - start) / STEPS
        k1 = f(state, s, *numbers)
        k2 = f(state + h / 2 * k1, s + h / 2, *numbers)
        k3 = f(state + h / 2 * k2, s + h / 2, *numbers)
        k4 = f(state + h * k3, s + h, *numbers)
        following = ca.vertcat(state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), s + h)
        step = ca.Function("step", [ca.vertcat(state, s), *numbers], [following])
        given = [ca.MX.sym(part.name(), part.numel()) for part in numbers[:1]]
        given += [ca.MX.sym(name, parts[name].numel()) for name in ("a", "b")]
        x0, _, _ = deflected.base
        begin = ca.Function("begin", numbers, [ca.vertcat(x0, start)])(*given)
        first = ca.vertcat(begin[:nx], ca.vec(ca.DM(np.eye(nx, nx + nc))), begin[nx])
        repeated = [ca.repmat(part, 1, STEPS) for part in given]
        found = ca.horzcat(first, step.mapaccum(STEPS)(first, *repeated))
        return ca.Function("states", given, [found[:nx, :], found[nx:-1, :]])

    @cached_property
    def _matrix(self) -> ca.Function:
        """Function (load, a, b) of the matrix of the conditions on the mode at the start."""
        deflected, parts = self.deflected, self.deflected.parts
        nx, nc, _ = deflected.sizes
        numbers = [parts["load"], parts["a"], parts["b"]]
        ends = ca.SX.sym("start", 2 * nx), ca.SX.sym("end", 2 * nx)
        named = list(deflected.conditions(*ends).values())[nx:]
        column = ca.vertcat(*named)
        jacobians = [
            ca.jacobian(column, ends[0][nx:]),
            ca.jacobian(column, ends[1][nx:]),
            ca.jacobian(column, parts["gamma"]),
        ]
        inputs = [ends[0][:nx], ends[1][:nx], *numbers]
        linear = ca.Function("linear", inputs, [ca.densify(part) for part in jacobians])
        given = [ca.MX.sym("given", part.numel()) for part in numbers]
        x, Y = self._states(*given)
        at_start, at_end, by_gamma = linear(x[:, 0], x[:, -1], *given)
        last = ca.reshape(Y[:, -1], nx, nx + nc)
        matrix = ca.horzcat(at_start, by_gamma) + ca.mtimes(at_end, last)
        return ca.Function("matrix", given, [matrix])
