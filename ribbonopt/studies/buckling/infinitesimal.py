"""The equations of an infinitesimal deflection of a straight state with m2 = m3 = 0.

A law that is homogeneous of degree one has no derivative there, but stays what it is under a
deflection of any size. So of x' = f(x, c, u*(m)), with f affine in the strains u, all is linearised
but the law: for a deflection (xi, gamma) of states and constants

    xi' = df/dx xi + df/dc gamma + df/du u*(dm),    db/dx xi + db/dc gamma = 0,

dm being the linear part of the moments along the directors. With a load parameter p that is unknown
and one normalisation, row . (xi at the ends, gamma) = 1, that is a square problem, homogeneous and
not linear. The straight state itself, on which the coefficients depend, is carried along: its
states obey x' = f(x, c, 0) from the start, and start and constants are affine in the load,

    (x_0, c, theta) = (1 - p) (...)_a + p (...)_b,    p = 0 at the value a, 1 at b.

Unknowns: states [x, xi], constants [gamma, p, lengths of phases].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.problem import BoundaryValueProblem, Phase, Ribbon
from ribbonopt.problem.imposed import residuals

Strain = Callable[[Stress], ca.SX]
Kinds = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Deflected:
    """A straight ribbon and an infinitesimal deflection of it, as symbols.

    Attributes
    ----------
    ribbon : Ribbon
        Mechanics with the fewest unknowns; its law has no states of its own.
    """

    ribbon: Ribbon

    @cached_property
    def sizes(self) -> tuple[int, int, int]:
        """Numbers of states, constants and parameters of the ribbon."""
        ribbon = self.ribbon
        return len(ribbon.states), len(ribbon.constants), len(ribbon.theta)

    @cached_property
    def parts(self) -> dict[str, ca.SX]:
        """Symbols: x, xi, gamma, load, and what is affine in the load, [x_0; c; theta] at a, b."""
        nx, nc, nt = self.sizes
        names = {"x": nx, "xi": nx, "gamma": nc, "load": 1, "a": nx + nc + nt, "b": nx + nc + nt}
        return {name: ca.SX.sym(name, size) for name, size in names.items()}

    @cached_property
    def base(self) -> tuple[ca.SX, ca.SX, ca.SX]:
        """Start x_0, constants c and parameters theta of the straight state at the load."""
        nx, nc, _ = self.sizes
        a, b, load = (self.parts[name] for name in ("a", "b", "load"))
        found = a + load * (b - a)
        return found[:nx], found[nx : nx + nc], found[nx + nc :]

    @cached_property
    def stress(self) -> Stress:
        """What the law reads of a deflection: n of the straight state, m of the deflection."""
        x, c = self._symbols
        stress = self.ribbon.section(x, c).rod.stress
        free = self.ribbon.law.components
        change = self._linear(stress.m)
        m = ca.vertcat(*((change if i in free else stress.m)[i] for i in range(3)))
        n, m = self._at_base(stress.n), self._at_base(m)
        return Stress(n, m, ca.SX(0, 1))

    def dynamics(self, strain: Strain) -> ca.SX:
        """[x; xi]' with a law, given as its strains (3,) at a stress."""
        x, c = self._symbols
        section = self.ribbon.section(x, c)
        u = ca.SX.sym("u", 3)
        rates = self.ribbon.rates(section, u)
        straight = ca.substitute(rates, u, ca.SX.zeros(3))
        # The rates are affine in u.
        bent = ca.substitute(
            self._at_base(ca.jtimes(rates, u, u)), u, self._at_base(strain(self.stress))
        )
        return ca.vertcat(self._at_base(straight), self._at_base(self._linear(straight)) + bent)

    def conditions(self, start: ca.SX, end: ca.SX) -> dict[str, ca.SX]:
        """Conditions of the straight state, then those of the deflection, at both ends [x; xi]."""
        nx, _, _ = self.sizes
        x0, c, theta = self.base
        ends = ca.SX.sym("start", nx), ca.SX.sym("end", nx)
        constants = ca.SX.sym("c", c.numel())
        of, gamma = ca.vertcat(*ends, constants), self.parts["gamma"]
        change = ca.vertcat(start[nx:], end[nx:], gamma)
        here = ca.vertcat(start[:nx], end[:nx], c)
        found = {f"start of the straight state, {i + 1}": start[i] - x0[i] for i in range(nx)}
        for name, value in residuals(self.ribbon, *ends, constants).items():
            linear = ca.jtimes(value, of, change)
            known = [of, self.ribbon.parameters], [here, theta]
            (found[name],) = ca.substitute([linear], *known)
        return found

    @property
    def interval(self) -> tuple[ca.SX, ca.SX]:
        """Arclengths of both ends, at the load."""
        _, _, theta = self.base
        found = ca.substitute(list(self.ribbon.interval), [self.ribbon.parameters], [theta])
        return found[0], found[1]

    @cached_property
    def _symbols(self) -> tuple[ca.SX, ca.SX]:
        nx, nc, _ = self.sizes
        return ca.SX.sym("base", nx), ca.SX.sym("constants", nc)

    def _linear(self, expression: ca.SX) -> ca.SX:
        """Linear part of an expression of states and constants in the deflection."""
        change = ca.vertcat(self.parts["xi"], self.parts["gamma"])
        return ca.jtimes(expression, ca.vertcat(*self._symbols), change)

    def _at_base(self, expression: ca.SX) -> ca.SX:
        """Put the straight state in the place of states, constants and parameters."""
        _, c, theta = self.base
        of = [*self._symbols, self.ribbon.parameters]
        (found,) = ca.substitute([expression], of, [self.parts["x"], c, theta])
        return found


