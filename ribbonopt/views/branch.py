"""Figures of a branch of equilibria: quantities against the parameter, and ribbons along it.

Curves go smoothly through the points of one branch; special points and ribbons that are pictured
bear the numbers of their rows.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.plain import Row, Rows
from ribbonopt.solution.solution import Solution

from .branch_axes import COUNTS, dress
from .branch_numbers import write_numbers
from .branch_rows import KINK, POINT, BranchFigure, Piece, Plane
from .branch_style import COLOURS, DOT, STYLES, UNKNOWN, marks_of, state_of
from .branch_words import caption_of, plain_of, write_legend
from .columns import ColumnPair
from .curves import Array, curves_through
from .insets import draw_insets
from .locus_style import CUSP
from .paper_style import PAGE, PLAIN, Style, sized, thinner
from .strip import plot_strip
from .style import FAINT, INK, SI, SPECIAL, Drawn, blank, draw_all, tidy, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec

BEHIND, ASIDE = 0.01, 2.2  # of the axes: a curve this near to another is drawn as much wider


def plot_branch(
    rows: Rows,
    x: str,
    y: str,
    *,
    log: bool | Collection[str] = (),
    title: str = "",
    labels: Mapping[str, str] | None = None,
    si: bool = False,
    style: Style = PLAIN,
) -> Figure:
    """Plot quantity y against x, where "value" is the parameter; rows without either are left out.

    Parameters that differ by stage get axes each. `log` says whether they are logarithmic, or which
    columns are; with values that are not positive they are not. `labels` are what columns are
    called beside the axes, with formulas between $; `si` says whether numbers are in SI units.
    """
    names = {row["parameter"] for row in rows}
    figure = BranchFigure(
        rows,
        ((x, y),),
        title,
        names if log is True else log or (),
        si=si,
        labels={**(labels or {}), **style.labels},
    )
    with style.applied():
        return draw_branch(figure, (), style)


def save_branch_figures(
    figure: BranchFigure,
    ribbons: Mapping[int, Solution],
    folder: str | Path,
    style: Style = PLAIN,
    inside: Sequence[int] = (),
) -> Drawn:
    """Write branch.png, a panel for each of the first four pairs, and ribbons.png if any.

    That is left out, and it is said why, where a ribbon has no surface. `ribbons` are the solutions
    of points by their numbers; those of `inside` are drawn in the first panel.
    """
    shown = [row for row in figure.pictured if row["number"] in ribbons]
    inner = {number: ribbons[number] for number in inside}
    numbers = [row["number"] for row in shown]
    drawings = {"branch.png": partial(draw_branch, figure, numbers, style, inner)}
    if shown:
        solutions = [ribbons[row["number"]] for row in shown]
        captions = [caption_of(row, figure) for row in shown]
        drawings["ribbons.png"] = partial(plot_strip, solutions, captions, style)
    return draw_all(drawings, Path(folder), style)


def draw_branch(
    subject: BranchFigure,
    numbered: Sequence[int],
    style: Style = PLAIN,
    inside: Mapping[int, Solution] = MappingProxyType({}),
) -> Figure:
    """Draw a panel for each of the first four pairs, and one legend under them.

    Parameters
    ----------
    subject
        What to draw.
    numbered
        Numbers of points whose ribbons are pictured elsewhere.
    style
        Size, type, and how ribbons look.
    inside
        Ribbons that are pictured in the first panel, by the numbers of their points; if there are
        any, others have no numbers.
    """
    pairs, numbered = subject.pairs[:4], [*inside] or numbered
    most = max(len(subject.axes_of(pair)) for pair in pairs)
    columns = 1 if most > 1 or len(pairs) == 1 or style.narrow else 2
    count = math.ceil(len(pairs) / columns)
    width = min(1.5 + 4.0 * most, 14.0) if most > 1 else (PAGE if columns == 1 else 11.0)
    figure = blank(width, 5.4 if count == 1 else 3.8 * count + 0.6, style)
    grid = figure.add_gridspec(count, columns)
    for i, pair in enumerate(pairs):
        written = () if inside and i == 0 else numbered  # there are the ribbons themselves
        _panel(figure, grid[divmod(i, columns)], subject, pair, numbered, written)
    title(figure.axes[0], subject.title)
    if subject.title and style.titles:
        across = len(subject.axes_of(pairs[0])) if columns == 1 else min(columns, len(pairs))
        last = figure.axes[across - 1]
        last.set_title(SI if subject.si else SPECIAL, loc="right", fontsize=sized(9))
    write_legend(figure, subject, "" if inside or not numbered else f"ribbons.{style.format[0]}")
    if inside:
        draw_insets(figure.axes[0], subject, inside, style)
    return figure


def _panel(
    figure: Figure,
    cell: SubplotSpec,
    subject: BranchFigure,
    pair: ColumnPair,
    numbered: Sequence[int],
    written: Sequence[int],
) -> None:
    """Draw one pair of quantities, on axes of each parameter if these differ."""
    planes, first = subject.axes_of(pair), None
    inner = cell.subgridspec(1, len(planes))
    for i, plane in enumerate(planes):
        beside = first if pair[1] != "value" else None
        axes = figure.add_subplot(inner[i], sharey=beside)
        first = first or axes
        if plane.rows:
            _draw(axes, plane, numbered, written)
        else:
            words: dict[str, Any] = {"ha": "center", "color": FAINT, "transform": axes.transAxes}
            axes.text(0.5, 0.5, "nothing recorded", **words)
        dress(axes, plane)
        if beside:
            axes.set_ylabel("")
        axes.grid(True, which="major", alpha=0.25)
        tidy(axes)
        axes.tick_params(labelleft=beside is None)


def _draw(axes: Axes, plane: Plane, numbered: Sequence[int], written: Sequence[int]) -> None:
    """Draw curves, marks, dots and numbers of a plane that has points."""
    plain = plain_of(plane.figure)
    curves = [_curves(plane, piece) for piece in plane.pieces]
    for i, (piece, found) in enumerate(zip(plane.pieces, curves, strict=True)):
        colour = COLOURS[piece.rows[-1]["branch"] % len(COLOURS)]
        wider = ASIDE if _behind(plane, found, curves[i + 1 :]) else 1.0
        for state, curve in _stretches(piece.rows, found):
            style = {"color": colour} | STYLES[state] | (DOT if curve.shape[1] == 1 else {})
            style |= plain if state == UNKNOWN else {}
            style["lw"] *= wider
            axes.plot(*curve, label=state, **thinner(style))
    for name, chosen in marks_of(plane).items():
        if chosen:
            axes.plot(*plane.points(chosen), label=name, **thinner(STYLES[name]))
    regular = [row for row in plane.rows if row["number"] in numbered and row["kind"] == POINT]
    if regular:
        axes.plot(*plane.points(regular), ls="", color=INK, label="_", **thinner(DOT))
    write_numbers(axes, plane, written, [curve for found in curves for curve in found])


def _curves(plane: Plane, piece: Piece) -> list[Array]:
    """Return the curve (2, m) from each point of a piece to the next; of one point itself.

    In a plane of parameters, whose names are paths with dots, a locus has a corner at a cusp.
    """
    points = plane.points(piece.rows)
    if len(piece.rows) == 1:
        return [points]
    rows = [*piece.beyond[::-1], *piece.rows]
    rough = any(name in (*COUNTS, "error") for name in plane.pair)  # nothing is between points
    sharp = (KINK, CUSP) if all("." in name for name in plane.pair) else (KINK,)
    corners = [i for i, row in enumerate(rows) if row["kind"] in sharp or rough]
    found = curves_through(plane.scaled(plane.points(rows)), corners)
    curves = [plane.values(curve) for curve in found[len(piece.beyond) :]]
    for i, curve in enumerate(curves):
        curve[:, 0], curve[:, -1] = points[:, i], points[:, i + 1]  # to the last digit
    return curves


def _stretches(piece: Sequence[Row], curves: Sequence[Array]) -> list[tuple[str, Array]]:
    """Join curves while stability is the same; a fold or branch point ends both stretches."""
    if len(piece) == 1:
        return [(state_of(piece[0]), curves[0])]
    stretches: list[tuple[str, list[Array]]] = []
    for i, curve in enumerate(curves):
        both = piece[i : i + 2]
        states = {state_of(row) for row in [row for row in both if row["kind"] == POINT] or both}
        state = states.pop() if len(states) == 1 else UNKNOWN
        if not stretches or stretches[-1][0] != state:
            stretches.append((state, []))
        stretches[-1][1].append(curve if not stretches[-1][1] else curve[:, 1:])
    return [(state, np.concatenate(found, axis=1)) for state, found in stretches]


def _behind(plane: Plane, curves: Sequence[Array], later: Sequence[Sequence[Array]]) -> bool:
    """Whether one of the curves drawn later hides these, as mirror images do."""
    here = plane.scaled(np.concatenate(curves, axis=1))
    for other in later:
        there = plane.scaled(np.concatenate(other, axis=1))
        gaps = np.hypot(*(here[:, :, None] - there[:, None, :])).min(axis=1)
        if np.mean(gaps < BEHIND) > 0.5:
            return True
    return False
