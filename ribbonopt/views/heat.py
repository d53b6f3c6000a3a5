"""A full grid of two inputs as cells, coloured by a column; those that failed are marked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.plain import Row, Rows, is_number

from .columns import ColumnPair, is_logarithmic
from .curves import Array
from .paper_style import area, stroke
from .style import TWIST

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh

NO_ANSWER = "#e6e6e6"  # a cell without a number
MANY = 2500  # cells, from which on they are one picture in files of lines too


@dataclass(frozen=True, eq=False)
class Grid:
    """A row for each pair of two values: `rows[j][i]` is that of x[i] and y[j]."""

    x: Array
    y: Array
    rows: Sequence[Sequence[Row]]

    def values(self, column: str) -> Array:
        """Return a column (len(y), len(x)), NaN where a ribbon failed or says nothing."""
        good = [[row if row["verified"] else {} for row in line] for line in self.rows]
        return np.asarray([[_number(row, column) for row in line] for line in good])

    @property
    def failed(self) -> Array:
        """Places (2, k) of ribbons that failed."""
        places = [
            (x, y)
            for y, line in zip(self.y, self.rows, strict=True)
            for x, row in zip(self.x, line, strict=True)
            if not row["verified"]
        ]
        return np.asarray(np.array(places, float).reshape(-1, 2).T)


def grid_of(rows: Rows, pair: ColumnPair, inputs: Sequence[str]) -> Grid | None:
    """Return rows as a full grid of two inputs, at least two by two; None where they are none."""
    if not set(pair) <= set(inputs) or pair[0] == pair[1]:
        return None
    cells = {tuple(_number(row, name) for name in pair): row for row in rows}
    x, y = (np.unique([cell[k] for cell in cells]) for k in range(2))
    full = len(x) * len(y) == len(cells) == len(rows)
    if not full or min(len(x), len(y)) < 2 or not np.isfinite([*x, *y]).all():
        return None
    return Grid(x, y, [[cells[float(a), float(b)] for a in x] for b in y])


def draw_heat(axes: Axes, grid: Grid, column: str, norm: Any) -> QuadMesh:
    """Draw the cells of a grid by a column, and crosses where a ribbon failed."""
    values = np.ma.masked_invalid(grid.values(column))
    for name, along in (("x", grid.x), ("y", grid.y)):
        if is_logarithmic(along.tolist()):
            axes.set(**{f"{name}scale": "log"})
    axes.set_facecolor(NO_ANSWER)
    mesh = axes.pcolormesh(
        edges_of(grid.x),
        edges_of(grid.y),
        values,
        cmap="viridis",
        norm=norm,
        rasterized=values.size > MANY,
    )
    marks: dict[str, Any] = {"marker": "x", "color": TWIST, "s": area(22), "lw": stroke(1.2)}
    axes.scatter(*grid.failed, **marks)
    return mesh


def edges_of(values: Array) -> Array:
    """Return edges (k + 1) of cells about increasing values (k), halfway between these.

    Halfway on a logarithmic axis, where values are better seen so.
    """
    powers = is_logarithmic(values.tolist())
    middle = np.log10(values) if powers else values
    inner = (middle[:-1] + middle[1:]) / 2
    ends = 2 * middle[[0, -1]] - inner[[0, -1]]
    found = np.concatenate([ends[:1], inner, ends[1:]])
    return np.asarray(10**found if powers else found)


def _number(row: Row, name: str) -> float:
    value = row.get(name)
    return float(value) if value is not None and is_number(value) else np.nan
