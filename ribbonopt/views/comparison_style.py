"""How a comparison looks: colours and markers of transcriptions and formulations, the legend."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any, NamedTuple

from ribbonopt.plain import Rows
from ribbonopt.text import drawn

from .style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

COLOURS = ("#1f5fa8", "#c2410c", "#2f7d32", "#7b3fa0", "#8a6d00", "#0e7490", "#be185d", "#444444")
MARKERS = "osD^vP*X"
STATES: dict[str, Any] = {"reduced": "-", "full": (0, (3, 1.5))}
PEERS = ("#7a0019", "#00606b", "#9a5b00", "#5a5a5a", "#b0006d", "#3c3c8c")
BAND: dict[str, Any] = {"color": "#c9c9c9", "lw": 7, "solid_capstyle": "round", "zorder": 0.5}


class Look(NamedTuple):
    """Colour and marker."""

    color: str
    marker: str


def looks(rows: Rows, key: str) -> dict[Any, Look]:
    """Return a look for everything that rows say under a key, in their order."""
    names = dict.fromkeys(row[key] for row in rows)
    return dict(zip(names, map(Look, cycle(COLOURS), cycle(MARKERS)), strict=False))


def legend_of(figure: Figure | SubFigure, place: Axes | None, rows: Rows) -> None:
    """Explain transcriptions, states and frontiers: in axes that are left, or below all."""
    from matplotlib.lines import Line2D

    handles: list[Line2D] = []
    labels: list[str] = []
    for name, (colour, marker) in looks(rows, "transcription").items():
        handles.append(Line2D([], [], color=colour, marker=marker, lw=1, ms=5))
        labels.append(drawn(name))
    states = [name for name in STATES if any(row["states"] == name for row in rows)]
    if len(states) > 1:
        handles += [Line2D([], [], color=INK, ls=STATES[name], lw=1) for name in states]
        labels += [f"{name} states" for name in states]
    handles += [Line2D([], [], color=INK, lw=2.0), Line2D([], [], **BAND)]
    labels += ["frontier of the panel", "frontier of all pairs"]
    words: dict[str, Any] = {"frameon": False, "fontsize": 9, "labelcolor": INK}
    if place is not None:
        place.legend(handles, labels, loc="center left", handlelength=3, **words)
    else:
        columns = min(len(handles), 5)
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, **words)
