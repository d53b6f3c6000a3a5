"""Names in figures: none on another, none on a point that is named, none outside."""

from itertools import combinations

import numpy as np
import pytest

from ribbonopt.views.naming import Box, Name, places, write_all
from ribbonopt.views.style import blank

INSIDE = Box(0, 0, 600, 400)
NO_LINES = np.zeros((0, 2))


@pytest.mark.parametrize("seed", range(5))
def test_names_are_apart_and_inside(seed: int) -> None:
    rng = np.random.default_rng(seed)
    anchors = [(float(x), float(y)) for x, y in rng.uniform(0, 1, (25, 2)) * (600, 400)]
    sizes = [(float(w), 12.0) for w in rng.uniform(20, 90, 25)]
    found = places(anchors, sizes, INSIDE, NO_LINES)
    boxes = [box for box in found if box is not None]
    assert len(boxes) > 15
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    assert all(box.within(INSIDE) for box in boxes)
    for box in boxes:
        assert box.holds(np.array(anchors)) == 0
    for box, (width, height) in zip(found, sizes, strict=True):
        if box is not None:
            assert (box.right - box.left, box.top - box.bottom) == pytest.approx((width, height))


def test_a_name_without_room_is_left_out() -> None:
    first, second = places(
        [(50, 50), (50, 50)], [(90, 90), (10, 10)], Box(0, 0, 100, 100), NO_LINES
    )
    assert first is None  # it would lie on the point it names
    assert second is not None


def test_names_stand_beside_lines_where_they_can() -> None:
    along = np.column_stack([np.linspace(300, 400, 200), np.linspace(200, 170, 200)])
    (free,) = places([(300, 200)], [(60, 12)], INSIDE, NO_LINES)
    (beside,) = places([(300, 200)], [(60, 12)], INSIDE, along)
    assert free is not None and free.holds(along) > 0
    assert beside is not None and beside.holds(along) == 0


def test_names_of_a_figure_are_apart_as_drawn() -> None:
    figure = blank(4, 3)
    axes = figure.subplots()
    axes.set(xscale="log", yscale="log")
    x = np.logspace(-12, -1, 9)
    axes.plot(x, x**-0.2)
    write_all(figure, {axes: [Name(f"gauss {i} x {i}", (v, v**-0.2)) for i, v in enumerate(x)]})
    figure.canvas.draw()
    boxes = [Box(*text.get_window_extent().extents) for text in axes.texts]
    assert len(boxes) >= 7
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    assert all(box.within(Box(*axes.bbox.extents)) for box in boxes)
