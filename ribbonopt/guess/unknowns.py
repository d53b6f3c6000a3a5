"""From a guess to the unknowns of a discretised problem."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import BoundaryValueProblem, Ribbon

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Blocks


class Guess(Protocol):
    """Anything that can say what the ribbon looks like."""

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""


class Solved(Guess, Protocol):
    """A guess that may have the unknowns themselves."""

    def unknowns_for(
        self, problem: BoundaryValueProblem, theta: Array, fraction: Array
    ) -> tuple[Array, Array] | None:
        """Unknowns v (k, nv) at fractions (k,), and constants; None if it has others."""


def initial_unknowns(
    guess: Guess,
    ribbon: Ribbon,
    problem: BoundaryValueProblem,
    blocks: Blocks,
    p: Array,
    switches: Array | None = None,
) -> Array:
    """Unknowns w (nw,) of the discretised problem that stand for a guess.

    `p` holds theta and the relative widths of the elements; `switches` are the fractions of the
    length where phases meet, if there are several.
    """
    layout, theta = blocks.layout, blocks.layout.theta(p)
    ends = np.concatenate([[0.0], [] if switches is None else switches, [1.0]])
    fractions = places_of(blocks, p, ends)
    own = getattr(guess, "unknowns_for", None)  # of a `Solved`: its check would take longer
    known = None if own is None else own(problem, theta, fractions)
    v, constants = known or _from_fields(guess, ribbon, problem, theta, fractions)
    if switches is not None and len(switches):
        names = [problem.parameter_names.index(f"interval.{end}") for end in ("start", "end")]
        total = theta[names[1]] - theta[names[0]]
        constants = np.concatenate([constants, total * np.diff(ends)[:-1]])
    constants = np.concatenate([constants, np.zeros(max(0, layout.nc - len(constants)))])
    return laid_out(blocks, v, constants[: layout.nc])


def places_of(blocks: Blocks, p: Array, ends: Array) -> Array:
    """Fractions (k,) of the length of all nodes and stages, in order; phases meet at `ends`."""
    layout = blocks.layout
    fractions = np.ones(layout.element_count * (layout.stages + 1) + 1)
    positions = fractions[:-1].reshape(layout.element_count, -1)
    positions[:, 0], positions[:, 1:] = layout.starts(p), blocks.stage_positions(p)
    for i, s in enumerate(layout.phase_slices):
        positions[s] *= ends[i + 1] - ends[i]
        positions[s] += ends[i]
    return np.asarray(np.minimum(fractions, 1.0))


def laid_out(blocks: Blocks, v: Array, constants: Array) -> Array:
    """Unknowns w (nw,) with the values v (k, nv) at the places of `places_of`, and constants."""
    layout = blocks.layout
    body = v[:-1].reshape(layout.element_count, layout.stages + 1, -1)
    nodes = np.concatenate([body[:, 0, : layout.nx], v[-1:, : layout.nx]])
    return layout.pack(nodes, body[:, 1:], constants)


def _from_fields(
    guess: Guess, ribbon: Ribbon, problem: BoundaryValueProblem, theta: Array, fractions: Array
) -> tuple[Array, Array]:
    """Unknowns v (k, nv) at fractions that do not decrease, and constants of the rod."""
    # A Radau scheme has its last stage on the next node: one value serves both.
    unique, where = np.unique(fractions, return_inverse=True)
    fields = guess.fields(unique)
    reference = theta[[problem.parameter_names.index(f"reference.{axis}") for axis in "xyz"]]
    x, constants = ribbon.model.pack(fields, reference)
    start, end = (problem.parameter_names.index(f"interval.{e}") for e in ("start", "end"))
    s = theta[start] + (theta[end] - theta[start]) * unique
    estimates = _estimates(problem, fields, theta, s)
    first, law = estimates.shape[1] - len(ribbon.law.controls), ribbon.law
    places = {name: i for i, name in enumerate(law.states)}
    places |= {name: first + i for i, name in enumerate(law.controls)}
    for name in places.keys() & fields.own.keys():
        estimates[:, places[name]] = fields.own[name]
    return np.hstack([x, estimates])[where], constants


def _estimates(problem: BoundaryValueProblem, fields: RodFields, theta: Array, s: Array) -> Array:
    """Last states and algebraic variables (k, ...) from n and m along the directors."""
    count = len(fields.r)
    if not problem.estimate.numel():
        return np.empty((count, 0))
    n, m = (np.einsum("ki,kij->kj", v, fields.frames) for v in (fields.n, fields.m))
    inputs = [problem.local, problem.parameters, problem.position]
    function = ca.Function("estimate", inputs, [problem.estimate])
    repeated = np.repeat(theta[:, None], count, axis=1)
    values = function.map(count)(np.hstack([n, m]).T, repeated, s[None])
    return np.asarray(np.array(values).T)
