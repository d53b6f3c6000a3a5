"""Names of points in a figure: none on another, on a point that is named, or beyond its axes.

Names stand near their points, with a thin line to those that had to go further; where there is no
room at all a name is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ribbonopt.arrays import Array

from .style import FAINT, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.backend_bases import RendererBase
    from matplotlib.figure import Figure
    from matplotlib.text import Text

# Directions of the compass from which a name is looked for, in the order they are liked: below a
# frontier there is room.
DIRECTIONS = ((1, -1), (0, -1), (1, 0), (-1, 1), (0, 1), (-1, -1), (1, 1), (-1, 0))
REACHES = (3.0, 9.0, 16.0, 24.0, 33.0, 43.0, 54.0, 66.0)  # points from a point to its name
NEAR = 9.0  # points up to which a name needs no line
GAP = 1.5  # points between names
CROSSED = 4.0  # what it costs a name, in points of reach, to stand on one sample of a line
SAMPLES = 24  # of every segment of a line


class Box(NamedTuple):
    """A rectangle in pixels."""

    left: float
    bottom: float
    right: float
    top: float

    def overlaps(self, other: Box) -> bool:
        """Whether two rectangles have an area in common."""
        apart = self.right <= other.left or other.right <= self.left
        return not (apart or self.top <= other.bottom or other.top <= self.bottom)

    def within(self, other: Box) -> bool:
        """Whether it is a part of another."""
        low = other.left <= self.left and other.bottom <= self.bottom
        return low and self.right <= other.right and self.top <= other.top

    def holds(self, points: Array) -> int:
        """Count the points (k, 2) inside."""
        x, y = points.T
        inside = (self.left < x) & (x < self.right) & (self.bottom < y) & (y < self.top)
        return int(np.count_nonzero(inside))

    def wider(self, by: float) -> Box:
        """Return it with a margin."""
        return Box(self.left - by, self.bottom - by, self.right + by, self.top + by)


class Name(NamedTuple):
    """What to write at a point (data of the axes), and how."""

    text: str
    at: tuple[float, float]
    colour: str = INK
    bold: bool = False


Names = dict["Axes", list[Name]]


def write_all(figure: Figure, names: Names) -> None:
    """Write names into axes, where the layout has put these: it is final then."""
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for axes, some in names.items():
        if some:
            write_names(axes, some)


def places(
    anchors: Sequence[tuple[float, float]],
    sizes: Sequence[tuple[float, float]],
    inside: Box,
    lines: Array,
    scale: float = 1.0,
    mark: float = 4.0,
) -> list[Box | None]:
    """Find a rectangle for every name, the first names first; None where there is no room.

    Parameters
    ----------
    anchors, sizes
        Points that are named, and widths and heights of the names, in pixels.
    inside
        What no name leaves.
    lines
        Points (k, 2) that names rather stand beside.
    scale
        Pixels of a point of type.
    mark
        Half the width of what is drawn at an anchor, in points.
    """
    marks = [Box(x, y, x, y).wider(mark * scale) for x, y in anchors]
    taken: list[Box] = []
    leads: list[Array] = []
    found: list[Box | None] = []
    for (x, y), size in zip(anchors, sizes, strict=True):
        best, least = None, np.inf
        for reach, (dx, dy) in product(REACHES, DIRECTIONS):
            if reach >= least:
                break
            box = _beside(x, y, dx, dy, size, (reach + mark) * scale)
            margin, lead = box.wider(GAP * scale), _lead(x, y, box)
            free = not any(margin.overlaps(other) for other in (*taken, *marks))
            free = free and box.within(inside) and not any(margin.holds(line) for line in leads)
            if free and not any(other.holds(lead) for other in taken):
                cost = reach + CROSSED * margin.holds(lines)
                if cost < least:
                    best, least = box, cost
        found.append(best)
        if best is not None:
            taken.append(best)
            leads.append(_lead(x, y, best))
    return found


def write_names(axes: Axes, names: Sequence[Name], size: float = 7.5) -> None:
    """Write names beside their points."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    part: Any = axes.figure
    figure = part.figure  # the whole of which it may be a part, in any version of matplotlib
    scale = figure.dpi / 72
    canvas: Any = FigureCanvasAgg(figure)
    renderer = canvas.get_renderer()
    anchors = [(float(x), float(y)) for x, y in axes.transData.transform([n.at for n in names])]
    sizes = [_size(axes, name, size, renderer) for name in names]
    inside = Box(*axes.bbox.extents).wider(-2 * scale)
    found = places(anchors, sizes, inside, _samples(axes), scale)
    back = axes.transData.inverted()
    for name, (x, y), box in zip(names, anchors, found, strict=True):
        if box is None:
            continue
        middle = back.transform(((box.left + box.right) / 2, (box.bottom + box.top) / 2))
        _text(axes, name, size, (float(middle[0]), float(middle[1])))
        near = min(max(x, box.left), box.right), min(max(y, box.bottom), box.top)
        if np.hypot(near[0] - x, near[1] - y) > (NEAR + 4.0) * scale:
            ends = back.transform([(x, y), near])
            axes.plot(*ends.T, color=FAINT, lw=0.6, zorder=4, label="_lead")


def _text(axes: Axes, name: Name, size: float, at: tuple[float, float]) -> Text:
    from matplotlib.patheffects import withStroke

    return axes.text(
        *at,
        name.text,
        fontsize=size,
        color=name.colour,
        fontweight="bold" if name.bold else "normal",
        ha="center",
        va="center",
        zorder=6,
        path_effects=[withStroke(linewidth=2.0, foreground="white", alpha=0.85)],
    )


def _size(axes: Axes, name: Name, size: float, renderer: RendererBase) -> tuple[float, float]:
    text = _text(axes, name, size, name.at)
    extent = text.get_window_extent(renderer)
    text.remove()
    return extent.width, extent.height


def _samples(axes: Axes) -> Array:
    """Points along all lines of axes, in pixels."""
    points = [np.zeros((0, 2))]
    for line in axes.lines:
        corners = axes.transData.transform(np.column_stack(line.get_data()).astype(float))
        points.append(corners)
        points += [np.linspace(*ends, SAMPLES) for ends in pairwise(corners)]
    return np.concatenate(points)


def _beside(x: float, y: float, dx: int, dy: int, size: tuple[float, float], reach: float) -> Box:
    width, height = size
    left = x + (reach if dx > 0 else -reach - width if dx < 0 else -width / 2)
    bottom = y + (reach if dy > 0 else -reach - height if dy < 0 else -height / 2)
    return Box(left, bottom, left + width, bottom + height)


def _lead(x: float, y: float, box: Box) -> Array:
    """Points on the line from a point to its name."""
    near = min(max(x, box.left), box.right), min(max(y, box.bottom), box.top)
    return np.linspace((x, y), near, SAMPLES)
