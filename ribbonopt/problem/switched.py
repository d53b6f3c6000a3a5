"""The inverted formulation in phases that end where m2 changes sign, or where it stays zero.

In a phase of kind +1 or -1 the law is that of one sheet, continued beyond m2 = 0: analytic, so that
every scheme keeps its order. A phase of kind 0 is a mixture of both sheets (epsilon = 0): m2 = 0,
u3 = m3 / 4, u2 = 2 n2 u3 / K with K = n3 + m3 u3 - m1^2 / 4. The lengths of the phases are unknown;
m2 = 0 where one begins, and n1 + m1 u3 = 0 too where a mixture begins.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from ribbonopt.mechanics.outputs import outputs

from .contract import BoundaryValueProblem, Phase
from .equilibrium import Unknowns
from .ribbon import Ribbon

Kinds = tuple[int, ...]


def switched(ribbon: Ribbon, kinds: Kinds) -> BoundaryValueProblem:
    """Return the problem of a ribbon whose phases have these kinds: +1, -1, or 0 (mixture)."""
    unknowns, theta = Unknowns.of(ribbon), ribbon.theta
    lengths = ca.SX.sym("length", len(kinds) - 1)
    total = theta["interval.end"] - theta["interval.start"]
    constants = ca.vertcat(unknowns.c, lengths)
    each = [*ca.vertsplit(lengths), total - ca.sum1(lengths)]
    phases = tuple(
        _phase(ribbon, unknowns, kind, length) for kind, length in zip(kinds, each, strict=True)
    )
    points = tuple(ca.SX.sym(f"point{i}", unknowns.x.numel()) for i in range(len(kinds) + 1))
    conditions = ribbon.residuals(points[0], points[-1], unknowns.c)
    for i, kind in enumerate(kinds[1:], start=1):
        for name, expression in _entering(unknowns, kind, kinds[i - 1]).items():
            at = ca.substitute(expression, unknowns.x, points[i])
            conditions[f"switch {i}: {name}"] = at
    return BoundaryValueProblem(
        position=ca.SX.sym("s"),
        state=unknowns.x,
        algebraic=ca.SX(0, 1),
        constants=constants,
        parameters=ca.vertcat(*theta.values()),
        start=theta["interval.start"],
        phases=phases,
        points=points,
        conditions=conditions,
        state_names=ribbon.model.states,
        constant_names=(
            *ribbon.model.constants,
            *(f"length of phase {i + 1}" for i in range(len(kinds) - 1)),
        ),
        parameter_names=tuple(theta),
    )


def _phase(ribbon: Ribbon, unknowns: Unknowns, kind: int, length: ca.SX) -> Phase:
    m2, m3 = unknowns.m2, unknowns.m3
    if kind:
        u2, u3 = ribbon.law.sheet_strain(m2, m3, kind)
    else:
        u3 = m3 / 4
        u2 = 2 * _loads(unknowns)["n2"] * u3 / stiffness(unknowns)
    section = replace(unknowns.section, u2=u2, u3=u3)
    return Phase(
        dynamics=ribbon.model.rates(unknowns.x, section.rod, ca.vertcat(0, u2, u3)),
        length=length,
        outputs=outputs(section, ribbon.law, u2, u3),
    )


def stiffness(unknowns: Unknowns) -> ca.SX:
    """K = n3 + m3 u3 - m1^2 / 4 of a mixture, which must not be negative."""
    loads = _loads(unknowns)
    return loads["n3"] + loads["m3"] ** 2 / 4 - loads["m1"] ** 2 / 4


def _entering(unknowns: Unknowns, kind: int, before: int) -> Mapping[str, ca.SX]:
    """Conditions, by name, where a phase begins."""
    loads = _loads(unknowns)
    if kind == 0:
        drift = loads["n1"] + loads["m1"] * loads["m3"] / 4
        return {"m2 = 0": loads["m2"], "n1 + m1 u3 = 0": drift}
    # A mixture has m2 = 0 wherever it ends.
    return {} if before == 0 else {"m2 = 0": loads["m2"]}


def _loads(unknowns: Unknowns) -> dict[str, ca.SX]:
    rod = unknowns.section.rod
    n, m = rod.along(rod.n), rod.along(rod.m)
    return {f"n{i + 1}": n[i] for i in range(3)} | {f"m{i + 1}": m[i] for i in range(3)}
