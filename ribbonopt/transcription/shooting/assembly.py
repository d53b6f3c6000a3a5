"""The sparse shooting NLP as CasADi functions, its Jacobian laid out by hand.

Element e contributes -dPhi/dx in the columns of its node, an identity in those of the next node and
-dPhi/dc in those of the constants.
"""

from __future__ import annotations

from collections.abc import Sequence

import casadi as ca
import numpy as np

from ribbonopt.transcription.buffered import shared_map
from ribbonopt.transcription.functions import ConditionFunctions
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.nlp import NLPFunctions
from ribbonopt.transcription.sparse import Index, parts_of, scatter, triplets_of

from .blocks import Flow


def shooting_functions(
    layout: Layout, flows: Sequence[Flow], conditions: ConditionFunctions, n_theta: int
) -> NLPFunctions:
    """Cost (none), constraints, Jacobian and Hessian (empty: equations only)."""
    lay, count = layout, layout.element_count
    w = ca.MX.sym("w", lay.unknowns)
    p = ca.MX.sym("p", n_theta + sum(lay.parameter_sizes))
    theta, numbers, known, widths = parts_of(p, lay, n_theta)
    body, c = ca.vertsplit(w, [0, lay.constants_at, lay.unknowns])
    nodes, widths = ca.reshape(body, lay.nx, count + 1), widths.T
    points = ca.horzcat(*(nodes[:, i] for i in lay.point_elements))

    def each(name: str) -> list[list[ca.MX]]:
        """Return the outputs of a step function of every phase, mapped over its elements."""
        result = []
        for flow, s in zip(flows, lay.phase_slices, strict=True):
            h = widths[0, s.start : s.stop]
            place = h @ ca.DM(np.triu(np.ones((s.stop - s.start,) * 2), 1))
            if lay.known:
                k = ca.reshape(known, lay.known * len(lay.places), count)
                place = ca.vertcat(place, k[:, s.start : s.stop])
            mapped = shared_map(getattr(flow.step, name), s.stop - s.start)
            result.append(mapped.call([nodes[:, s.start : s.stop], c, theta, place, h]))
        return result

    def residuals(after: list[ca.MX], values: ca.MX) -> ca.MX:
        return ca.vertcat(ca.vec(nodes[:, 1:] - ca.horzcat(*after)), values)

    plain = residuals([after for (after,) in each("values")], conditions.values(points, c, numbers))
    stepped = each("dense")
    values, nonzeros = conditions.sparse(points, c, numbers)
    rows, columns = _places(lay, conditions)
    slopes = ca.vertcat(*(ca.vec(slope) for _, slope in stepped))
    entries = [-slopes, ca.MX.ones(count * lay.nx), nonzeros]
    jacobian = scatter(entries, rows, columns, (lay.equations, lay.unknowns))
    both = [residuals([after for after, _ in stepped], values), jacobian]
    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", lay.equations)
    empty = ca.MX(lay.unknowns, lay.unknowns)
    return NLPFunctions(
        ca.Function("cost", [w, p], [ca.MX(0)]),
        ca.Function("constraints", [w, p], [plain]),
        ca.Function("jacobian", [w, p], both),
        ca.Function("hessian", [w, p, lam_f, lam_g], [empty]),
    )


def _places(lay: Layout, conditions: ConditionFunctions) -> tuple[Index, Index]:
    """Rows and columns of all entries: derivatives of the steps, identities, conditions."""
    e = np.arange(lay.element_count)[:, None, None]
    x, y = np.arange(lay.nx), np.arange(lay.nx + lay.nc)[:, None]
    rows = np.broadcast_to(e * lay.nx + x, (lay.element_count, len(y), lay.nx))
    columns = np.where(y < lay.nx, e * lay.nx + y, lay.constants_at + y - lay.nx)
    ends = np.arange(lay.element_count * lay.nx)
    row, col = triplets_of(conditions.jacobian.sparsity())
    return (
        np.concatenate([rows.ravel(), ends, row + lay.conditions_at]),
        np.concatenate(
            [
                np.broadcast_to(columns, rows.shape).ravel(),
                ends + lay.nx,
                lay.condition_columns[col],
            ]
        ),
    )
