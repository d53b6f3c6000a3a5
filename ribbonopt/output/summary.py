"""The summary of a solution: plain numbers under keys that stay (DESIGN: `summary.json`)."""

from __future__ import annotations

import platform
from contextlib import suppress
from dataclasses import fields
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.accuracy.carried import reaction_errors
from ribbonopt.accuracy.compared import alone
from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.checks.phase_words import switch_of
from ribbonopt.checks.topology import count_half_twists
from ribbonopt.checks.validity import warnings_of
from ribbonopt.checks.zero_moment import lacks_linearisation
from ribbonopt.kernel import STATE
from ribbonopt.plain import finite
from ribbonopt.problem import formulation_name
from ribbonopt.scene import Scene
from ribbonopt.solution.acting import at_places, reactions, resultants
from ribbonopt.solution.potential import potential
from ribbonopt.solution.solution import Solution
from ribbonopt.version import VERSION

#: what the answer consists of, each with a bar
ANSWERS = ("n0", "m0", "u0", "H0", "energy", "potential", "states", "u")


def summarize(solution: Solution) -> dict[str, Any]:
    """Return the summary: lab-frame vectors at the start, in the units of the scene, seconds.

    Numbers that are not known are None.
    """
    scene, dense, checks = solution.scene, solution.dense, solution.verification
    start, settings = solution.start, settings_of(scene)
    summary = {
        "name": settings.pop("name"),
        "status": solution.status.name.lower(),
        "verified": solution.verified,
        "message": solution.message,
        **settings,
        "loads_from": "costates" if solution.problem.recovered else "unknowns",
        "n0": start["n"].tolist(),
        "m0": start["m"].tolist(),
        "u0": start["u"].tolist(),
        "H0": float(start["H"]),
        "energy": solution.energy,
        "potential": potential(solution),
        "conserved": _conserved(solution),
        "twist": solution.twist,
        "length": scene.interval[1] - scene.interval[0],
        "invariant_drift": dict(checks.drift),
        "worst_condition": checks.worst_condition,
        "residual_between_nodes": checks.residual_between_nodes,
        "law_residual": checks.law_residual,
        "error_estimate": bars_of(solution),
        **_recorded(solution),
        "loads": _loads(solution),
        "reactions": _reactions(solution),
        "switch_points": solution.switch_points.tolist(),
        "phases": list(solution.sheets),
        "switch": switch_of(scene),
        "half_twists": count_half_twists(solution),
        "symmetry": _symmetry(solution),
        "unknowns": dense.blocks.layout.unknowns,
        "intervals": dense.blocks.layout.element_count,
        "degree": dense.blocks.degree,
        "iterations": solution.iterations,
        "equilibria": [_equilibrium(found) for found in (solution, *solution.others)],
        "search": solution.sought.told if solution.sought else None,
        "path": [dict(step) for step in solution.steps],
        "given_up": list(solution.given_up),
        "fell_back": list(solution.fell_back),
        "skipped": list(solution.skipped),
        "timings": dict(solution.timings),
        "versions": versions(),
        "units": solution.units.name,
        "warnings": warnings_of(solution),
    }
    plain: dict[str, Any] = finite(summary)
    return plain


def settings_of(scene: Scene) -> dict[str, Any]:
    """Return what a summary says of the scene."""
    return {
        "name": scene.name,
        "formulation": formulation_name(scene),
        "states": scene.states,
        "transcription": scene.transcription.type,
        "scheme": scene.transcription.scheme,
        "solver": scene.solver.type,
        "law": {f.name: getattr(scene.law, f.name) for f in fields(scene.law)},
        "parameters": dict(scene.parameters),
        "interval": list(scene.interval),
    }


