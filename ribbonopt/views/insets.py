"""Ribbons inside the diagram of a branch, each joined to its point by a thin line.

They stand where the diagram leaves most room; the axes are widened to have some.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.errors import ViewError
from ribbonopt.solution.solution import Solution

from .album import Album, album_of, place
from .branch_rows import BranchFigure
from .curves import Array
from .paper_style import Style, sized, stroke
from .style import FAINT, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST = 12  # ribbons in a diagram
LARGEST, LEAST = 0.34, 0.14  # of the axes: width and height of an inset
WIDER = 0.3  # of what is drawn: room above and below it
STEPS = 25  # places along each side that are tried
APART = 0.012  # of the axes: least room between insets, and between these and the frame
NUMBER = 0.07  # of the axes: room for a number to the left of an inset
CROSSED = 4.0  # what it costs to lie on one sample of a curve, in lengths of the axes
SAMPLES = 24  # of a line from an inset to its point
BELOW = 0.04  # of their size: room below ribbons
THIN = 0.55  # lines of ribbons, of the width of others


def draw_insets(
    axes: Axes, subject: BranchFigure, ribbons: Mapping[int, Solution], style: Style
) -> None:
    """Draw ribbons, by the numbers of their points, into the first panel of a branch.

    Raises
    ------
    ViewError
        If one of the points is not in that panel.
    """
    album = album_of(list(ribbons.values()), style)
    plane = subject.axes_of(subject.pairs[0])[0]
    rows = {row["number"]: row for row in plane.rows}
    if lacking := [number for number in ribbons if number not in rows]:
        raise ViewError(f"point {lacking[0]} is not in the first panel, it cannot be inset there")
    _make_room(axes)
    points = plane.points([rows[number] for number in ribbons])
    curves = [np.array(line.get_data(), float) for line in axes.lines]
    marks = _within(axes, points)
    taken = _samples([_within(axes, curve) for curve in curves if curve.shape[1]])
    size = _size(axes, album, len(ribbons))
    found, box = corners_of(marks, size, taken), album.box(BELOW)
    low, high = np.array([box.left, box.low]), np.array([box.right, box.high])
    for number, drawing, mark, corner in zip(
        ribbons, album.drawings, marks.T, found.T, strict=True
    ):
        inset = axes.inset_axes((*corner, *size), zorder=3)
        inset.patch.set_alpha(0.0)
        place(inset, drawing, box, THIN)
        inset.text(
            *(0.0, 0.5, f"{number} "),
            transform=inset.transAxes,
            fontsize=sized(8),
            color=INK,
            ha="right",
            va="center",
        )
        seen = drawing.corners.reshape(-1, 2)
        near = np.hypot(*(corner + size * (seen - low) / (high - low) - mark).T).argmin()
        line = {"arrowstyle": "-", "color": FAINT, "lw": stroke(0.6), "shrinkA": 0, "shrinkB": 0}
        axes.annotate(
            "",
            xy=tuple(mark),
            xycoords="axes fraction",
            xytext=tuple(seen[near]),
            textcoords=inset.transData,  # which the layout settles
            arrowprops=line,
        )
    if album.tint:
        album.tint.bar(axes.figure.axes)


def corners_of(marks: Array, size: Array, taken: Array) -> Array:
    """Return lower left corners (2, k) of insets: clear of curves and of each other, and near.

    Parameters
    ----------
    marks
        Points (2, k) that insets belong to, in shares of the axes.
    size
        Width and height (2,).
    taken
        Points (2, m) that insets rather do not lie on.
    """
    begins = (NUMBER, APART)
    sides = [np.linspace(b, 1 - APART - s, STEPS) for b, s in zip(begins, size, strict=True)]
    corners = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
    inside = (taken.T > corners[:, None]) & (taken.T < corners[:, None] + size)
    covered = inside.all(axis=2).sum(axis=1).astype(float)
    found: list[Array] = []
    ways: list[Array] = []
    # Those with least room around them choose first.
    room = [np.hypot(*(taken - mark[:, None])).mean() for mark in marks.T]
    for k in np.argsort(room):
        mark = marks[:, k]
        near = np.clip(mark, corners, corners + size)
        cost = np.hypot(*(near - mark).T) + CROSSED * covered
        for other in found:
            apart = np.abs(corners - other) >= size + APART
            cost += 1e6 * ~apart.any(axis=1)
        for way in ways:
            over = (way > corners[:, None]) & (way < corners[:, None] + size)
            cost += CROSSED * over.all(axis=2).sum(axis=1)
        best = corners[int(cost.argmin())]
        found.append(best)
        share = np.linspace(0, 1, SAMPLES)[:, None]
        ways.append(mark + share * (near[int(cost.argmin())] - mark))
    order = np.argsort(np.argsort(room))
    return np.stack([found[i] for i in order], axis=1)


def _make_room(axes: Axes) -> None:
    """Widen the axes up and down, in the scale that they have."""
    scale = axes.yaxis.get_transform()
    low, high = scale.transform(np.array(axes.get_ylim()))
    more = WIDER * (high - low)
    axes.set_ylim(*scale.inverted().transform(np.array([low - more, high + more])))


def _within(axes: Axes, points: Array) -> Array:
    """Return points (2, k) in shares of the axes."""
    axes.get_xlim()  # which is settled only now
    pixels = axes.transData.transform(points.T)
    return np.asarray(axes.transAxes.inverted().transform(pixels).T)


def _samples(curves: Sequence[Array]) -> Array:
    """Return points (2, m) close together along curves (2, k)."""
    found = [np.empty((2, 0))]
    for curve in curves:
        known = curve[:, np.isfinite(curve).all(axis=0)]
        found.append(known)
        for a, b in zip(known.T[:-1], known.T[1:], strict=True):
            count = int(np.hypot(*(b - a)) / APART)
            found.append(np.linspace(a, b, count + 2)[1:-1].T)
    return np.concatenate(found, axis=1)


def _size(axes: Axes, album: Album, count: int) -> Array:
    """Return width and height (2,) of insets, in shares of the axes."""
    box = album.box(BELOW)
    tall = (box.high - box.low) / (box.right - box.left)
    frame = axes.get_position()
    page = axes.figure.bbox
    shape = frame.height * page.height / (frame.width * page.width)
    largest = np.clip(LARGEST * np.sqrt(4 / max(count, 4)), LEAST, LARGEST)
    size = np.array([1.0, tall / shape])
    return np.asarray(size * largest / max(float(size.max()), 1.0))
