"""The figure of a map: regions by how many shapes are stable there, loci, and the shapes.

Colours grow darker with the number of stable shapes; folds are solid lines, what other branches
cross is dashed. The stable shapes at the innermost point of a region stand about it, or as near as
there is room, joined to it by a thin line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from .locus_style import LINES, MARKS, OTHER_LINE, POINTED
from .map_shapes import draw_shapes
from .paper_style import PAGE, PLAIN, Style, sized, spaced, stroke, thinner
from .style import FAINT, SI, SPECIAL, Drawn, blank, draw_all, tidy, title
from .symbols import symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 5.6  # inches
#: of regions with 0, 1, 2, ... stable shapes; the last one stands for more as well
STABLE = ("#f7f7f7", "#dfeaf5", "#b0cde8", "#85b0d8", "#5f93c4", "#4076ab", "#2d5a8e")
UNKNOWN: dict[str, Any] = {"fc": "white", "hatch": "////", "ec": "#bbbbbb"}
THIN: dict[str, Any] = {"lw": 0.8, "alpha": 0.75}
#: what is special of a locus as the second number alone varies, and is not in a plane of both
UNMARKED = ("turn", "isola centre", "crossing")
OTHER_MARK = POINTED | {"marker": "*", "mfc": "w", "ms": 9}


def plot_map(
    data: Mapping[str, Any],
    shapes: Mapping[int, Sequence[Solution]] | None = None,
    *,
    style: Style = PLAIN,
) -> Figure:
    """Draw a map.

    Parameters
    ----------
    data
        What `map.json` says.
    shapes
        Stable shapes at counted points, by the numbers of these; where there are none, none are
        drawn.
    style
        Size, type, and how ribbons look.
    """
    with style.applied():
        return _draw(data, shapes or {}, style)


def save_map(
    data: Mapping[str, Any],
    shapes: Mapping[int, Sequence[Solution]],
    folder: str | Path,
    style: Style = PLAIN,
) -> Drawn:
    """Write map.png, or what else the style asks for."""
    return draw_all({"map.png": partial(_draw, data, shapes, style)}, Path(folder), style)


def _draw(
    data: Mapping[str, Any], shapes: Mapping[int, Sequence[Solution]], style: Style
) -> Figure:
    figure = blank(PAGE, HEIGHT, style)
    axes = figure.add_subplot()
    labels = {**data["labels"], **style.labels}
    (left, right), (low, high) = data["ranges"]
    axes.set(xlim=(left, right), ylim=(low, high))
    axes.set_xlabel(symbol(data["x"], labels))
    axes.set_ylabel(symbol(data["y"], labels))
    title(axes, data["name"])
    if style.titles:
        axes.set_title(SI if data["si"] else SPECIAL, loc="right", fontsize=sized(9))
    for region in data["regions"]:
        _region(axes, region)
    for locus in data["loci"]:
        axes.plot(*np.array(locus["curve"]).T, **thinner(_line_of(locus)), zorder=3)
    for locus in data["loci"]:
        for mark in locus["special"]:
            if mark["kind"] not in UNMARKED:
                axes.plot(*mark["at"], clip_on=False, **thinner(_mark_of(mark["kind"])))
    tidy(axes)
    _legend(figure, data)
    draw_shapes(axes, data, shapes, style)
    return figure


def _region(axes: Axes, region: Row) -> None:
    """Fill a region, its holes left out."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    rings = [np.array([*ring, ring[0]]) for ring in region["rings"]]
    codes = [
        [Outline.MOVETO, *[Outline.LINETO] * (len(ring) - 2), Outline.CLOSEPOLY] for ring in rings
    ]
    path = Outline(np.concatenate(rings), np.concatenate(codes))
    look = _fill_of(region["stable"])
    axes.add_patch(PathPatch(path, lw=0, zorder=1, **look))


def _fill_of(stable: int | None) -> dict[str, Any]:
    if stable is None:
        return dict(UNKNOWN)
    return {"fc": STABLE[min(stable, len(STABLE) - 1)], "ec": "none"}


def _line_of(locus: Row) -> dict[str, Any]:
    """Return how a locus is drawn: thin where no stable shape comes or goes."""
    look = LINES.get(locus["kind"], OTHER_LINE)
    return look | THIN if locus["changes"] is False else look


def _name_of(locus: Row) -> str:
    return f"{locus['kind']} of unstable shapes" if locus["changes"] is False else locus["kind"]


def _mark_of(kind: str) -> dict[str, Any]:
    return MARKS.get(kind, OTHER_MARK)


def _legend(figure: Figure, data: Mapping[str, Any]) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    counts = {region["stable"] for region in data["regions"]}
    known = sorted(count for count in counts if count is not None)
    handles: list[Any] = [
        Patch(label=_stable(count), lw=stroke(0.5), **(_fill_of(count) | {"ec": FAINT}))
        for count in known
    ]
    if None in counts:
        handles.append(Patch(label="not counted", lw=stroke(0.5), **UNKNOWN))
    kinds = {_name_of(locus): _line_of(locus) for locus in data["loci"]}
    handles += [Line2D([], [], label=name, **thinner(look)) for name, look in kinds.items()]
    marks = dict.fromkeys(mark["kind"] for locus in data["loci"] for mark in locus["special"])
    handles += [
        Line2D([], [], label=kind, **thinner(_mark_of(kind)))
        for kind in marks
        if kind not in UNMARKED
    ]
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=max(1, int(figure.get_figwidth() / spaced(1.9))),
        frameon=False,
        fontsize=sized(9),
    )


def _stable(count: int) -> str:
    return f"{count} stable shape{'s' * (count != 1)}" if count else "none stable"
