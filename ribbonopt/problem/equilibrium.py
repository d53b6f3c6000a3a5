"""What the formulations that write equilibrium (not the energy) share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from ribbonopt.mechanics.ends.conditions import CrossSection
from ribbonopt.mechanics.outputs import outputs

from .contract import BoundaryValueProblem, Phase
from .ribbon import Ribbon

Pair = tuple[ca.SX, ca.SX]


@dataclass(frozen=True, eq=False)
class Unknowns:
    """States x and constants c of a rod, its cross section, and the moments along d2 and d3."""

    x: ca.SX
    c: ca.SX
    section: CrossSection
    m2: ca.SX
    m3: ca.SX

    @classmethod
    def of(cls, ribbon: Ribbon) -> Unknowns:
        """Return fresh symbols for a ribbon."""
        x = ca.SX.sym("x", len(ribbon.model.states))
        c = ca.SX.sym("c", len(ribbon.model.constants))
        section = ribbon.section(x, c)
        m = section.rod.along(section.rod.m)
        return cls(x, c, section, m[1], m[2])


def equilibrium(
    ribbon: Ribbon,
    unknowns: Unknowns,
    strains: Pair,
    rates: ca.SX,
    *,
    more_states: ca.SX | None = None,
    algebraic: ca.SX | None = None,
    equations: ca.SX | None = None,
    path: ca.SX | None = None,
    algebraic_start: ca.SX | None = None,
    estimate: tuple[ca.SX, ca.SX] | None = None,
    start_conditions: Mapping[str, ca.SX] | None = None,
) -> BoundaryValueProblem:
    """Return the square problem of one phase with these strains and rates.

    Parameters
    ----------
    ribbon, unknowns
        The mechanics and its symbols.
    strains
        Expressions u2, u3.
    rates
        Derivatives of the rod's states and of `more_states` along s.
    more_states, algebraic
        Symbols of further states, after those of the rod, and of algebraic variables.
    equations, path
        Algebraic equations (zero) and inequalities (not positive) along the ribbon.
    algebraic_start
        The algebraic variables as an explicit expression of `unknowns`.
    estimate
        Symbols (m2, m3), and further states and algebraic variables as expressions of them.
    start_conditions
        Further conditions, in terms of `unknowns` and `more_states`, to hold at the start.
    """
    theta, empty = ribbon.theta, ca.SX(0, 1)
    more = empty if more_states is None else more_states
    z = empty if algebraic is None else algebraic
    x = ca.vertcat(unknowns.x, more)
    section = unknowns.section
    phase = Phase(
        dynamics=rates,
        length=theta["interval.end"] - theta["interval.start"],
        outputs=outputs(section, ribbon.law, *strains),
        algebraic=empty if equations is None else equations,
        path=empty if path is None else path,
    )
    points = ca.SX.sym("start", x.numel()), ca.SX.sym("end", x.numel())
    count = unknowns.x.numel()
    conditions = ribbon.residuals(points[0][:count], points[1][:count], unknowns.c)
    for name, expression in (start_conditions or {}).items():
        conditions[name] = ca.substitute(expression, x, points[0])
    local, estimated = (empty, empty) if estimate is None else estimate
    more_names = tuple(f"u{i + 2}" for i in range(more.numel()))
    return BoundaryValueProblem(
        position=ca.SX.sym("s"),
        state=x,
        algebraic=z,
        constants=unknowns.c,
        parameters=ca.vertcat(*theta.values()),
        start=theta["interval.start"],
        phases=(phase,),
        points=points,
        conditions=conditions,
        state_names=(*ribbon.model.states, *more_names),
        constant_names=ribbon.model.constants,
        parameter_names=tuple(theta),
        local=local,
        estimate=estimated,
        algebraic_start=empty if algebraic_start is None else algebraic_start,
    )
