"""Figure: the strains u2(s), u3(s) and their ratio eta(s); of a rod u1(s) in the place of that."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.solution.solution import Solution

from .paper_style import NARROW, PAGE, PLAIN, Style, sized, spaced, stroke
from .pieces import Array, Piece, in_plane
from .style import (
    ALLOWED,
    BENDING,
    DASHES,
    FAINT,
    FORBIDDEN,
    IN_PLANE,
    INK,
    RATIO,
    TWIST,
    blank,
    head,
    tidy,
)
from .subject import Subject, subject_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ETA_SHOWN, ETA_MOST = 1.6, 5.0
LETTER = 0.011  # of the length shown: a letter of a name
LINES: Mapping[str, tuple[str, str]] = {
    "u1": (IN_PLANE, r"$u_1$ (in plane)"),
    "u2": (BENDING, r"$u_2$ (bending)"),
    "u3": (TWIST, r"$u_3$ (twist)"),
    "eta": (RATIO, r"$\eta$"),
}


def plot_strains(solution: Solution, complete: bool = True, style: Style = PLAIN) -> Figure:
    """Plot u2, u3 and eta against s; u1, u2 and u3 where u1 is free.

    Parameters
    ----------
    solution
        What to draw.
    complete
        Add, dashed, the rest of a band of which this solution is a piece by symmetry.
    style
        Size and type.
    """
    with style.applied():
        return draw_strains(subject_of(solution, complete), style)


def draw_strains(subject: Subject, style: Style = PLAIN) -> Figure:
    """Plot strains; lines break where a piece ends."""
    figure = blank(PAGE, 5.0, style)
    if subject.rod:
        axes = figure.add_subplot()
        _plot(axes, subject, ("u1", "u2", "u3"))
        _label(axes, axes, subject, r"strains $u_1,\ u_2,\ u_3$")
        return figure
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(2.4, 1))
    edgewise = ("u1",) if in_plane(subject.solved) > 0 else ()
    _plot(top, subject, (*edgewise, "u2", "u3"))
    _plot(bottom, subject, ("eta",))
    if subject.across == 0:
        _shade(bottom)
    else:
        _limit(bottom, subject)
    bottom.set_ylabel(r"$\eta = u_3/u_2$")
    strains = r"strains $u_1,\ u_2,\ u_3$" if edgewise else r"strains $u_2,\ u_3$"
    _label(top, bottom, subject, strains)
    return figure


def _plot(axes: Axes, subject: Subject, quantities: tuple[str, ...]) -> None:
    for quantity in quantities:
        colour, label = LINES[quantity]
        axes.plot(*_joined(subject.solved, quantity), color=colour, lw=stroke(1.8), label=label)
        if subject.mirrored:
            axes.plot(*_joined(subject.mirrored, quantity), color=colour, lw=stroke(1.5), ls=DASHES)


def _mark(axes: Axes, places: Mapping[float, str]) -> None:
    """Mark where something acts at a single place."""
    for s in places:
        axes.axvline(s, color=FAINT, lw=stroke(0.7), zorder=0)


def _name(axes: Axes, places: Mapping[float, str], length: float, below: bool) -> None:
    """Write the names of single places, as the scene has them, below or in axes, in free rows."""
    row_height, crowding = sized(9), PAGE / _width(axes) * sized(7.5) / 7.5
    taken: list[float] = []  # where the last name of each row is
    for s, name in places.items():
        room = LETTER * length * len(name) * crowding
        row = next((i for i, last in enumerate(taken) if s - last > room), len(taken))
        taken[row : row + 1] = [s]
        axes.annotate(
            name,
            (s, 0),
            (0, -4 - row_height * row if below else 3 + row_height * row),
            xycoords=axes.get_xaxis_transform(),
            textcoords="offset points",
            ha="center",
            va="top" if below else "bottom",
            fontsize=sized(7.5),
            color=FAINT,
        )


def _width(axes: Axes) -> float:
    """Return the width of the page (inches)."""
    return float(axes.figure.bbox.width / axes.figure.dpi)


def _shade(axes: Axes) -> None:
    """Shade what is allowed of eta, and what is not."""
    axes.axhspan(-1, 1, color=ALLOWED, lw=0, zorder=0)
    for sign in (-1, 1):
        axes.axhspan(sign, 2 * sign * ETA_SHOWN, color=FORBIDDEN, lw=0, zorder=0)
    axes.set_ylim(-ETA_SHOWN, ETA_SHOWN)
    axes.set_yticks([-1, 0, 1])


def _limit(axes: Axes, subject: Subject) -> None:
    """Show eta up to some size: natural strains allow any."""
    largest = max(float(np.abs(piece.eta).max()) for piece in subject.pieces)
    shown = min(max(1.1 * largest, ETA_SHOWN), ETA_MOST)
    axes.axhline(0, color=INK, lw=stroke(0.6), zorder=0)
    axes.set_ylim(-shown, shown)


def _label(top: Axes, bottom: Axes, subject: Subject, strains: str) -> None:
    """Label the strains above, the arclength below; mark places."""
    places = subject.acting.places
    for axes in dict.fromkeys((top, bottom)):
        _mark(axes, places)
    _name(top, places, subject.length, below=top is not bottom)
    top.axhline(0, color=INK, lw=stroke(0.6), zorder=0)
    if subject.mirrored:
        top.plot([], [], color=INK, lw=stroke(1.5), ls=DASHES, label=subject.rest)
    count = len(top.get_legend_handles_labels()[0])
    columns = 4 if _width(top) >= NARROW else 2
    rows = -(-count // columns)
    head(top, subject.name, subject.units, pad=spaced(10 + 16 * rows))
    top.set_ylabel(subject.label(strains, "1/m"))
    look = {"frameon": False, "fontsize": sized(9), "columnspacing": 1.4}
    look |= {"handlelength": 1.4, "columnspacing": 1.0} if _width(top) < NARROW else {}
    top.legend(loc="lower left", bbox_to_anchor=(0, 1.0, 1, 0), ncols=columns, **look)
    bottom.set_xlabel(subject.label(r"arclength $s$", "m"))
    bottom.set_xlim(subject.interval[0], subject.end)
    for axes in (top, bottom):
        tidy(axes)


def _joined(pieces: tuple[Piece, ...], quantity: str) -> tuple[Array, Array]:
    """Rows of one quantity, with a row of NaN after each piece to break the line there."""
    gap = [np.nan]
    x = np.concatenate([part for p in pieces for part in (p.s, gap)])
    y = np.concatenate([part for p in pieces for part in (getattr(p, quantity), gap)])
    return x, y
