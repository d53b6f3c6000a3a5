"""Numbers along the ribbon: one number, a formula of s, or a table to be interpolated.

In a file `0.5`, `"1 - 0.7*s"`, `{s: [0, 0.5, 1], values: [1, 2, 1]}` or `{file: weights.csv}`; that
is read when the scene is loaded, so that a scene holds its numbers. The arclength s is in the units
of the scene: metres in SI.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from typing import Annotated, Any, get_origin

from ribbonopt.classes import dataclass

from .faults import KeyPath
from .schema.annotations import branches, classes_of, hints, inside
from .schema.bounds import InPython

#: fields of a scene in which such numbers may stand
ROOTS = ("loads", "natural", "width")


@dataclass(frozen=True)
class Table:
    """Values at arclengths, joined by a cubic spline (`scene.cubics`): curvatures are continuous.

    Third derivatives jump at the arclengths of the table, so that a mesh that has no nodes there
    converges as h^4 about them, whatever its degree; error bars see that.

    Attributes
    ----------
    s
        Arclengths, ascending; they cover the interval. Example: `[0, 0.5, 1]`
    values
        Value at each. Example: `[1, 2, 1]`
    """

    s: tuple[float, ...]
    values: tuple[float, ...]


@dataclass(frozen=True)
class TableFile:
    """A text file of rows s, value (commas or blanks between; `#` begins a comment).

    Attributes
    ----------
    file
        Its path, relative to the folder of the scene file. Example: `weights.csv`
    column
        Which column has the values, by the name in the first row, where there are more than two.
        Example: `force`
    """

    file: str
    column: str | None = None


@dataclass(frozen=True)
class Scaled:
    """A formula or table of a scene in other units: value(s * length) / unit."""

    value: str | Table
    unit: float
    length: float


Along = float | str | Table | TableFile | Annotated[Scaled, InPython()]


def scaled(value: Any, unit: float, length: float) -> Any:
    """Return a number along the ribbon divided by a unit, its arclength by a unit of length."""
    if value is None or (unit == 1 and length == 1):
        return value
    if isinstance(value, Scaled):
        return Scaled(value.value, value.unit * unit, value.length * length)
    return Scaled(value, unit, length) if isinstance(value, str | Table) else float(value) / unit


@cache
def is_along(annotation: Any) -> bool:
    """Whether numbers along the ribbon may stand where an annotation says what does."""
    return Table in classes_of(annotation).values()


def numbers_along(scene: Any) -> Iterator[tuple[KeyPath, Any]]:
    """Yield what stands in a scene, with its path, wherever a number along the ribbon may."""
    cls: type = type(scene)
    for root, annotation, default in _roots(cls):
        if (value := getattr(scene, root)) != default:  # most scenes have none
            yield from _inside(value, annotation, (root,))


@cache
def _roots(cls: type) -> tuple[tuple[str, Any, Any], ...]:
    """Return the fields where such numbers may stand: name, annotation, default."""
    found = []
    for member in (member for member in fields(cls) if member.name in ROOTS):
        made = member.default_factory
        default = member.default if made is MISSING else made()
        found.append((member.name, hints(cls)[member.name], default))
    return tuple(found)


def _inside(value: Any, annotation: Any, path: KeyPath) -> Iterator[tuple[KeyPath, Any]]:
    if value is None:
        return
    options = branches(annotation).values()
    if is_along(annotation):
        yield path, value
    elif is_dataclass(value):
        cls: type = type(value)
        for name, inner in hints(cls).items():
            yield from _inside(getattr(value, name, None), inner, (*path, name))
    elif isinstance(value, tuple):
        items = next((some for some in options if get_origin(some) is tuple), annotation)
        for index, item in enumerate(value):
            yield from _inside(item, inside(items, index), (*path, index))
