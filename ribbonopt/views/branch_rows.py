"""What a figure of a branch shows: rows of points, their runs, and which ribbons are pictured."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import field
from functools import cached_property
from itertools import takewhile
from typing import NamedTuple

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.plain import Row, Rows, is_number
from ribbonopt.scene.quantities import ANSWERS

from .columns import ColumnPair, varied
from .curves import Array

POINT, FOLD, KINK = "point", "fold", "kink"
VALUE = "value"  # the parameter that the row's own stage moves
PICTURES, SPECIAL_PICTURES, ALONG = 12, 8, 5  # most pictures, of special points, least along
BEYOND = 2  # points on the other side of a crossing, that decide how a curve leaves it
NEAR = 0.04  # of the way along all branches: pictures this near to another show the same


@dataclass(frozen=True)
class BranchFigure:
    """Rows of a branch and what is drawn of them.

    Attributes
    ----------
    rows
        One for each accepted point in order: `number`, `stage`, `branch`, `parameter` (a dotted
        path, a column of its own), `kind`, `negative` (negative directions, None unknown), `note`
        and quantities.
    pairs
        Columns (x, y) of the panels; "value" is the parameter of the row's stage.
    title
        Name of the scene.
    log
        Columns on logarithmic axes, where they are positive.
    jumps
        Numbers of points that the point before does not lead to.
    si
        Whether numbers are in SI units.
    labels
        What columns are called beside axes, where the scene says it.
    """

    rows: Rows
    pairs: tuple[ColumnPair, ...]
    title: str = ""
    log: Collection[str] = ()
    jumps: Collection[int] = ()
    si: bool = False
    labels: Mapping[str, str] = field(default_factory=dict)

    @property
    def parameters(self) -> list[str]:
        """The parameters that stages move, in order."""
        return list(dict.fromkeys(row["parameter"] for row in self.rows))

    def axes_of(self, pair: ColumnPair) -> list[Plane]:
        """Return a plane for each parameter that has axes of its own."""
        names = self.parameters if VALUE in pair else []
        if len(names) > 1:
            return [Plane(self, pair, name) for name in names]
        return [Plane(self, pair)]

    @cached_property
    def pictured(self) -> list[Row]:
        """Rows whose ribbons are pictured: special points, and some evenly along all branches."""
        special = [row for row in self.rows if row["kind"] != POINT]
        places = np.linspace(0, len(special) - 1, min(len(special), SPECIAL_PICTURES)).round()
        chosen = [special[int(i)] for i in places]
        along = self._along
        if not along:
            return chosen
        where, whole = {row["number"]: s for s, row in along}, along[-1][0] or 1.0
        regular = [(s, row) for s, row in along if row["kind"] == POINT] or along
        count = max(ALONG, min(PICTURES - len(chosen), 2 * ALONG) - 1)
        for s in np.linspace(0, whole, count if len(regular) > 1 else 1):
            at, row = min(regular, key=lambda item: abs(item[0] - s))
            taken = [where[other["number"]] for other in chosen if other["number"] in where]
            if len(chosen) < PICTURES and all(abs(at - s) > NEAR * whole for s in taken):
                chosen.append(row)
        return sorted(chosen, key=lambda row: int(row["number"]))

    @cached_property
    def _along(self) -> list[tuple[float, Row]]:
        """Rows with their way along all branches, as long as the first panel shows it."""
        found: list[tuple[float, Row]] = []
        gone = 0.0
        for plane in self.axes_of(self.pairs[0]):
            for run in plane.runs:
                points = plane.scaled(plane.points(run))
                steps = np.hypot(*np.diff(points)) if len(run) > 1 else np.empty(0)
                ways = gone + np.concatenate([[0.0], np.cumsum(steps)])
                found += [(float(way), row) for way, row in zip(ways, run, strict=True)]
                gone = float(ways[-1])
        return found


class Piece(NamedTuple):
    """Rows that one curve goes through; `beyond` are those on the other side of its begin."""

    rows: list[Row]
    beyond: list[Row]


@dataclass(frozen=True)
class Plane:
    """The plane of a pair of quantities; of one parameter alone if there are axes for each."""

    figure: BranchFigure
    pair: ColumnPair
    parameter: str = ""  # "" stands for all

    @cached_property
    def rows(self) -> list[Row]:
        """Rows that have both quantities."""
        rows = (row for row in self.figure.rows if self.parameter in ("", row["parameter"]))
        return [row for row in rows if np.isfinite(self.points([row])).all()]

    def name(self, k: int) -> str:
        """Return the column along an axis."""
        names = [self.parameter] if self.parameter else self.figure.parameters
        return names[0] if self.pair[k] == VALUE and names else self.pair[k]

    def points(self, rows: Rows) -> Array:
        """Values (2, k) of both quantities, NaN where there are none."""
        return np.array([[_number(row, quantity) for row in rows] for quantity in self.pair], float)

    @cached_property
    def log(self) -> tuple[bool, bool]:
        """Whether each axis is logarithmic."""
        wanted = {"error", *self.figure.log}
        low = self.points(self.rows).min(axis=1, initial=np.inf)
        return (self.name(0) in wanted and low[0] > 0, self.name(1) in wanted and low[1] > 0)

    def scaled(self, values: Array) -> Array:
        """Return values (2, k) as places in a square of unit size."""
        places = self._straight(values)
        low, size = self._frame
        return np.asarray((places - low[:, None]) / size[:, None])

    def values(self, places: Array) -> Array:
        """Return values (2, k) at places in the square."""
        low, size = self._frame
        found = places * size[:, None] + low[:, None]
        for k in (k for k in range(2) if self.log[k]):
            found[k] = 10 ** found[k]
        return np.asarray(found)

    @cached_property
    def runs(self) -> list[list[Row]]:
        """Rows by stage and branch, in order."""
        runs: dict[tuple[int, int], list[Row]] = {}
        for row in self.rows:
            runs.setdefault((row["stage"], row["branch"]), []).append(row)
        return list(runs.values())

    @cached_property
    def pieces(self) -> list[Piece]:
        """The runs, cut at jumps; each that branches off begins with where it does."""
        begins = [self._origin(run) for run in self.runs]
        found = []
        for run, begin in zip(self.runs, begins, strict=True):
            # Where two runs leave one point they are the halves of one curve through it.
            others = ((r, b) for r, b in zip(self.runs, begins, strict=True) if r is not run)
            sides = [r for r, b in others if b is begin]
            # So are one that begins there and one that leaves it: the two ways from a start.
            sides += [r[1:] for r in self.runs if r[0] is begin and r is not run]
            beyond = sides[0][:BEYOND] if begin is not None and len(sides) == 1 else []
            beyond = list(takewhile(lambda row: row["number"] not in self.figure.jumps, beyond))
            rows = [] if begin is None else [begin]
            for row in run:
                if row["number"] in self.figure.jumps:
                    found += [Piece(rows, beyond)] if rows and rows[-1] is not begin else []
                    rows, beyond = [], []
                rows.append(row)
            found.append(Piece(rows, beyond))
        return found

    def _origin(self, run: Rows) -> Row | None:
        here = origin_of(run[0], self.figure.rows) if run[0]["branch"] else None
        return None if here is None or not np.isfinite(self.points([here])).all() else here

    def flat(self, k: int) -> bool:
        """Whether the values along an axis differ by rounding only."""
        return bool(self.rows) and not varied(self.rows, self.name(k))

    @cached_property
    def _frame(self) -> tuple[Array, Array]:
        places = self._straight(self.points(self.rows))
        low, size = places.min(axis=1), np.ptp(places, axis=1)
        flat = np.array([self.flat(k) for k in range(2)])
        return low, np.where(flat | (size == 0), 1.0, size)

    def _straight(self, values: Array) -> Array:
        found = np.array(values, float)
        for k in (k for k in range(2) if self.log[k]):
            found[k] = np.log10(found[k])
        return found


def origin_of(first: Row, rows: Rows) -> Row | None:
    """Return the point that a branch leaves, from its first one.

    Where rows do not say (`origin`, a number) it is the nearest of the crossings found before.
    """
    if first.get("origin") is not None:
        return next((row for row in rows if row["number"] == first["origin"]), None)
    crossings = [
        row
        for row in rows
        if row["stage"] == first["stage"]
        and row["number"] < first["number"]
        and row["kind"] not in (POINT, FOLD)
    ]
    if not crossings:
        return None
    names = [first["parameter"], *ANSWERS]
    table = np.array([[_number(row, name) for name in names] for row in rows], float)
    size = np.ptp(np.where(np.isfinite(table), table, 0.0), axis=0)

    def distance(row: Row) -> float:
        gaps = [_number(row, name) - _number(first, name) for name in names]
        return float(np.nansum((np.array(gaps) / np.where(size > 0, size, 1.0)) ** 2))

    return min(crossings, key=distance)


def _number(row: Row, quantity: str) -> float:
    value = row.get(row["parameter"] if quantity == VALUE else quantity)
    return float(value) if value is not None and is_number(value) else np.nan
