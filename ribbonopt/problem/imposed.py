"""What is imposed on a ribbon: conditions at its ends and at single places, as expressions by name.

Verdicts are what to look at on a solution; margins what must not be negative along its phases.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import casadi as ca

from ribbonopt.mechanics.ends.conditions import Context, CrossSection, EndName
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.mechanics.section import Section

from .ribbon import Ribbon

Named = dict[str, ca.SX]
Verdicts = tuple[tuple[str, ...], ca.Function]


def residuals(
    ribbon: Ribbon,
    start: ca.SX,
    end: ca.SX,
    c: ca.SX,
    inner: Sequence[ca.SX] = (),
    *,
    kinematic_only: bool = False,
) -> Named:
    """Return all conditions by name, those that give states their meaning included.

    Parameters
    ----------
    ribbon
        Mechanics.
    start, end, c
        States at the ends, and constants.
    inner
        States at the stations, if what acts and holds there is to be imposed.
    kinematic_only
        Leave out what is prescribed of loads.
    """
    at_ends = context(ribbon, start, end, c)
    own = ribbon.model.start_conditions(at_ends.ends["start"].x)
    meaning = {f"start: {name}": value for name, value in own.items()}
    laws = [_of_law(ribbon, name, section) for name, section in at_ends.ends.items()]
    chosen = [cond for cond in ribbon.conditions if cond.kinematic or not kinematic_only]
    conditions = (condition.residuals(at_ends) for condition in chosen)
    found = _merge(meaning, *laws, *_at_stations(ribbon, inner, c), *conditions)
    return {name: value for name, value in found.items() if name not in ribbon.idle}


def verdicts(
    ribbon: Ribbon, start: ca.SX, end: ca.SX, c: ca.SX, inner: Sequence[ca.SX] = ()
) -> Named:
    """Return what to verify on a solution, by name; arguments as in `residuals`."""
    at_ends = context(ribbon, start, end, c)
    conditions = (condition.verdicts(at_ends) for condition in ribbon.conditions)
    return _merge(*conditions, *_at_stations(ribbon, inner, c))


def verdicts_function(ribbon: Ribbon) -> Verdicts:
    """Names, and function (start, end, c, theta, states at stations) of what to verify."""
    start, end = (ca.SX.sym(name, len(ribbon.states)) for name in ("start", "end"))
    inner = ca.SX.sym("inner", len(ribbon.states), len(ribbon.stations))
    c = ca.SX.sym("c", len(ribbon.constants))
    found = verdicts(ribbon, start, end, c, ca.horzsplit(inner) if ribbon.stations else ())
    inputs = [start, end, c, ribbon.parameters]
    inputs += [ca.vec(inner)] if ribbon.stations else []
    return tuple(found), ca.Function("verdicts", inputs, [ca.vertcat(*found.values())])


def margins_function(ribbon: Ribbon, kind: int) -> tuple[tuple[str, ...], int, ca.Function]:
    """Names, how many are margins, and function (x, c, theta, s) along a phase of a kind.

    Its values (k,) are the margins of the law, then minus the sizes of what must be zero.
    """
    x, c = ca.SX.sym("x", len(ribbon.states)), ca.SX.sym("c", len(ribbon.constants))
    stress = loaded_stress(ribbon, ribbon.section(x, c).rod)
    margins = ribbon.law.margins(kind, stress, ribbon.law.branch(kind).strain(stress))
    zeros = ribbon.law.zeros(kind, stress)
    values = *margins.values(), *(-ca.fabs(value) for value in zeros.values())
    inputs = [x, c, ribbon.parameters, ribbon.position]
    function = ca.Function("margins", inputs, [ca.densify(ca.vertcat(*values))])
    return (*margins, *zeros), len(margins), function


def loaded_stress(ribbon: Ribbon, rod: Section) -> Stress:
    """Return what a law may read of a section, loads too, which move what mixtures keep."""
    if not ribbon.loads:
        return rod.stress
    theta = ribbon.theta.__getitem__
    force = sum((load.force(rod, theta) for load in ribbon.loads), ca.SX.zeros(3))
    couple = sum((load.couple(rod, theta) for load in ribbon.loads), ca.SX.zeros(3))
    # c2 changes as the couple does, beside what the director's turning changes.
    varying = ca.dot(ca.jacobian(couple, ribbon.position), rod.d2)
    load = rod.along(force) - ca.vertcat(varying / rod.stretched, 0, 0)
    return rod.stress._replace(load=load, couple=rod.along(couple))


def context(ribbon: Ribbon, start: ca.SX, end: ca.SX, c: ca.SX) -> Context:
    """Both ends, for conditions."""
    names: tuple[EndName, EndName] = ("start", "end")
    states = zip(names, (start, end), ribbon.interval, strict=True)
    sections = {name: ribbon.section(x, c, s) for name, x, s in states}
    return Context(sections, ribbon.theta.__getitem__)


def _of_law(ribbon: Ribbon, end: EndName, section: CrossSection) -> Named:
    """Return the law's own conditions at an end, by name."""
    rod = section.rod
    found = ribbon.law.end_conditions(end, rod.stress).items()
    return {f"{end}: {name}": ca.substitute(v, ribbon.position, rod.s) for name, v in found}


def _at_stations(ribbon: Ribbon, inner: Sequence[ca.SX], c: ca.SX) -> list[Named]:
    """Return the conditions at the stations, whose states are given."""
    theta, found = ribbon.theta.__getitem__, []
    unknown = dict(zip(ribbon.constants, ca.vertsplit(c), strict=True)) if inner else {}

    def symbol(name: str) -> ca.SX:
        return unknown.get(name, ca.SX(0))  # in a plane some of it is not there

    for x, station in zip(inner, ribbon.stations if inner else (), strict=True):
        rod = ribbon.section(x, c, station.place(theta)).rod
        found += [action.residuals(rod, theta, symbol) for action in station.actions]
    return found


def _merge(*parts: Mapping[str, ca.SX]) -> Named:
    """Join named expressions; a name that returns is numbered, so that none is lost."""
    result: Named = {}
    for part in parts:
        for name, value in part.items():
            key, count = name, 2
            while key in result:
                key, count = f"{name} ({count})", count + 1
            result[key] = value
    return result
