"""The shape of a solution at the stages of a Gauss scheme, whichever equations it was found by."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.accuracy.estimate import relative_error
from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.mechanics.outputs import own_name
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import Ribbon
from ribbonopt.problem.held import held_between
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Tableau, gauss
from ribbonopt.transcription.buffered import Mapped
from ribbonopt.transcription.tableaus import MAX_DEGREE

from .zero_moment import lacks_linearisation

STAGES = 100  # in all where others are taken; more only on fine meshes, with four in each element
LEAST_ELEMENTS, HIGHEST_DEGREE = 10, 8
SAME = 1e-12  # of the length: places of stages


@dataclass(frozen=True, eq=False)
class GaussStages:
    """A shape at the stages of N elements with K stages each, units Dw = L = 1.

    Attributes
    ----------
    widths : (N,) array
        Widths of the elements, fractions of the length.
    tableau : Tableau
        The scheme.
    places : (N K,) array
        Fractions at which the stages are.
    x, z : (N K, nx), (N K, nz) arrays
        States of the reduced model and of the law's energy form, and the controls of that: moments
        along the directors of the free strains, or what else the law says.
    ends : (2, nx) array
        States at the start and at the end.
    firsts : (k,) integer array
        Elements that begin at a switch.
    x_switch, z_switch : (k, nx), (k, nz) arrays
        States and controls there.
    switching : (N K,) array
        What changes its sign where the law switches.
    error : float
        Relative error of the shape as estimated; zero where it shows elsewhere.
    """

    widths: Array
    tableau: Tableau
    places: Array
    x: Array
    z: Array
    ends: Array
    firsts: NDArray[np.intp]
    x_switch: Array
    z_switch: Array
    switching: Array
    error: float


class Sampled(NamedTuple):
    """A solution at the stages of elements with `widths` (N,), and where it begins, turns and ends.

    `every` are the named outputs at all these places in their order, at the fractions `fraction`;
    `rows` are those of `every` that are no stages. `firsts` are the elements that begin at a
    switch, `error` is that of the shape where it shows nowhere else.
    """

    widths: Array
    degree: int
    fraction: Array
    every: Mapping[str, Array]
    rows: NDArray[np.intp]
    firsts: NDArray[np.intp]
    error: float


def sampled(solution: Solution, *, again: bool = False) -> Sampled:
    """Return a solution at its own stages where they are those of a Gauss scheme, else at others.

    `again` is for a second opinion: at a degree more, or in elements half as wide where there is
    none.
    """
    trajectory, degree = solution.trajectory, solution.dense.blocks.degree
    widths, parts = np.diff(trajectory.nodes), 1
    own, error = trajectory.stages[1], None
    if len(own) == len(widths) * degree and degree <= MAX_DEGREE:
        places = _places(widths, degree)
        if np.abs(own - places).max() < SAME:
            error = known_error(solution)
    if error is None:
        parts = -(-LEAST_ELEMENTS // len(widths))
        degree = min(degree, max(4, STAGES // (parts * len(widths))), HIGHEST_DEGREE)
    if again:
        parts, degree = (parts, degree + 1) if degree < MAX_DEGREE else (2 * parts, degree)
    if error is not None and not again:
        along: Mapping[str, Array] = trajectory.at_stages
    else:
        widths = np.repeat(widths / parts, parts)
        places = _places(widths, degree)
        along = trajectory.outputs(places)
    lengths = np.array(trajectory.dense.blocks.layout.elements)
    turns = np.array(trajectory.turns, dtype=int)
    firsts = parts * np.cumsum(lengths)[turns - 1]
    points = {k: v[[0, *(firsts // parts), -1]] for k, v in trajectory.at_nodes.items()}
    at = np.concatenate([[0], degree * firsts, [len(places)]])
    every = {k: np.insert(along[k], at, points[k], axis=0) for k in along}
    fraction = np.insert(places, at, trajectory.ends[[0, *turns, -1]])
    return Sampled(widths, degree, fraction, every, at + np.arange(len(at)), firsts, error or 0.0)


def gauss_stages(
    solution: Solution, ribbon: Ribbon, theta: Array, *, again: bool = False
) -> GaussStages:
    """Return the stages of the energy's own states and controls at a solution.

    At its own stages it is an equilibrium of the discrete energy too, to rounding, whatever its
    mesh: there the estimated error tells how near it is to the true one. At others it is not, and
    the gradient of the energy tells. `theta` are the numbers of the ribbon; `again`: see `sampled`.
    """
    return packed(solution, sampled(solution, again=again), ribbon, theta)


def packed(solution: Solution, given: Sampled, ribbon: Ribbon, theta: Array) -> GaussStages:
    """Return what was sampled of a solution, or put together of it, as stages of the energy."""
    every, rows = given.every, given.rows
    # Packed together, in order, for quaternions that do not change their sign.
    r, frames, n, m = _fields(every)
    fields = RodFields(r, frames, n, m)
    # Any point of reference will do: it is for constants, which the energy does without.
    x, _ = ribbon.model.pack(fields, fields.r[0])
    if ribbon.stations:
        x = np.hstack([x, _held(solution, ribbon, given.fraction, fields.r)])
    x = np.hstack([x, *(_own(every, name)[:, None] for name in ribbon.law.states)])
    z = _controls(every, ribbon, given.fraction, theta)
    inside, between = np.delete(np.arange(len(x)), rows), rows[1:-1]
    return GaussStages(
        given.widths,
        gauss(given.degree),
        given.fraction[inside],
        x[inside],
        z[inside],
        x[rows[[0, -1]]],
        given.firsts,
        x[between],
        z[between],
        every["switching"][inside],
        given.error,
    )


def _controls(o: Mapping[str, Array], ribbon: Ribbon, fraction: Array, theta: Array) -> Array:
    """Return the controls (k, nz) of the law, of named outputs at fractions (k,) of the length."""
    given = [o[f"{load}{i}"] for load in "nm" for i in (1, 2, 3)]
    given += [_own(o, name) for name in ribbon.law.indirect().states]
    function = ribbon.kept(_control_function)
    (found,) = function(np.column_stack(given), np.empty(0), theta, fraction)
    return found.reshape(len(fraction), -1)


def _control_function(ribbon: Ribbon) -> Mapped:
    """Return the controls by forces and moments along directors, own states, theta, fraction."""
    states = ribbon.law.indirect().states
    local, (start, end) = ca.SX.sym("local", 6 + len(states)), ribbon.interval
    share = ca.SX.sym("share")
    place = start + share * (end - start)
    controls = ribbon.law.controls_at(Stress(local[:3], local[3:6], local[6:]))
    controls = ca.densify(ca.substitute(controls, ribbon.position, place))
    inputs = [local, ca.SX(0, 1), ribbon.parameters, share]
    return Mapped(ca.Function("controls", inputs, [controls]))


def _own(o: Mapping[str, Array], state: str) -> Array:
    """Return a state of the law's own, of named outputs: zero in a plane, where none has any."""
    name = own_name(state)
    return o[name] if name in o else np.zeros(len(o["r"]))


