"""Sparse matrices of CasADi made from numpy index arrays."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array

from .layout import Layout

Index = NDArray[np.int64]


def scatter(nonzeros: list[ca.MX], rows: Index, cols: Index, shape: tuple[int, int]) -> ca.MX:
    """Sparse matrix of the given nonzeros; entries at one place are added up."""
    values = ca.vertcat(*nonzeros)
    keys, where = np.unique(cols * shape[0] + rows, return_inverse=True)
    if len(keys) == len(rows):
        values = values[np.argsort(where).tolist()]
    else:
        ones = np.ones(len(rows))
        values = from_triplets(where, np.arange(len(rows)), ones, (len(keys), len(rows))) @ values
    return ca.MX(pattern(keys % shape[0], keys // shape[0], shape), values)


def pattern(rows: Index, cols: Index, shape: tuple[int, int]) -> ca.Sparsity:
    """Sparsity of unique entries sorted by columns."""
    starts = np.searchsorted(cols, np.arange(shape[1] + 1))
    return ca.Sparsity(*shape, starts.tolist(), rows.tolist())


def from_triplets(rows: Index, cols: Index, values: Array, shape: tuple[int, int]) -> ca.DM:
    """Constant sparse matrix of unique entries in any order."""
    order = np.lexsort((rows, cols))
    return ca.DM(pattern(rows[order], cols[order], shape), values[order])


def sparse(matrix: NDArray[np.floating[Any]]) -> ca.DM:
    """Constant sparse matrix of the nonzeros of an array."""
    return ca.sparsify(ca.DM(matrix))


def parts_of(p: ca.MX, layout: Layout, n_theta: int) -> tuple[ca.MX, ca.MX, ca.MX, ca.MX]:
    """Theta, numbers of the conditions, known fields at the places, and widths in parameters p."""
    ends = np.cumsum([0, n_theta, *layout.parameter_sizes]).tolist()
    theta, at_points, at_places, widths = ca.vertsplit(p, ends)
    numbers = ca.vertcat(theta, at_points) if layout.known else theta
    return theta, numbers, at_places, widths


def triplets_of(sparsity: ca.Sparsity) -> tuple[Index, Index]:
    """Return rows and columns of the nonzeros, in their order."""
    rows, cols = sparsity.get_triplet()
    return np.array(rows, dtype=np.int64), np.array(cols, dtype=np.int64)
