"""The inverted formulation in phases that end where the law switches, or where it stays at that.

In a phase of kind +1 or -1 the law is that of one side of its switch (for Sadowsky: of one sheet),
continued beyond it: analytic, so that every scheme keeps its order. A phase of kind 0 is a mixture
of both sides. The lengths of the phases are unknown; the law says what holds where one begins.
"""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from ribbonopt.mechanics.outputs import outputs

from .contract import BoundaryValueProblem, Phase
from .equilibrium import Unknowns
from .ribbon import Ribbon

Kinds = tuple[int, ...]


def switched(ribbon: Ribbon, kinds: Kinds) -> BoundaryValueProblem:
    """Return the problem of a ribbon whose phases have these kinds: +1, -1, or 0 (mixture)."""
    unknowns = Unknowns.of(ribbon)
    start, end = ribbon.interval
    lengths = ca.SX.sym("length", len(kinds) - 1)
    each = [*ca.vertsplit(lengths), end - start - ca.sum1(lengths)]
    phases = tuple(
        _phase(ribbon, unknowns, kind, length) for kind, length in zip(kinds, each, strict=True)
    )
    points = tuple(ca.SX.sym(f"point{i}", unknowns.x.numel()) for i in range(len(kinds) + 1))
    conditions = ribbon.residuals(points[0], points[-1], unknowns.c)
    at = start
    for i in range(1, len(kinds)):
        at = at + each[i - 1]
        here = [unknowns.x, ribbon.position], [points[i], at]
        for name, value in ribbon.law.entering(kinds, i, unknowns.stress).items():
            (conditions[f"switch {i}: {name}"],) = ca.substitute([value], *here)
    return BoundaryValueProblem(
        position=ribbon.position,
        state=unknowns.x,
        algebraic=ca.SX(0, 1),
        constants=ca.vertcat(unknowns.c, lengths),
        parameters=ribbon.parameters,
        start=start,
        phases=phases,
        points=points,
        conditions=conditions,
        state_names=ribbon.states,
        constant_names=(
            *ribbon.constants,
            *(f"length of phase {i + 1}" for i in range(len(kinds) - 1)),
        ),
        parameter_names=tuple(ribbon.theta),
    )


def _phase(ribbon: Ribbon, unknowns: Unknowns, kind: int, length: ca.SX) -> Phase:
    u = ribbon.law.branch(kind).strain(unknowns.stress)
    section = replace(unknowns.section, u=u)
    return Phase(
        dynamics=ribbon.rates(section, u), length=length, outputs=outputs(section, ribbon.law, u)
    )