def _held(solution: Solution, ribbon: Ribbon, fraction: Array, r: Array) -> Array:
    """States of the least energy that stand for supports between the ends, at fractions."""
    held, (start, _) = held_between(ribbon), solution.posed.scene.interval
    names = list(ribbon.theta)
    theta = ca.Function("places", [ribbon.parameters], [ca.vertcat(ca.SX(0, 1), *held.places)])
    known = dict(zip(solution.problem.parameter_names, solution.dense.theta, strict=True))
    s = np.array(theta([known.get(name, 0.0) for name in names])).ravel()
    places = (s - start) / solution.posed.length
    return held.packed(fraction, r, places, solution.trajectory.outputs(places)["r"])


def _places(widths: Array, degree: int) -> Array:
    """Fractions (N K,) of the stages."""
    starts = np.append(0.0, np.cumsum(widths)[:-1])
    places: Array = (starts[:, None] + widths[:, None] * gauss(degree).nodes).ravel()
    return places


def _fields(o: Mapping[str, Array]) -> tuple[Array, Array, Array, Array]:
    """Return r, frames, n and m of named outputs, in the order of `RodFields`."""
    return o["r"], np.stack([o["d1"], o["d2"], o["d3"]], axis=2), o["n"], o["m"]


def known_error(solution: Solution) -> float | None:
    """Relative error of a solution; None where it cannot be told."""
    if solution.problem.recovered or lacks_linearisation(solution):
        return None
    try:
        return relative_error(solution)[0]
    except np.linalg.LinAlgError:
        return None
