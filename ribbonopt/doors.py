"""Doors to rooms above: what shows a solution, by names that are imported when they are called.

A room imports only rooms that know less than it does. That `solution.plot()` draws is a convenience
of words, no knowledge: nothing below depends on what is drawn, or on whether it can be. So the name
of the function stands here as text, and its room is loaded by the first call, never by an import.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from matplotlib.figure import Figure
    from pandas import DataFrame


def door(room: str, name: str) -> Callable[..., Any]:
    """Return a function of a room of the package, such as "views", by its name."""
    found: Callable[..., Any] = getattr(import_module(f"ribbonopt.{room}"), name)
    return found


def told_in_short(solution: object) -> str:
    """Return what a solution is, in one line."""
    words: str = door("output.words", "in_short")(solution)
    return words


def solution_drawn(solution: object, kind: str, style: object | None) -> Figure:
    """Return a figure of a solution; without a style as the command line draws it."""
    more = () if style is None else (style,)
    figure: Figure = door("views", "plot_solution")(solution, kind, *more)
    return figure


def modes_or_reason(solution: object, count: int, planar: bool) -> Any:
    """Return the modes of a solution or, in words, why it has none."""
    return door("checks.modes", "modes_of")(solution, count, planar=planar)


def branch_drawn(
    rows: Sequence[Mapping[str, Any]],
    pair: tuple[str, str],
    log: Sequence[str],
    title: str,
    labels: Mapping[str, str],
    si: bool,
    style: object | None,
) -> Figure:
    """Return a diagram of two columns of a branch; `log` are those on logarithmic axes."""
    draw, style = door("views", "plot_branch"), style or door("views", "Style")()
    figure: Figure = draw(rows, *pair, log=log, title=title, labels=labels, si=si, style=style)
    return figure


def batch_drawn(
    rows: Sequence[Mapping[str, Any]],
    pair: tuple[str, str],
    inputs: Sequence[str],
    labels: Mapping[str, str],
    style: object | None,
) -> Figure:
    """Return a figure of two columns of a batch."""
    draw, style = door("views", "plot_batch"), style or door("views", "Style")()
    figure: Figure = draw(rows, *pair, inputs=inputs, labels=labels, style=style)
    return figure


def map_drawn(
    data: Mapping[str, Any], shapes: Mapping[int, Sequence[object]], style: object | None
) -> Figure:
    """Return the figure of a map, with the shapes at its counted points."""
    draw, style = door("views", "plot_map"), style or door("views", "Style")()
    figure: Figure = draw(data, shapes, style=style)
    return figure


def frame_along(solution: object, s: object | None) -> DataFrame:
    """Return a table of a solution along s."""
    table: DataFrame = door("output.frames", "frame_along")(solution, s)
    return table


def frame_of(rows: Sequence[Mapping[str, Any]], names: list[str]) -> DataFrame:
    """Return a table of rows with these columns."""
    table: DataFrame = door("output.frames", "frame_of")(rows, names)
    return table
