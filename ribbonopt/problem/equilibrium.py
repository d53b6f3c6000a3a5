"""What the formulations that write equilibrium (not the energy) share."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import casadi as ca

from ribbonopt.classes import dataclass
from ribbonopt.mechanics.ends.conditions import CrossSection
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.mechanics.outputs import outputs, singular

from .contract import BoundaryValueProblem, Phase
from .imposed import residuals
from .pieces import between_stations
from .ribbon import Ribbon


@dataclass(frozen=True, eq=False)
class Unknowns:
    """States x of rod and law, constants c, their cross section, and what a law may read of it.

    With stations between the ends all are written with the symbols of `marked`.
    """

    marked: Ribbon
    x: ca.SX
    c: ca.SX
    section: CrossSection
    stress: Stress

    @classmethod
    def of(cls, ribbon: Ribbon) -> Unknowns:
        """Return fresh symbols for a ribbon."""
        x = ca.SX.sym("x", len(ribbon.states))
        c = ca.SX.sym("c", len(ribbon.constants))
        marked = ribbon.marked
        section = marked.section(x, c)
        return cls(marked, x, c, section, section.rod.stress)

    def rates(self, u: ca.SX) -> ca.SX:
        """Return dx/ds of the states of model and law for strains u (3,)."""
        return self.marked.rates(self.section, u)


def local_stress(law: ConstitutiveLaw) -> tuple[ca.SX, Stress]:
    """Return symbols of what any guess knows at a point: n and m (6,) along the directors.

    The law's own states are where it starts them.
    """
    local = ca.SX.sym("local", 6)
    known = Stress(local[:3], local[3:], ca.SX(0, 1))
    return local, known._replace(own=law.own_guess(known))


def equilibrium(
    ribbon: Ribbon,
    unknowns: Unknowns,
    u: ca.SX,
    *,
    more_states: Mapping[str, ca.SX] | None = None,
    more_rates: ca.SX | None = None,
    algebraic: ca.SX | None = None,
    equations: ca.SX | None = None,
    path: ca.SX | None = None,
    algebraic_start: ca.SX | None = None,
    estimate: Callable[[Stress], ca.SX] | None = None,
    start_conditions: Mapping[str, ca.SX] | None = None,
) -> BoundaryValueProblem:
    """Return the square problem with these strains, of one phase, or one between stations each.

    Parameters
    ----------
    ribbon, unknowns
        The mechanics and its symbols.
    u
        Strains (3,) as expressions.
    more_states, more_rates
        Symbols by name of further states, after those of rod and law, and their derivatives.
    algebraic
        Symbols of algebraic variables.
    equations, path
        Algebraic equations (zero) and inequalities (not positive) along the ribbon.
    algebraic_start
        The algebraic variables as an explicit expression of `unknowns`.
    estimate
        Further states and algebraic variables as expressions of a stress, where any guess starts.
    start_conditions
        Further conditions, in terms of `unknowns` and `more_states`, to hold at the start.
    """
    empty = ca.SX(0, 1)
    more = more_states or {}
    x = ca.vertcat(unknowns.x, *more.values())
    slopes = empty if more_rates is None else more_rates
    rates = ca.vertcat(unknowns.rates(u), slopes)
    start, end = ribbon.interval
    phase = Phase(
        dynamics=rates,
        length=end - start,
        outputs=outputs(unknowns.section, ribbon.law, u, ribbon.work(unknowns.section.rod)),
        algebraic=empty if equations is None else equations,
        path=empty if path is None else path,
        singular=singular(ribbon.law, unknowns.stress),
    )
    phases = between_stations(phase, unknowns.marked)
    inner = [ca.SX.sym(f"point{i}", x.numel()) for i in range(1, len(phases))]
    points = ca.SX.sym("start", x.numel()), *inner, ca.SX.sym("end", x.numel())
    count = unknowns.x.numel()
    first, *between, last = (point[:count] for point in points)
    conditions = residuals(ribbon, first, last, unknowns.c, between)
    for name, expression in (start_conditions or {}).items():
        passed = unknowns.marked.passed
        here = [x, ribbon.position, passed], [points[0], start, ca.SX.zeros(passed.shape)]
        (conditions[name],) = ca.substitute([expression], *here)
    local, stress = local_stress(ribbon.law)
    estimated = ca.vertcat(stress.own, empty if estimate is None else estimate(stress))
    return BoundaryValueProblem(
        position=ribbon.position,
        state=x,
        algebraic=empty if algebraic is None else algebraic,
        constants=unknowns.c,
        parameters=ribbon.parameters,
        start=start,
        phases=phases,
        points=points,
        conditions=conditions,
        state_names=(*ribbon.states, *more),
        constant_names=ribbon.constants,
        parameter_names=tuple(ribbon.theta),
        local=local,
        estimate=estimated,
        algebraic_start=empty if algebraic_start is None else algebraic_start,
        conserved=ribbon.conserved,
        neutral=ribbon.law.spins,
        stations=tuple(range(1, len(phases))),
    )
