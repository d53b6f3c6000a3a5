"""The figure of a study of branches: where special points are, against what was swept.

Along x is the first number that was swept; a line joins special points of the same place in the
order of their branches, where all that is swept besides is of the same kind: `{type: sano, ...}` is
of the kind sano whatever its numbers. What has most kinds has colours, the others have panels.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ribbonopt.classes import dataclass
from ribbonopt.plain import SPECIALS, Row, Rows, is_number
from ribbonopt.text import drawn

from .branch_style import COLOURS, STYLES, mark_of
from .columns import is_logarithmic, is_numeric, numbers, words
from .paper_style import PLAIN, Style, sized, spaced, stroke, thinner
from .style import FAINT, INK, blank, tidy
from .symbols import symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SCENE, NONE = "scene", "none"
WIDTH, HEIGHT = 3.6, 3.2  # inches of a panel
Place = tuple[float | None, float, str]  # x, if any; value; which kind of special point


@dataclass(frozen=True)
class _Axes:
    """What the figure has along x, by colour, down and across; "" for nothing."""

    x: str
    colour: str
    down: str
    across: str


def plot_special(
    rows: Rows,
    inputs: Sequence[str],
    labels: Mapping[str, str] = MappingProxyType({}),
    style: Style = PLAIN,
) -> Figure:
    """Draw the values at special points against the first number that was swept.

    A branch for which that number is not given has a level line.
    """
    rows = [row for row in rows if row.get(SPECIALS)]
    axes = _chosen(rows, inputs)
    kinds = [_kinds(rows, name) for name in (axes.down, axes.across)]
    colours = dict(zip(_kinds(rows, axes.colour), _repeated(COLOURS), strict=False))
    count, across = (len(each) for each in kinds)
    figure = blank(WIDTH * across + 1.0, HEIGHT * count + 0.6, style)
    panels = figure.subplots(count, across, squeeze=False, sharex=True, sharey="row")
    for panel, (down, beside) in zip(panels.flat, product(*kinds), strict=True):
        mine = [r for r in rows if (_kind(r, axes.down), _kind(r, axes.across)) == (down, beside)]
        for kind, colour in colours.items():
            _draw(panel, [r for r in mine if _kind(r, axes.colour) == kind], axes.x, colour)
        names = [drawn(word) for word in (down, _titled(axes.across, beside)) if word]
        panel.set_title(", ".join(names), fontsize=sized(9), color=INK, loc="left")
        panel.grid(True, color=FAINT, alpha=0.2)
        tidy(panel)
    if is_logarithmic(numbers(rows, axes.x)):
        panels[0, 0].set_xscale("log")
    for panel in panels[-1]:
        panel.set_xlabel(symbol(axes.x, labels))
    for panel in panels[:, 0]:
        panel.set_ylabel(", ".join(symbol(name, labels) for name in _parameters(rows)))
    _legend(figure, rows, colours)
    return figure


def _chosen(rows: Rows, inputs: Sequence[str]) -> _Axes:
    swept = [key for key in inputs if is_numeric(rows, key)]
    others = [key for key in inputs if key not in swept and len(_kinds(rows, key)) > 1]
    others.sort(key=lambda key: -len(_kinds(rows, key)))
    scenes = [SCENE] if len(words(rows, SCENE)) > 1 else []
    colour, across, *_ = [*others, *([] if others else scenes), "", ""]
    down = scenes[0] if scenes and colour != SCENE else ""
    return _Axes((swept or ["number"])[0], colour, down, across)


def _draw(axes: Axes, rows: Rows, x: str, colour: str) -> None:
    """Draw lines through special points of the same place, and marks for what kind they are."""
    most = max((len(row[SPECIALS]) for row in rows), default=0)
    for i in range(most):
        places = [place for row in rows if (place := _place(row, x, i))]
        known = sorted((at, value, kind) for at, value, kind in places if at is not None)
        if known:
            axes.plot([p[0] for p in known], [p[1] for p in known], color=colour, lw=stroke(1.4))
        for where, value, kind in known:
            axes.plot(where, value, **thinner(STYLES[kind] | {"mec": colour, "ms": 6}))
        for at, value, _ in places:
            if at is None:
                axes.axhline(value, color=colour, lw=stroke(1.2), ls=(0, (5, 2)))


def _place(row: Row, x: str, i: int) -> Place | None:
    """Return where the special point of a place in the order of a branch is, None for none."""
    if i >= len(row[SPECIALS]):
        return None
    point = row[SPECIALS][i]
    value, at = point[point["parameter"]], row.get(x)
    if not is_number(value):
        return None
    return at if is_number(at) else None, value, mark_of(point)


def _legend(figure: Figure, rows: Rows, colours: Mapping[str, str]) -> None:
    from matplotlib.lines import Line2D

    lines = {drawn(kind): {"color": colour, "lw": 2} for kind, colour in colours.items() if kind}
    marks = dict.fromkeys(mark_of(point) for row in rows for point in row[SPECIALS])
    entries: dict[str, dict[str, Any]] = lines | {mark: STYLES[mark] for mark in marks}
    handles = [Line2D([], [], label=text, **thinner(style)) for text, style in entries.items()]
    count = max(1, int(figure.get_figwidth() / spaced(1.6)))
    figure.legend(
        handles=handles, loc="outside lower center", ncols=count, frameon=False, fontsize=sized(9)
    )


def _parameters(rows: Rows) -> list[str]:
    """Return the names of the numbers that move along the branches."""
    return list(dict.fromkeys(point["parameter"] for row in rows for point in row[SPECIALS]))


def _kinds(rows: Rows, name: str) -> list[str]:
    """Return the kinds of a column, each once; one without a name for no column."""
    return list(dict.fromkeys(_kind(row, name) for row in rows))


def _kind(row: Row, name: str) -> str:
    """Return what a value is without its numbers: its type, or the names of what it says."""
    value = row.get(name)
    if not name or value is None:
        return NONE if name else ""
    if isinstance(value, Mapping):
        return str(value.get("type", ", ".join(value)))
    return str(value)


def _titled(name: str, kind: str) -> str:
    return f"{name}: {kind}" if name else ""


def _repeated(colours: Sequence[str]) -> Iterator[str]:
    while True:
        yield from colours
