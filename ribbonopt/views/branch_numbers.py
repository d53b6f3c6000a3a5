"""Numbers beside the points of a branch whose ribbons are pictured elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from .branch_rows import Plane
from .curves import Array
from .paper_style import sized, stroke
from .style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CLOSE = 0.03  # of the axes: numbers this near to each other stand together
ASIDE = 6  # points of a number from its own point
REACH = np.array([0.035, 0.05])  # of the axes: where its middle is then
BORDER = 0.03  # of the axes: numbers further out stand on their frame
DIGIT = np.array([0.01, 0.0])  # of the axes: half the width of a digit


def write_numbers(
    axes: Axes, plane: Plane, numbered: Sequence[int], curves: Sequence[Array]
) -> None:
    """Write the numbers of points beside them, where there is most room; of one place together.

    Parameters
    ----------
    axes
        Where.
    plane
        Its points.
    numbered
        The numbers.
    curves
        What is drawn already, (2, k) each.
    """
    from matplotlib.patheffects import withStroke

    chosen = [row for row in plane.rows if row["number"] in numbered]
    if not chosen:
        return
    places = plane.scaled(plane.points(chosen))
    taken = plane.scaled(np.concatenate([*curves, plane.points(plane.rows)], axis=1))
    for group in _groups(places):
        text = ", ".join(str(chosen[i]["number"]) for i in group)
        here = places[:, group[0]]
        x, y = max(product((1, -1), (1, -1)), key=lambda way: _room(here, way, text, taken))
        taken = np.column_stack([taken, _middle(here, (x, y), text)])
        axes.annotate(
            text,
            tuple(plane.points([chosen[group[0]]])[:, 0]),
            (ASIDE * x, ASIDE * y),
            textcoords="offset points",
            ha="left" if x > 0 else "right",
            va="bottom" if y > 0 else "top",
            fontsize=sized(8),
            color=INK,
            path_effects=[withStroke(linewidth=stroke(2.5), foreground="white")],
            zorder=7,
        )


def _groups(places: Array) -> list[list[int]]:
    """Return the indices of places (2, k), those that are close to each other together."""
    groups: list[list[int]] = []
    for i, place in enumerate(places.T):
        near = (group for group in groups if np.hypot(*(place - places[:, group[0]])) < CLOSE)
        group = next(near, None)
        if group is None:
            groups.append([i])
        else:
            group.append(i)
    return groups


def _middle(here: Array, way: tuple[int, int], text: str) -> Array:
    """Return where the middle of a text is, on one side of a place."""
    return np.asarray(here + way * (REACH + (len(text) - 2) * DIGIT))


def _room(here: Array, way: tuple[int, int], text: str, taken: Array) -> float:
    """Return how far a text on one side of a place is from all that is drawn, and from outside."""
    middle = _middle(here, way, text)
    gaps = (taken - middle[:, None]) / (REACH + len(text) * DIGIT)[:, None]
    outside = float(np.max([-middle, middle - 1], initial=0.0))
    return min(float(np.hypot(*gaps).min()), 2.0) - 20 * max(outside - BORDER, 0.0)
