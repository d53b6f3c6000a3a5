"""Where the nonzeros of the stages' Jacobians go in the Jacobian of one element."""

from __future__ import annotations

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.sparse import Index, from_triplets
from ribbonopt.transcription.tableaus import Tableau


def element_pattern(
    lay: Layout, t: Tableau, row: Index, col: Index
) -> tuple[ca.DM, ca.DM, Index, Index]:
    """S, k and the local rows and columns of the nonzeros S J + k of one element.

    Local columns: node, stages, next node, constants.
    """
    K, x = lay.stages, np.arange(lay.nx)
    end_rows = K * lay.stage_equations + x
    next_node = lay.element_unknowns + x
    entries: list[tuple[Index, Index, NDArray[np.float64], Index]] = []
    none = np.full(lay.nx, -1)
    for i in range(K):
        rows = i * lay.stage_equations + x
        entries.append((rows, lay.nx + i * lay.nv + x, np.ones(lay.nx), none))
        entries.append((rows, x, -np.ones(lay.nx), none))
    entries.append((end_rows, next_node, np.ones(lay.nx), none))
    entries.append((end_rows, x, -np.ones(lay.nx), none))
    dynamic = np.flatnonzero(row < lay.nx)
    static = np.flatnonzero(row >= lay.nx)
    for j in range(K):
        local = np.where(
            col < lay.nv,
            lay.nx + j * lay.nv + col,
            lay.element_unknowns + lay.nx + col - lay.nv,
        )
        source = j * len(row) + np.arange(len(row))
        for i in range(K):
            rows = i * lay.stage_equations + row[dynamic]
            value = np.full(len(dynamic), -t.matrix[i, j])
            entries.append((rows, local[dynamic], value, source[dynamic]))
        rows = K * lay.stage_equations + row[dynamic]
        value = np.full(len(dynamic), -t.weights[j])
        entries.append((rows, local[dynamic], value, source[dynamic]))
        rows = j * lay.stage_equations + row[static]
        entries.append((rows, local[static], np.ones(len(static)), source[static]))
    r, c, v, source = (np.concatenate(part) for part in zip(*entries, strict=True))
    width = lay.element_unknowns + lay.nx + lay.nc
    keys, where = np.unique(r * width + c, return_inverse=True)
    linear = source >= 0
    S = from_triplets(where[linear], source[linear], v[linear], (len(keys), K * len(row)))
    k = np.bincount(where[~linear], v[~linear], len(keys))
    return S, ca.DM(k), keys // width, keys % width
