"""Curves through points are near the curves that the points are of, and never far from them."""

import numpy as np
import pytest

from ribbonopt.views.curves import curves_through

T = np.linspace(0, 1, 13)
UNEVEN = np.sort(np.concatenate([T, [0.01, 0.02, 0.51, 0.9]]))


def whole(points: np.ndarray, corners: tuple[int, ...] = ()) -> np.ndarray:
    return np.concatenate(curves_through(points, corners), axis=1)


def far(curve: np.ndarray, dense: np.ndarray) -> float:
    """Largest distance of a curve from a dense one."""
    return float(np.hypot(*(curve[:, :, None] - dense[:, None, :])).min(axis=1).max())


@pytest.mark.parametrize("t", [T, UNEVEN], ids=["even", "uneven"])
@pytest.mark.parametrize(
    ("name", "of", "most"),
    [
        ("circle", lambda t: [0.5 * np.cos(2 * np.pi * t), 0.5 * np.sin(2 * np.pi * t)], 5e-3),
        ("fold", lambda t: [0.25 - (t - 0.5) ** 2, t], 1e-3),
        ("cusp of energies", lambda t: [-((t - 0.5) ** 2), (t - 0.5) ** 3], 5e-3),
        ("line", lambda t: [t, 2 - t], 5e-5),
    ],
)
def test_curves_are_near_what_the_points_are_of(t, name, of, most) -> None:
    points, dense = np.array(of(t)), np.array(of(np.linspace(0, 1, 20001)))
    found = far(whole(points), dense)
    assert found < most
    if name in ("circle", "fold"):  # nearer than their chords
        chords = np.concatenate(
            [np.linspace(a, b, 20).T for a, b in zip(points.T[:-1], points.T[1:], strict=True)],
            axis=1,
        )
        assert found < 0.5 * far(chords, dense)


def test_points_are_met_to_the_last_digit() -> None:
    points = np.random.default_rng(0).normal(size=(2, 9))
    curves = curves_through(points)
    assert len(curves) == 8
    for i, curve in enumerate(curves):
        np.testing.assert_array_equal(curve[:, [0, -1]], points[:, i : i + 2])


@pytest.mark.parametrize("seed", range(5))
def test_no_curve_leaves_its_chord_by_more_than_a_quarter(seed: int) -> None:
    # steps of very different lengths, in any direction
    rng = np.random.default_rng(seed)
    steps = rng.normal(size=(2, 40)) * 10 ** rng.uniform(-3, 0, 40)
    points = np.cumsum(steps, axis=1)
    for i, curve in enumerate(curves_through(points)):
        a, b = points[:, i], points[:, i + 1]
        chord = float(np.hypot(*(b - a)))
        assert far(curve, np.linspace(a, b, 200).T) <= 0.2501 * chord + chord / 200


def test_there_is_no_bend_but_at_corners() -> None:
    points = np.array([[0, 1, 2, 3, 4], [0, 1, 2, 1, 0]], float)
    straight = curves_through(points, corners=[2])
    for curve in straight:
        np.testing.assert_allclose(
            np.diff(curve[1]), np.diff(curve[1])[0] / np.diff(curve[0])[0] * np.diff(curve[0])
        )
    bent = curves_through(points)
    into, out = np.diff(bent[1][:, -2:])[:, 0], np.diff(bent[2][:, :2])[:, 0]
    assert abs(into[0] * out[1] - into[1] * out[0]) < 0.2 * np.hypot(*into) * np.hypot(*out)
    assert abs(bent[1][1, -2] - straight[1][1, -2]) > 1e-3


@pytest.mark.parametrize("count", [2, 3])
def test_points_that_coincide_are_no_obstacle(count: int) -> None:
    curves = curves_through(np.ones((2, count)))
    assert all((curve == 1).all() for curve in curves)
    mixed = whole(np.array([[0, 0, 1, 1, 2], [0, 0, 1, 1, 0]], float))
    assert np.isfinite(mixed).all()


@pytest.mark.parametrize("seed", range(4))
def test_what_goes_one_way_does_so_between(seed: int) -> None:
    # steps of very different lengths, as of counts that change at once
    rng = np.random.default_rng(seed)
    points = np.cumsum(10 ** rng.uniform(-4, 0, (2, 30)), axis=1)
    assert (np.diff(whole(points)) >= -1e-12).all()
    points[1] = np.repeat([0.0, 1.0, 0.0], 10)
    curve = whole(points)
    assert (np.diff(curve[0]) >= -1e-12).all()
    assert curve[1].min() > -0.2 and curve[1].max() < 1.2
