"""Tables for pandas, which is imported when one is made: rows of studies, a ribbon along s.

Columns of rows are those of the files: `branch.csv`, `table.csv`. Of a ribbon, units of the columns
stand in `frame.attrs["units"]`, in words.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.errors import PackageError
from ribbonopt.plain import Rows
from ribbonopt.scene.quantities import QUANTITIES
from ribbonopt.solution.solution import Solution

from .exports import ROWS

if TYPE_CHECKING:
    from pandas import DataFrame

AXES = "xyz"
#: what is told of a ribbon along s, in the order of its columns; positions are x, y, z
VECTORS = ("r", "d1", "d2", "d3", "n", "m")
SCALARS = ("u1", "u2", "u3", "eta", "n1", "n2", "n3", "m1", "m2", "m3", "extension", "energy", "H")
ALONG = (*VECTORS, *SCALARS)


def frame_along(solution: Solution, s: Any = None) -> DataFrame:
    """Return a table of a solution along s, in the units of the scene.

    Parameters
    ----------
    solution
        What is sampled.
    s
        Arclengths (k,) inside the scene's interval; 201 evenly spaced ones unless given.

    Returns
    -------
    DataFrame
        One row for each arclength: `s`; in the lab frame `x`, `y`, `z`, the directors `d1x` ...
        `d3z`, force and moment `nx` ... `mz`; strains `u1`, `u2`, `u3`, `eta`; force and moment
        along the directors, `n1` ... `m3`; `extension`, `energy` per length, `H`.

    Raises
    ------
    PackageError
        If pandas is not installed.
    ValueError
        If an arclength is outside the interval.
    """
    pandas = _pandas()
    places = np.linspace(*solution.scene.interval, ROWS) if s is None else np.atleast_1d(s)
    places = np.asarray(places, dtype=float)
    values = solution.outputs(places)
    columns, units = {"s": places}, {"s": _unit("r", si=solution.units.si)}
    for name in ALONG:
        unit = _unit(name, si=solution.units.si)
        for column, part in _parts(name, values[name]).items():
            columns[column], units[column] = part, unit
    frame = pandas.DataFrame(columns)
    frame.attrs |= {"name": solution.scene.name, "units": units}
    return frame


def frame_of(rows: Rows, names: list[str]) -> DataFrame:
    """Return a table of rows, with these columns in order; what a row lacks is missing there.

    Raises
    ------
    PackageError
        If pandas is not installed.
    """
    return _pandas().DataFrame(
        [{name: row.get(name) for name in names} for row in rows], None, names
    )


def _parts(name: str, values: np.ndarray[Any, Any]) -> dict[str, np.ndarray[Any, Any]]:
    """Return the columns of a quantity: of a vector its components in the lab frame."""
    if values.ndim == 1:
        return {name: values}
    first = "" if name == "r" else name
    return {first + axis: part for axis, part in zip(AXES, values.T, strict=True)}


def _unit(name: str, *, si: bool) -> str:
    """Return the unit of a quantity in words: SI, or powers of L and of D w / L^2."""
    found = QUANTITIES[name]
    length, force = ("m", "N") if si else ("L", "(D w/L^2)")
    powers = ((force, found.force), (length, found.length))
    return " ".join(u if power == 1 else f"{u}^{power}" for u, power in powers if power) or "1"


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise PackageError(
            "to_pandas: needs pandas; install it by pip install 'ribbonopt[pandas]'"
        ) from error
    return pandas
