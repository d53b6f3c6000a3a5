"""Small pictures of stable shapes inside a map, and how many shapes there are in all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from .album import Album, album_of, place
from .curves import Array
from .map_places import Inside, places_of, samples_of
from .paper_style import Style, sized, stroke
from .style import FAINT, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

MOST = 4  # shapes pictured in one region
LARGEST, LEAST = 0.17, 0.085  # of the axes: width or height of one picture
ROOM = 2.2  # of the distance to the nearest locus: pictures fit into that
WORDS = 0.045  # of the axes: height of words below pictures
WIDE = 0.115  # and their width
BELOW = 0.05  # of their size: room below ribbons
THIN = 0.5  # lines of ribbons, of the width of others


def draw_shapes(
    axes: Axes, data: Mapping[str, Any], shapes: Mapping[int, Sequence[Solution]], style: Style
) -> None:
    """Draw the stable shapes at counted points beside these, and say how many there are."""
    points = [
        point for point in data["points"] if point["verified"] and shapes.get(point["number"])
    ]
    if not points:
        return
    clear = {region["number"]: region["clear"] for region in data["regions"]}
    points.sort(key=lambda point: clear.get(point["region"], 0.0))
    shown = {point["number"]: list(shapes[point["number"]])[:MOST] for point in points}
    album = album_of([one for point in points for one in shown[point["number"]]], style)
    marks = np.array([_share(point["at"], data) for point in points])
    one = _size(axes, album)
    scales = [_scale(one, len(shown[p["number"]]), clear.get(p["region"], 0.0)) for p in points]
    sizes = [
        np.array([max(s * one[0] * len(shown[p["number"]]), WIDE), s * one[1] + WORDS])
        for s, p in zip(scales, points, strict=True)
    ]
    lines = [np.array([_share(at, data) for at in locus["curve"]]) for locus in data["loci"]]
    regions = {region["number"]: _inside_of(region, data) for region in data["regions"]}
    inside = [regions[point["region"]] for point in points]
    corners = places_of(marks, sizes, samples_of(lines), inside)
    drawings = iter(album.drawings)
    for point, corner, size, mark in zip(points, corners, sizes, marks, strict=True):
        count = len(shown[point["number"]])
        width = size[0] / count
        for k in range(count):
            box = (corner[0] + k * width, corner[1] + WORDS, width, size[1] - WORDS)
            inset = axes.inset_axes(box, zorder=4)
            inset.patch.set_alpha(0.0)
            place(inset, next(drawings), album.box(BELOW), THIN)
        _words(axes, point, corner, size)
        away = bool((np.clip(mark, corner, corner + size) != mark).any())
        if away or not regions[point["region"]]((corner + size / 2)[None])[0]:
            _card(axes, corner, size)
        _join(axes, mark, corner, size)
    if album.tint:
        album.tint.bar(axes.figure.axes)


def _words(axes: Axes, point: Row, corner: Array, size: Array) -> None:
    stable, count = point["stable"], point["count"]
    text = f"{stable} stable of {count}" if count > 1 else "1 stable" if stable else "1, unstable"
    axes.text(
        float(corner[0] + size[0] / 2),
        float(corner[1] + WORDS / 2),
        text,
        transform=axes.transAxes,
        ha="center",
        va="center",
        fontsize=sized(7.5),
        color=INK,
        zorder=5,
    )


def _card(axes: Axes, corner: Array, size: Array) -> None:
    """Put what stands away from its point on a card, to which a line leads."""
    from matplotlib.patches import Rectangle

    card = Rectangle(
        (float(corner[0]), float(corner[1])),
        *(float(size[0]), float(size[1])),
        transform=axes.transAxes,
        fc="white",
        ec=FAINT,
        lw=stroke(0.7),
        alpha=0.9,
        zorder=3.8,
    )
    axes.add_patch(card)


def _join(axes: Axes, mark: Array, corner: Array, size: Array) -> None:
    """Mark the point, and join its pictures to it where they stand elsewhere."""
    near = np.clip(mark, corner, corner + size)
    look: dict[str, Any] = {"transform": axes.transAxes, "color": INK, "zorder": 3.7}
    inside = bool((near == mark).all())
    if inside:
        return
    axes.plot(*mark, ls="", marker="o", ms=stroke(3), **look)
    axes.plot(*np.stack([mark, near]).T, lw=stroke(0.7), **(look | {"color": FAINT}))


def _inside_of(region: Row, data: Mapping[str, Any]) -> Inside:
    """Return what says of points (n, 2), in shares of the axes, whether a region has them."""
    from matplotlib.path import Path

    rings = [Path(_share(ring, data)) for ring in region["rings"]]

    def inside(points: Array) -> NDArray[np.bool_]:
        # In an odd number of rings: holes are none of it.
        found = np.zeros(len(points), bool)
        for ring in rings:
            found ^= ring.contains_points(points)
        return found

    return inside


def _share(at: Sequence[Any], data: Mapping[str, Any]) -> Array:
    low, high = np.array(data["ranges"]).T
    return np.asarray((np.array(at) - low) / (high - low))


def _size(axes: Axes, album: Album) -> Array:
    """Return width and height (2,) of the largest picture, in shares of the axes."""
    box = album.box(BELOW)
    tall = (box.high - box.low) / (box.right - box.left)
    frame, page = axes.get_position(), axes.figure.bbox
    shape = frame.height * page.height / (frame.width * page.width)
    size = np.array([1.0, tall / shape])
    return np.asarray(size * LARGEST / float(size.max()))


def _scale(one: Array, count: int, clear: float) -> float:
    """Return how much smaller pictures are where their region has less room."""
    size = float(np.hypot(one[0] * count, one[1] + WORDS))
    return float(np.clip(ROOM * clear / size, LEAST / LARGEST, 1.0))
