"""Figure: the strains u2(s), u3(s) and their ratio eta(s)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.solution.solution import Solution

from .pieces import Array, Piece
from .style import ALLOWED, BENDING, DASHES, FORBIDDEN, INK, RATIO, TWIST, blank, head, tidy
from .subject import Subject, subject_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ETA_SHOWN = 1.6


def plot_strains(solution: Solution, complete: bool = True) -> Figure:
    """Plot u2, u3 and eta against s.

    Parameters
    ----------
    solution
        What to draw.
    complete
        Add, dashed, the rest of a band of which this solution is a piece by symmetry.
    """
    return draw_strains(subject_of(solution, complete))


def draw_strains(subject: Subject) -> Figure:
    """Plot strains; lines break where a piece ends."""
    figure = blank(7.2, 5.0)
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(2.4, 1))
    for axes, quantity, colour, label in (
        (top, "u2", BENDING, r"$u_2$ (bending)"),
        (top, "u3", TWIST, r"$u_3$ (twist)"),
        (bottom, "eta", RATIO, r"$\eta$"),
    ):
        axes.plot(*_joined(subject.solved, quantity), color=colour, lw=1.8, label=label)
        if subject.mirrored:
            axes.plot(*_joined(subject.mirrored, quantity), color=colour, lw=1.5, ls=DASHES)
    top.axhline(0, color=INK, lw=0.6, zorder=0)
    if subject.mirrored:
        top.plot([], [], color=INK, lw=1.5, ls=DASHES, label=subject.rest)
    _label(top, bottom, subject)
    return figure


def _label(top: Axes, bottom: Axes, subject: Subject) -> None:
    head(top, subject.name, subject.units, pad=26)
    top.set_ylabel(subject.label(r"strains $u_2,\ u_3$", "1/m"))
    top.legend(loc="lower left", bbox_to_anchor=(0, 1.0, 1, 0), ncols=3, frameon=False, fontsize=9)
    bottom.axhspan(-1, 1, color=ALLOWED, lw=0, zorder=0)
    for sign in (-1, 1):
        bottom.axhspan(sign, 2 * sign * ETA_SHOWN, color=FORBIDDEN, lw=0, zorder=0)
    bottom.set_ylim(-ETA_SHOWN, ETA_SHOWN)
    bottom.set_yticks([-1, 0, 1])
    bottom.set_ylabel(r"$\eta = u_3/u_2$")
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
