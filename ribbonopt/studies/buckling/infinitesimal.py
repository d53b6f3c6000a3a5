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
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

import casadi as ca

from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.problem import Ribbon
from ribbonopt.problem.imposed import residuals

Strain = Callable[[Stress], ca.SX]


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
    def marked(self) -> Ribbon:
        """The ribbon with symbols for which stations are passed."""
        return self.ribbon.marked

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
        stress = self.marked.section(x, c).rod.stress
        free = self.ribbon.law.components
        change = self._linear(stress.m)
        m = ca.vertcat(*((change if i in free else stress.m)[i] for i in range(3)))
        n, m = self._at_base(stress.n), self._at_base(m)
        return Stress(n, m, ca.SX(0, 1))

    def dynamics(self, strain: Strain) -> ca.SX:
        """[x; xi]' with a law, given as its strains (3,) at a stress."""
        x, c = self._symbols
        section = self.marked.section(x, c)
        u = ca.SX.sym("u", 3)
        rates = self.marked.rates(section, u)
        # Bent in its own plane at most, which is no matter of its law.
        law, there = self.ribbon.law, ca.SX.zeros(3)
        if law.edgewise:
            alone = section.rod.stress._replace(m=ca.vertcat(section.rod.stress.m[0], 0, 0))
            there = self._at_base(ca.vertcat(law.strain(alone)[0], 0, 0))
        straight = ca.substitute(self._at_base(rates), u, there)
        change = ca.substitute(self._at_base(self._linear(rates)), u, there)
        # The rates are affine in u.
        bent = ca.substitute(
            self._at_base(ca.jtimes(rates, u, u)), u, self._at_base(strain(self.stress))
        )
        return ca.vertcat(straight, change + bent)

    def conditions(self, points: Sequence[ca.SX]) -> dict[str, ca.SX]:
        """Conditions of the straight state, then those of the deflection.

        `points` are [x; xi] at the start, at the stations and at the end.
        """
        nx, _, _ = self.sizes
        x0, c, theta = self.base
        at = [ca.SX.sym(f"at{i}", nx) for i in range(len(points))]
        constants = ca.SX.sym("c", c.numel())
        of, gamma = ca.vertcat(*at, constants), self.parts["gamma"]
        change = ca.vertcat(*(point[nx:] for point in points), gamma)
        here = ca.vertcat(*(point[:nx] for point in points), c)
        straight = [points[0][i] - x0[i] for i in range(nx)]
        found = {f"start of the straight state, {i + 1}": v for i, v in enumerate(straight)}
        imposed = residuals(self.ribbon, at[0], at[-1], constants, at[1:-1])
        for name, value in imposed.items():
            linear = ca.jtimes(value, of, change)
            known = [of, self.ribbon.parameters], [here, theta]
            (found[name],) = ca.substitute([linear], *known)
        return found

    @cached_property
    def places(self) -> tuple[ca.SX, ...]:
        """Arclengths of the start, the stations and the end, at the load."""
        ribbon, (_, _, theta) = self.ribbon, self.base
        start, end = ribbon.interval
        inner = (station.place(ribbon.theta.__getitem__) for station in ribbon.stations)
        return tuple(ca.substitute([start, *inner, end], [ribbon.parameters], [theta]))

    def before(self, value: ca.SX, count: int) -> ca.SX:
        """Return an expression behind so many stations."""
        total = len(self.ribbon.stations)
        marks = ca.SX(ca.DM([1.0] * count + [0.0] * (total - count)))
        return ca.substitute(value, self.marked.passed, marks) if total else value

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