def infinitesimal(
    deflected: Deflected, numbers: ca.SX, strain: Strain, law: ConstitutiveLaw, kinds: Kinds = ()
) -> BoundaryValueProblem:
    """Return the square problem of a buckling load and its mode.

    Parameters
    ----------
    deflected
        The ribbon.
    numbers
        Further symbols (k,) that the strains contain; the last parameters.
    strain
        The law, as strains (3,) at a stress, where there are no phases.
    law
        The law whose sides hold in phases.
    kinds
        Kinds of the phases, +1 or -1, which meet where m2 vanishes; empty for one phase.
    """
    parts, (nx, nc, _) = deflected.parts, deflected.sizes
    lengths = ca.SX.sym("length", max(len(kinds) - 1, 0))
    row = ca.SX.sym("row", 2 * nx + nc)
    start, end = deflected.interval
    each = [*ca.vertsplit(lengths), end - start - ca.sum1(lengths)] if kinds else [end - start]
    sides: list[Strain] = [law.branch(kind).strain for kind in kinds]
    sides = sides or [strain]
    outputs = {"m": deflected.stress.m}
    phases = tuple(
        Phase(deflected.dynamics(side), length, outputs)
        for side, length in zip(sides, each, strict=True)
    )
    points = tuple(ca.SX.sym(f"point{i}", 2 * nx) for i in range(len(phases) + 1))
    conditions = deflected.conditions(points[0], points[-1])
    at, state = start, ca.vertcat(parts["x"], parts["xi"])
    for i, length in enumerate(each[:-1], start=1):
        at = at + length
        here = [state, deflected.ribbon.position], [points[i], at]
        (conditions[f"switch {i}: m2 = 0"],) = ca.substitute([deflected.stress.m[1]], *here)
    mode = ca.vertcat(points[0][nx:], points[-1][nx:], parts["gamma"])
    conditions["size of the deflection"] = ca.dot(row, mode) - 1
    parameters = {"a": parts["a"], "b": parts["b"], "row": row, "numbers": numbers}
    names = [f"{name} {i}" for name, part in parameters.items() for i in range(part.numel())]
    constants = ca.vertcat(parts["gamma"], parts["load"], lengths)
    return BoundaryValueProblem(
        position=deflected.ribbon.position,
        state=state,
        algebraic=ca.SX(0, 1),
        constants=constants,
        parameters=ca.vertcat(*parameters.values()),
        start=start,
        phases=phases,
        points=points,
        conditions=conditions,
        state_names=tuple(f"state {i}" for i in range(2 * nx)),
        constant_names=tuple(f"constant {i}" for i in range(int(constants.numel()))),
        parameter_names=tuple(names),
    )


def packed(a: Array, b: Array, row: Array, numbers: Array) -> Array:
    """Return the parameters theta of the problem."""
    return np.concatenate([a, b, row, numbers])
