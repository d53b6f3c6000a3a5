"""From a guess to the unknowns of a discretised problem."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics import RodFields
from ribbonopt.problem import BoundaryValueProblem, Ribbon

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Blocks


class Guess(Protocol):
    """Anything that can say what the ribbon looks like."""

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""


def initial_unknowns(
    guess: Guess, ribbon: Ribbon, problem: BoundaryValueProblem, blocks: Blocks, p: Array
) -> Array:
    """Unknowns w (nw,) of the discretised problem (one phase) that stand for a guess.

    `p` holds theta and the relative widths of the elements.
    """
    layout, widths = blocks.layout, blocks.widths(p)
    theta = p[: len(p) - layout.element_count]
    nodes = np.concatenate([[0.0], np.cumsum(widths)])
    nodes[-1] = 1.0
    positions = np.hstack([nodes[:-1, None], blocks.stage_positions(p)])
    fractions = np.append(positions.ravel(), 1.0)
    # A Radau scheme has its last stage on the next node: one value serves both.
    unique, where = np.unique(fractions, return_inverse=True)
    fields = guess.fields(unique)
    reference = theta[[problem.parameter_names.index(f"reference.{axis}") for axis in "xyz"]]
    x, constants = ribbon.model.pack(fields, reference)
    more = _estimates(problem, fields, theta)
    count = layout.nx - x.shape[1]
    x, z = np.hstack([x, more[:, :count]])[where], more[:, count:][where]
    body = np.hstack([x, z])[:-1].reshape(layout.element_count, layout.stages + 1, -1)
    ends = np.vstack([body[:, 0, : layout.nx], x[-1:]])
    return layout.pack(ends, body[:, 1:], constants[: layout.nc])


def _estimates(problem: BoundaryValueProblem, fields: RodFields, theta: Array) -> Array:
    """Last states and algebraic variables (k, ...) from the moments along d2 and d3."""
    count = len(fields.r)
    if not problem.estimate.numel():
        return np.empty((count, 0))
    local = np.einsum("ki,kij->kj", fields.m, fields.frames)[:, 1:]
    function = ca.Function("estimate", [problem.local, problem.parameters], [problem.estimate])
    values = function.map(count)(local.T, np.repeat(theta[:, None], count, axis=1))
    return np.asarray(np.array(values).T)
