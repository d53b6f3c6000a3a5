"""Where a linear rod in the place of a ribbon buckles: where to start looking for its own loads.

The rod has the stiffnesses that the law has in bending and in twist alone. Its deflection is a
linear problem: solutions from the start, brought along the ribbon by Runge and Kutta, meet the
conditions where a determinant vanishes.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.problem import Ribbon

from .infinitesimal import Deflected

STEPS, FEWEST = 40, 4  # along the rod; between stations
SCAN = 120  # loads at which the determinant is looked at
BISECTIONS = 24
DEPENDENT = 1e-11  # singular value, over the largest, of conditions that hold at any load


def pure_compliances(ribbon: Ribbon, theta: Array) -> ca.SX:
    """Strains (3,) over moments where only one moment acts, along the ribbon; 0 where it has none.

    1 where the law, at numbers theta, says nothing of use.
    """
    law, result = ribbon.law, ca.SX.zeros(3)
    start, end = ribbon.interval
    for i in law.components:
        strain = law.strain(Stress.of_moment(ca.SX(np.eye(3)[i])))[i]
        middle = ca.substitute(strain, ribbon.position, (start + end) / 2)
        value = float(ca.Function("u", [ribbon.parameters], [middle])(theta))
        result[i] = strain if np.isfinite(value) and value > 0 else 1
    return result


@dataclass(frozen=True, eq=False)
class RodBuckling:
    """The rod in the place of a ribbon, between the loads a and b.

    Attributes
    ----------
    deflected : Deflected
        The ribbon, whose own law is not asked.
    compliances : SX (3,)
        Of the rod, along the directors: of the parameters and the position of the ribbon.
    a, b : (nx + nc + nt,) arrays
        Start, constants and parameters of the straight state at either load.
    """

    deflected: Deflected
    compliances: ca.SX
    a: Array
    b: Array

    @property
    def sound(self) -> bool:
        """Whether it is one all along at both loads: it is not where a width is not positive."""
        ribbon = self.deflected.ribbon
        found = ca.densify(self.compliances[list(ribbon.law.components)])
        function = ca.Function("compliances", [ribbon.parameters, ribbon.position], [found])
        for load, numbers in ((0.0, self.a), (1.0, self.b)):
            places = np.array(self._places(load, self.a, self.b)).ravel()
            theta = numbers[-len(ribbon.theta) :]
            values = [
                np.array(function(theta, s)) for s in np.linspace(places[0], places[-1], STEPS + 1)
            ]
            if not np.min(values) > 0:
                return False
        return True

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

    def along(self, load: float, mode: Array) -> tuple[Array, Array]:
        """Fractions (k,) of the length, where stations are twice, and states [x; xi] (k, 2 nx)."""
        nx, _, _ = self.deflected.sizes
        found = self._states(load, self.a, self.b)
        x, Y, s = (np.hstack([np.array(part) for part in found[i::3]]) for i in range(3))
        Y = Y.T.reshape(len(x.T), -1, nx).swapaxes(1, 2)
        s = s.ravel()
        return (s - s[0]) / (s[-1] - s[0]), np.hstack([x.T, Y @ mode])

    def strain(self, stress: Stress) -> ca.SX:
        """Strains (3,) of the rod."""
        return self.compliances * stress.m

    def ends(self, load: float) -> Array:
        """Fractions of the length at which the start, the stations and the end are."""
        s = np.array(self._places(load, self.a, self.b)).ravel()
        return np.asarray((s - s[0]) / (s[-1] - s[0]))

    @cached_property
    def _places(self) -> ca.Function:
        numbers = [self.deflected.parts[name] for name in ("load", "a", "b")]
        return ca.Function("places", numbers, [ca.vertcat(*self.deflected.places)])

    @cached_property
    def _symbolic(self) -> tuple[ca.SX, ca.SX, ca.SX]:
        """[x; xi]' of the rod, and its Jacobians by xi and gamma."""
        nx, _, _ = self.deflected.sizes
        rates, parts = self.deflected.dynamics(self.strain), self.deflected.parts
        change = rates[nx:]
        return rates, ca.jacobian(change, parts["xi"]), ca.jacobian(change, parts["gamma"])

    @cached_property
    def _states(self) -> ca.Function:
        """Function (load, a, b) of what is so between two stations, one triple after another.

        States x (nx, k), all solutions (nx (nx + nc), k), column by column, arclengths (1, k).
        """
        deflected, parts = self.deflected, self.deflected.parts
        nx, nc, _ = deflected.sizes
        rates, by_xi, by_gamma = self._symbolic
        numbers = [parts["load"], parts["a"], parts["b"]]
        given = [ca.MX.sym("given", part.numel()) for part in numbers]
        s, h = deflected.ribbon.position, ca.SX.sym("h")
        Y = ca.SX.sym("Y", nx, nx + nc)
        slope = ca.mtimes(by_xi, Y) + ca.horzcat(ca.SX.zeros(nx, nx), by_gamma)
        still = [parts["xi"], parts["gamma"]]
        both = ca.vertcat(rates[:nx], ca.vec(ca.densify(slope)))
        both = ca.substitute([both], still, [ca.SX.zeros(nx), ca.SX.zeros(nc)])[0]
        state = ca.vertcat(parts["x"], ca.vec(Y))
        x0, _, _ = deflected.base
        begin = ca.Function("begin", numbers, [x0, ca.vertcat(*deflected.places)])
        x, places = begin(*given)
        last = ca.vertcat(x, ca.vec(ca.DM(np.eye(nx, nx + nc))), places[0])
        result: list[ca.MX] = []
        for i, share in enumerate(np.diff(self.ends(0.0))):
            count = max(FEWEST, round(STEPS * share))
            f = ca.Function("f", [state, s, *numbers], [deflected.before(both, i)])
            k1 = f(state, s, *numbers)
            k2 = f(state + h / 2 * k1, s + h / 2, *numbers)
            k3 = f(state + h / 2 * k2, s + h / 2, *numbers)
            k4 = f(state + h * k3, s + h, *numbers)
            following = ca.vertcat(state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), s + h)
            step = ca.Function("step", [ca.vertcat(state, s), h, *numbers], [following])
            width = (places[i + 1] - places[i]) / count
            repeated = [ca.repmat(part, 1, count) for part in (width, *given)]
            found = ca.horzcat(last, step.mapaccum(count)(last, *repeated))
            last = found[:, -1]
            result += [found[:nx, :], found[nx:-1, :], found[-1, :]]
        return ca.Function("states", given, result)

    @cached_property
    def _matrix(self) -> ca.Function:
        """Function (load, a, b) of the matrix of the conditions on the mode at the start."""
        deflected, parts = self.deflected, self.deflected.parts
        nx, nc, _ = deflected.sizes
        numbers = [parts["load"], parts["a"], parts["b"]]
        points = [ca.SX.sym(f"point{i}", 2 * nx) for i in range(len(deflected.places))]
        column = ca.vertcat(*list(deflected.conditions(points).values())[nx:])
        jacobians = [ca.jacobian(column, part) for part in (*points, parts["gamma"])]
        jacobians = [part[:, nx:] for part in jacobians[:-1]] + jacobians[-1:]
        inputs = [*(point[:nx] for point in points), *numbers]
        linear = ca.Function("linear", inputs, [ca.densify(part) for part in jacobians])
        given = [ca.MX.sym("given", part.numel()) for part in numbers]
        states = self._states(*given)
        x, Y = states[::3], states[1::3]
        *at, by_gamma = linear(x[0][:, 0], *(part[:, -1] for part in x), *given)
        matrix = ca.horzcat(at[0], by_gamma)
        for jacobian, part in zip(at[1:], Y, strict=True):
            matrix += ca.mtimes(jacobian, ca.reshape(part[:, -1], nx, nx + nc))
        return ca.Function("matrix", given, [matrix])
