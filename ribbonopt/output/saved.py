"""A saved result as plain numbers that fit each other: `summary.json` and `solution.npz`.

Whether they fit the scene, and are the numbers of one solution, `load_solution` finds out.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import OutputError, SceneError, TranscriptionError
from ribbonopt.reading import MEGA, Kind, read_json, read_text
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status
from ribbonopt.transcription import Mesh

from .archive import Row, arrays_of
from .records import checked

SUMMARY, NUMBERS = "summary.json", "solution.npz"
RESULT = Kind("a result of ribbonopt", most=100 * MEGA, remedy="solve the scene again")
SCENE = Kind("the scene of a result", most=10 * MEGA)

Known = float | None  # a number; None where it is not known
Vector = tuple[Known, Known, Known]
Count = Annotated[int, Bounds(ge=0)]
SAME = 1e-6  # relative difference of what is told and what is found on another machine
DRIFTS = ("n", "n_dot_m", "H", "orthonormality")


@dataclass(frozen=True)
class SavedSummary:
    """Keys of `summary.json`; older results have none of those that have a default."""

    status: str
    message: str
    iterations: Count
    worst_condition: Known
    residual_between_nodes: Known
    law_residual: Known
    invariant_drift: dict[str, Known]
    timings: dict[str, float]
    path: tuple[dict[str, str | float | None], ...]
    skipped: tuple[str, ...]
    given_up: tuple[str, ...] = ()
    fell_back: tuple[str, ...] = ()
    name: str | None = None
    verified: bool | None = None
    formulation: str | None = None
    states: str | None = None
    transcription: str | None = None
    scheme: str | None = None
    solver: str | None = None
    law: dict[str, str | float | tuple[float, ...] | None] | None = None
    parameters: dict[str, float] | None = None
    interval: tuple[float, float] | None = None
    loads_from: str | None = None
    n0: Vector | None = None
    m0: Vector | None = None
    u0: Vector | None = None
    H0: Known = None
    energy: Known = None
    potential: Known = None
    conserved: dict[str, Known] | None = None
    twist: Known = None
    length: Known = None
    error_estimate: dict[str, Known] | None = None
    recorded: dict[str, Known] | None = None
    recorded_error: dict[str, Known] | None = None
    switch_points: tuple[float, ...] | None = None
    phases: tuple[int, ...] | None = None
    half_twists: int | None = None
    unknowns: Count | None = None
    intervals: Count | None = None
    degree: Count | None = None
    equilibria: tuple[dict[str, float | Vector | None], ...] | None = None
    versions: dict[str, str] | None = None
    units: str | None = None
    warnings: tuple[str, ...] | None = None

    @property
    def ended(self) -> Status:
        """How the solve ended; KeyError for a word that no solve ends with."""
        return Status[self.status.upper()]


@dataclass(frozen=True, eq=False)
class SavedNumbers:
    """What a reload needs of `solution.npz`, in units Dw = L = 1.

    Attributes
    ----------
    w, widths, theta, multipliers : (k,) arrays
        Unknowns, widths of all elements, parameters and multipliers.
    sheets, elements : tuples of int
        Kinds of the phases, none for one, and numbers of elements of each.
    units : tuple of float, or None
        Length, force and stiffness in units of the scene; older results do not say.
    """

    w: Array
    widths: Array
    theta: Array
    multipliers: Array
    sheets: tuple[int, ...]
    elements: tuple[int, ...]
    units: tuple[float, ...] | None


def read_scene(path: Path) -> Scene:
    """Return the scene that stands beside saved numbers; OutputError if it cannot be read."""
    text = read_text(path, SCENE)
    try:
        return loads_scene(text, str(path))
    except SceneError as error:
        raise OutputError(str(error)) from error


def read_summary(folder: Path) -> tuple[SavedSummary, dict[str, Any]]:
    """Return the summary of a result, checked, and as it stands there; OutputError if damaged."""
    path = folder / SUMMARY
    data = read_json(path, RESULT)
    summary = checked(SavedSummary, data, str(path), RESULT)
    fault = ""
    if summary.status not in (known := [status.name.lower() for status in Status]):
        fault = f"status: expected one of {', '.join(known)}"
    elif summary.verified not in (None, summary.ended is Status.CONVERGED):
        fault = "verified: contradicts the status"
    elif not set(DRIFTS) <= summary.invariant_drift.keys():
        fault = f"invariant_drift: expected keys {', '.join(DRIFTS)}"
    if fault:
        raise RESULT.damaged(path, fault)
    return summary, data


def read_numbers(folder: Path, summary: SavedSummary) -> SavedNumbers:
    """Return the numbers of a result that has this summary; OutputError if they do not fit."""
    rows = [Row(name) for name in ("w", "widths", "theta", "multipliers")]
    rows += [Row("sheets", whole=True), Row("elements", whole=True), Row("units", optional=True)]
    path = folder / NUMBERS
    try:
        found = arrays_of(path, rows)
        sheets, elements = (tuple(map(int, found[name])) for name in ("sheets", "elements"))
        refuse_mesh(sheets, elements, found["widths"], found["w"])
        for name in ("w", "theta", "multipliers") if summary.ended.converged else ("theta",):
            if not np.isfinite(found[name]).all():
                raise ValueError(f"{name}: holds numbers that are not finite")
        units = found.get("units")
        if units is not None and not (len(units) == 3 and _sizes(units)):
            raise ValueError("units: expected a length, a force and a stiffness")
        told: dict[str, Any] = {"unknowns": len(found["w"]), "intervals": len(found["widths"])}
        for name, value in (told | {"phases": sheets}).items():
            if getattr(summary, name) not in (None, value):
                raise ValueError(f"{SUMMARY} says other {name}")
    except ValueError as error:
        raise RESULT.damaged(path, str(error)) from None
    return SavedNumbers(
        found["w"],
        found["widths"],
        found["theta"],
        found["multipliers"],
        sheets,
        elements,
        None if units is None else tuple(map(float, units)),
    )


def refuse_mesh(
    sheets: tuple[int, ...], elements: tuple[int, ...], widths: Array, w: Array
) -> None:
    """Refuse phases and elements that do not fit each other, or the unknowns w (nw,).

    Raises
    ------
    ValueError
        Says what does not fit.
    """
    if not set(sheets) <= {-1, 0, 1}:
        raise ValueError("sheets: expected kinds of phases, each -1, 0 or 1")
    if (sheets and len(elements) != len(sheets)) or min(elements, default=0) < 1:
        raise ValueError("elements: expected a number of them for each phase")
    if sum(elements) != len(widths) or len(widths) > len(w):
        raise ValueError("widths: expected one for each element")
    try:
        Mesh(tuple(np.split(widths, np.cumsum(elements)[:-1])))
    except TranscriptionError as error:
        raise ValueError(f"widths: {error}") from None


def answers_of(solution: Solution) -> dict[str, tuple[Any, float]]:
    """Return what a solution is known by, each with its unit, see `refuse_other`."""
    units = solution.units
    return {
        "energy": (solution.energy, units.moment),
        "H0": (solution.start["H"], units.force),
        "n0": (solution.n0, units.force),
        "m0": (solution.m0, units.moment),
        "u0": (solution.u0, units.strain),
    }


def refuse_other(found: Mapping[str, tuple[Any, float]], told: Mapping[str, Any]) -> None:
    """Refuse numbers that are not those that were told of the same solution.

    Parameters
    ----------
    found
        Numbers or vectors by name, each with its unit, for what is near zero.
    told
        The same, as a file tells them; what it does not tell is not compared.

    Raises
    ------
    ValueError
        Names what differs.
    """
    for name, (value, unit) in found.items():
        if told.get(name) is None:
            continue
        here, there = (np.array(v, float).ravel() for v in (value, told[name]))
        with np.errstate(all="ignore"):
            same = np.abs(here - there).max() <= SAME * max(float(np.abs(there).max()), unit)
        if not same:
            raise ValueError(f"{name}: what is told is not what the numbers give")


def _sizes(units: Array) -> bool:
    return bool((np.isfinite(units) & (units > 0)).all())