def _symmetry(solution: Solution) -> dict[str, Any] | None:
    """Return what is of all of the ribbon, of which one of `pieces` is solved; None if all is."""
    boundary, (start, end) = solution.scene.boundary, solution.scene.interval
    count = boundary.pieces
    if count == 1 or (boundary.loop is None and solution.posed.loaded):
        return None  # of loads along half a strip the other half need not have its share
    of = "strip" if boundary.loop is None else "loop"
    whole = {"length": count * (end - start), "energy": count * solution.energy}
    return {"of": of, "pieces": count, **whole}


def _equilibrium(solution: Solution) -> dict[str, Any]:
    """Return what tells one equilibrium of a scene from the others; `starts` led to it."""
    found: dict[str, Any] = {
        "energy": solution.energy,
        "potential": potential(solution),
        "n0": solution.n0.tolist(),
        "m0": solution.m0.tolist(),
        "starts": solution.times,
    }
    if solution.sought is None:
        return found
    from .sought import among_all  # few scenes ask for all of them

    return found | among_all(solution, solution.sought)


def _conserved(solution: Solution) -> dict[str, float]:
    """Return what loads leave constant, numbers only, at the start; nothing without loads."""
    posed = solution.posed
    if not posed.loads or posed.stations or not solution.status.converged:
        return {}
    from ribbonopt.checks.conserved import conserved  # few scenes have loads

    uniform = not np.isnan(solution.verification.invariant)
    units, found = solution.units, conserved(solution, uniform)
    return {
        name: float(one.values[0]) * units.length**one.length * units.force**one.force
        for name, one in found.items()
        if one.values.ndim == 1
    }


def _recorded(solution: Solution) -> dict[str, Any]:
    """Return what the scene records, and the bars of that; not known as in `bars_of`."""
    names = dict.fromkeys(solution.scene.record)
    if not names or not solution.status.converged:
        return {"recorded": names, "recorded_error": names}
    from ribbonopt.accuracy.recorded import recorded, recorded_errors  # few scenes record

    with np.errstate(all="ignore"):
        values = recorded(solution)
        try:
            unknown = alone(solution) or lacks_linearisation(solution)
            errors = names if unknown else recorded_errors(solution)
        except np.linalg.LinAlgError:
            errors = names
    return {"recorded": values, "recorded_error": errors}


def _loads(solution: Solution) -> list[dict[str, Any]]:
    """Return force and couple of each load in all: along the ribbon (`at` None), and at places."""
    along = [(name, None, *both) for name, both in resultants(solution).items()]
    points = [(p.path, p.at, p.force, p.moment) for p in at_places(solution) if not p.support]
    return [
        {"path": path, "at": at, "force": force.tolist(), "moment": moment.tolist()}
        for path, at, force, moment in (*along, *points)
    ]


def _reactions(solution: Solution) -> list[dict[str, Any]]:
    """Return what the supports and the ends carry; bars not known as in `bars_of`."""
    found = reactions(solution)
    errors: list[float | None] = [None] * len(found)
    if not _unknown(solution):
        with suppress(np.linalg.LinAlgError):
            errors = list(reaction_errors(solution))
    return [
        {"path": place.path, "at": place.at, "force": place.force.tolist(), "error": error}
        for place, error in zip(found, errors, strict=True)
    ]


def bars_of(solution: Solution) -> dict[str, float | None]:
    """Return bars of the answer by name, None without convergence or linearisation.

    And for minima on one mesh only.
    """
    if _unknown(solution):
        return dict.fromkeys(ANSWERS)
    try:
        return dict(estimate_error(solution))
    except np.linalg.LinAlgError:  # singular equations: the solution is not the only one near
        return dict.fromkeys(ANSWERS)


def _unknown(solution: Solution) -> bool:
    """Whether there can be no bars."""
    without = not solution.status.converged or lacks_linearisation(solution)
    return without or alone(solution)


def versions() -> dict[str, str]:
    """Versions of what the numbers depend on, and whether the compiled kernel is used."""
    return {
        "ribbonopt": VERSION,
        "casadi": ca.CasadiMeta.version(),
        "numpy": np.__version__,
        "python": platform.python_version(),
        "kernel": STATE,
    }
