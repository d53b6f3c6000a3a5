"""Figure: the path in the (u2, u3) plane, and the region |eta| > 1 forbidden to Sadowsky."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.solution.solution import Solution

from .paper_style import PLAIN, USUAL, Style, sized, stroke
from .pieces import Piece
from .style import ALLOWED, BENDING, DASHES, FAINT, FORBIDDEN, INK, blank, head, tidy
from .subject import Subject, subject_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


WIDTH, TITLE = 6.6, 0.3  # inches
STRAIGHT = 1e-9  # largest strain, times L, of a ribbon that counts as straight


def plot_plane(solution: Solution, complete: bool = True, style: Style = PLAIN) -> Figure:
    """Plot u3 against u2, allowed and forbidden regions shaded, start and end marked.

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
        return draw_plane(subject_of(solution, complete), style)


def draw_plane(subject: Subject, style: Style = PLAIN) -> Figure:
    """Plot the path in the plane; a jump between pieces is dotted.

    Raises
    ------
    ViewError
        Where the ribbon bends in its own plane, too, and this plane does not tell.
    """
    subject.demand_generatrices()
    pieces = subject.pieces
    (left, right), (low, high) = _limits(pieces, subject.units.strain)
    shape = (high - low) / (right - left)
    width, columns = style.width or WIDTH, 1 if style.narrow else 2
    words = (1.3 if columns == 2 else 1.0) + 0.25 * (4 + bool(subject.mirrored)) / columns
    words -= 0 if style.titles else TITLE
    figure = blank(width, words * style.type_size / USUAL + 5.6 / WIDTH * width * shape, style)
    axes = figure.add_subplot()
    far = 2 * max(-left, right, -low, high)
    if subject.across:
        from .natural import shade_natural  # few ribbons have natural strains

        shade_natural(axes, far, subject.across)
    elif subject.across == 0:
        _shade(axes, far)
    for piece in pieces:
        line = DASHES if piece.mirrored else "-"
        axes.plot(piece.u2, piece.u3, color=BENDING, lw=stroke(1.8), ls=line, zorder=3)
    tolerance = 0.01 * (right - left)
    for a, b in pairwise(pieces):
        jump = [[a.u2[-1], b.u2[0]], [a.u3[-1], b.u3[0]]]
        if abs(jump[0][1] - jump[0][0]) > tolerance:
            axes.plot(*jump, color=FAINT, lw=stroke(1.3), ls=":", zorder=2)
    (start, end), metres = subject.interval, " m" if subject.units.si else ""
    for piece, row, marker, size, fill, label in (
        (subject.solved[0], 0, "o", 6, BENDING, f"start, $s = {start:.4g}${metres}"),
        (subject.solved[-1], -1, "s", 10, "none", f"end, $s = {end:.4g}${metres}"),
    ):
        axes.plot(
            piece.u2[row],
            piece.u3[row],
            marker,
            ms=stroke(size),
            mfc=fill,
            mec=BENDING,
            mew=stroke(1.6),
            zorder=4,
            ls="none",
            label=label,
        )
    if subject.mirrored:
        axes.plot([], [], color=BENDING, lw=stroke(1.8), ls=DASHES, label=subject.rest)
    axes.set(xlim=(left, right), ylim=(low, high), aspect="equal")
    axes.set_xlabel(subject.label(r"bending strain $u_2$", "1/m"))
    axes.set_ylabel(subject.label(r"twisting strain $u_3$", "1/m"))
    head(axes, subject.name, subject.units)
    look = {"ncols": columns, "frameon": False, "fontsize": sized(9)}
    look |= {"labelspacing": 0.3} if style.narrow else {}
    figure.legend(loc="outside lower center", **look)
    tidy(axes)
    return figure


def _shade(axes: Axes, far: float) -> None:
    """Two wedges each: |u3| <= |u2| allowed, |u3| > |u2| forbidden."""
    for sign in (-1, 1):
        x, y = [0, sign * far, sign * far], [0, far, -far]
        for corners, colour, label in (
            ((x, y), ALLOWED, r"$|\eta| \leq 1$, allowed"),
            ((y, x), FORBIDDEN, r"$|\eta| > 1$, forbidden to Sadowsky's ribbon"),
        ):
            axes.fill(*corners, color=colour, lw=0, zorder=0, label=label if sign > 0 else None)
        axes.plot([-far, far], [-sign * far, sign * far], color=FAINT, lw=stroke(0.6), zorder=1)
    axes.axhline(0, color=INK, lw=stroke(0.5), zorder=1)
    axes.axvline(0, color=INK, lw=stroke(0.5), zorder=1)


def _limits(
    pieces: tuple[Piece, ...], unit: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits around the path and the origin: not flatter than 1 : 2, not steeper than 1 : 1."""
    u2 = np.concatenate([[0.0], *(p.u2 for p in pieces)])
    u3 = np.concatenate([[0.0], *(p.u3 for p in pieces)])
    size = max(np.ptp(u2), np.ptp(u3)) * 1.16
    size = size if size > STRAIGHT * unit else unit
    middle = [(v.min() + v.max()) / 2 for v in (u2, u3)]
    half = [max(size, np.ptp(u2) * 1.16) / 2, max(size / 2, np.ptp(u3) * 1.16) / 2]
    (a, b), (p, q) = middle, half
    return (float(a - p), float(a + p)), (float(b - q), float(b + q))
