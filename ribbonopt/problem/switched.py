"""The inverted formulation in phases that end where the law switches, or where it stays at that.

In a phase of kind +1 or -1 the law is that of one side of its switch (for Sadowsky: of one sheet),
continued beyond it: analytic, so that every scheme keeps its order. A phase of kind 0 is a mixture
of both sides. The lengths of the phases are unknown; the law says what holds where one begins.
Where something acts or holds at a single place (a station) phases meet as well, of one kind.
"""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np

from ribbonopt.mechanics.outputs import outputs, singular

from .contract import BoundaryValueProblem, Phase
from .equilibrium import Unknowns, local_stress
from .imposed import loaded_stress, residuals
from .pieces import passing, stations_among
from .ribbon import Ribbon

Kinds = tuple[int, ...]


def switched(ribbon: Ribbon, kinds: Kinds, *, free: bool = False) -> BoundaryValueProblem:
    """Return the problem of a ribbon whose phases have these kinds: +1, -1, or 0 (mixture).

    A mixture from end to end fits the ends by design or by symmetry only: it has conditions to
    spare. `free`, they are left out, which leads there from afar; else they are met with slack.

    Raises
    ------
    ModelError
        If phases of one kind meet where no station is, or too few of them meet.
    """
    stations = stations_among(kinds, len(ribbon.stations))
    unknowns = Unknowns.of(ribbon)
    unknowns = replace(unknowns, stress=loaded_stress(ribbon, unknowns.section.rod))
    start, end = ribbon.interval
    lengths = ca.SX.sym("length", len(kinds) - 1)
    each = [*ca.vertsplit(lengths), end - start - ca.sum1(lengths)]
    phases = tuple(
        passing(
            _phase(ribbon, unknowns, kind, length), unknowns.marked, sum(j <= i for j in stations)
        )
        for i, (kind, length) in enumerate(zip(kinds, each, strict=True))
    )
    points = tuple(ca.SX.sym(f"point{i}", unknowns.x.numel()) for i in range(len(kinds) + 1))
    between = [points[i] for i in stations]
    conditions = residuals(ribbon, points[0], points[-1], unknowns.c, between)
    # A law knows nothing of stations: to it phases of one kind that meet there are one.
    merged = tuple(kind for i, kind in enumerate(kinds) if i not in stations or i in _turns(kinds))
    at, met = start, 0
    for i in range(1, len(kinds)):
        at = at + each[i - 1]
        met += i not in stations or i in _turns(kinds)
        if i in stations:
            place = ribbon.stations[stations.index(i)].place(ribbon.theta.__getitem__)
            conditions[f"station {i}: its place"] = at - place
            continue
        marks = ca.SX(ca.DM([float(j <= i) for j in stations]))
        here = [unknowns.x, ribbon.position, unknowns.marked.passed], [points[i], at, marks]
        for name, value in ribbon.law.entering(merged, met, unknowns.stress).items():
            (conditions[f"switch {i}: {name}"],) = ca.substitute([value], *here)
    slack = ca.SX(0, 1)
    if len(kinds) == 1 and not free:
        zeros = ribbon.law.zeros(kinds[0], unknowns.stress)
        here = [unknowns.x, ribbon.position], [points[0], start]
        found = ca.substitute(list(zeros.values()), *here)
        asked = {f"start: {name}": value for name, value in zip(zeros, found, strict=True)}
        if asked:
            conditions, slack = _with_slack(conditions | asked, len(asked))
    local, stress = local_stress(ribbon.law)
    return BoundaryValueProblem(
        position=ribbon.position,
        state=unknowns.x,
        algebraic=ca.SX(0, 1),
        constants=ca.vertcat(unknowns.c, lengths, slack),
        parameters=ribbon.parameters,
        start=start,
        phases=phases,
        points=points,
        conditions=conditions,
        state_names=ribbon.states,
        constant_names=(
            *ribbon.constants,
            *(f"length of phase {i + 1}" for i in range(len(kinds) - 1)),
            *(f"slack {i + 1}" for i in range(slack.numel())),
        ),
        parameter_names=tuple(ribbon.theta),
        local=local,
        estimate=stress.own,
        conserved=ribbon.conserved,
        slack=slack.numel(),
        stations=stations,
    )


def _turns(kinds: Kinds) -> list[int]:
    """Return the meeting points at which the kind of phase changes."""
    return [i for i in range(1, len(kinds)) if kinds[i] != kinds[i - 1]]


def _with_slack(conditions: dict[str, ca.SX], count: int) -> tuple[dict[str, ca.SX], ca.SX]:
    """Return conditions of which `count` are too many with as many unknowns, and these.

    All are relaxed in as many generic directions, so that they are square, and regular where all
    agree; verification tells whether each holds.
    """
    slack = ca.SX.sym("slack", count)
    directions = np.sin(1.0 + 7 * np.arange(len(conditions) * count)).reshape(-1, count)
    pairs = zip(conditions.items(), directions, strict=True)
    return {name: value + ca.dot(row, slack) for (name, value), row in pairs}, slack


def _phase(ribbon: Ribbon, unknowns: Unknowns, kind: int, length: ca.SX) -> Phase:
    law = ribbon.law.branch(kind)
    u = law.strain(unknowns.stress)
    section = replace(unknowns.section, u=u)
    return Phase(
        dynamics=unknowns.marked.rates(section, u),
        length=length,
        outputs=outputs(section, ribbon.law, u, ribbon.work(section.rod)),
        singular=singular(law, unknowns.stress),
    )
