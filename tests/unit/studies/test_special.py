"""Bars of special points: by how much the last finer mesh has moved them."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ribbonopt.studies.continuation.walk import special
from ribbonopt.studies.continuation.walk.points import FOLD, Point


@pytest.mark.parametrize(
    ("places", "position", "error"),
    [
        ((1.0, 1.1, 1.11, 1.1101), 1.1101, 0.0004),  # near enough
        ((1.0, 1.001), 1.001, 0.004),
        ((1.0, 1.1, 1.3, 1.7), 1.7, 1.6),  # never
        ((1.0,), 1.0, None),  # no finer mesh leads on
        ((80.0, 80.0), 80.0, 80 * special.ROUNDING),  # by accident the same
    ],
)
def test_the_bar_is_four_times_what_the_last_mesh_moved(
    monkeypatch: pytest.MonkeyPatch, places: tuple[float, ...], position: float, error: float | None
) -> None:
    equations: Any = SimpleNamespace(enough=lambda error, _: error <= 0.02)
    points = [point(place) for place in places]

    def finer(_: Any, beside: Any, *__: Any) -> tuple[int, float] | None:
        return None if beside + 1 >= len(points) else (beside + 1, 0.0)

    monkeypatch.setattr(special, "_finer", finer)
    monkeypatch.setattr(special, "_point", lambda beside, *_: points[beside])
    first: Any = 0
    found = special._on_finer_meshes(equations, first, points[0], 0.0)
    assert found.position == position
    assert found.error == (None if error is None else pytest.approx(error, rel=1e-6, abs=0))


def point(position: float) -> Point[Any]:
    unknowns = np.array([0.0, position])
    return Point(None, unknowns, np.array([0.0, 1.0]), 1.0, 0.1, kind=FOLD)
