"""The softest disturbance: zero at folds and branch points, and the shape it has there."""

from collections.abc import Callable

import numpy as np
import pytest

from ribbonopt.checks.softest import Softest, softest
from ribbonopt.checks.stability import negative_directions
from ribbonopt.errors import ModelError
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation

FOLD = 0.564847083249  # of an arch a tenth shorter, one clamp turned against it, in radians
PITCHFORK = 0.230279190221  # of the sheared arch a quarter shorter, B3 / B2 = 2
ROD = "{type: kirchhoff, B2: 1, B3: 2}"


def lowest(solution: Solution) -> Softest:
    found = softest(solution)
    assert not isinstance(found, str), found
    return found


def snapping_text(turn: float) -> str:
    return f"""
name: snap
law: {ROD}
parameters: {{turn: {turn}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: [0, 0, 0.9], directors: {{turns: [{{y: turn}}]}}}}
guess: {{force: [0, 0, -42], moment: [0, 4, 0]}}
tolerance: 1e-11
"""


def snapping(turn: float) -> Scene:
    return loads_scene(snapping_text(turn))


def sheared(shear: float) -> Scene:
    return loads_scene(
        f"""
        name: sheared
        law: {ROD}
        boundary:
          start: {{support: clamped, position: [0, 0, 0], directors: identity}}
          end: {{support: clamped, position: [0, {shear}, 0.75], directors: identity}}
        guess:
          force: [0, 38.40590989, -27.93903156]
          moment: [-17.61910499, 1.66905196, 10.87192434]
        transcription: {{type: collocation, degree: 8, intervals: 16}}
        """
    )


def test_it_is_zero_at_the_fold_as_a_root() -> None:
    """The square of the eigenvalue is a straight line, to first order, that ends at the fold."""
    scene = snapping(0.2)
    prepared, near = prepare(scene), None
    rows = []
    for off in (0.1, 0.01, 0.004, 0.001, 0.0005):
        near = prepared.solve(snapping(FOLD - off), guess=near)
        assert near.verified and negative_directions(near) == 0
        mode = lowest(near)
        rows.append((off, mode.eigenvalue))
        assert np.abs(mode.displacement[:, 1]).max() < 1e-9  # it stays in the plane
    off, value = np.array(rows[1:]).T
    assert (np.diff(value) < 0).all()
    # value^2 = a off + b off^(3/2) + ...; where it is zero, off is.
    roots = np.sqrt(off)
    fit = np.polynomial.Polynomial.fit(value, roots, 3)
    assert abs(float(fit(0.0))) < 1e-4


def test_it_crosses_zero_at_the_pitchfork_and_breaks_the_symmetry() -> None:
    prepared, found = prepare(sheared(PITCHFORK)), None
    values = []
    for shear in (PITCHFORK - 1e-5, PITCHFORK + 1e-5):
        found = prepared.solve(sheared(shear), guess=found)
        assert found.verified and negative_directions(found) == int(shear > PITCHFORK)
        mode = lowest(found)
        values.append(mode.eigenvalue)
        # Half a turn about x takes the arch to itself, and the mode to its opposite.
        image = mode.displacement[::-1] * [1, -1, -1]
        np.testing.assert_allclose(image, -mode.displacement, atol=1e-7)
        turned = mode.rotation[::-1] * [1, -1, -1]
        np.testing.assert_allclose(turned, -mode.rotation, atol=1e-6)
        assert np.linalg.norm(mode.displacement, axis=1).max() == pytest.approx(1)
    before, after = values
    assert before > 0 > after
    middle = (before + after) / (before - after) * 1e-5
    assert abs(middle) < 1e-9


def test_a_mode_is_a_shape_that_keeps_the_ends_and_does_not_stretch() -> None:
    found = prepare(sheared(0.2)).solve(sheared(0.2))
    mode = lowest(found)
    for part in (mode.displacement, mode.rotation):
        assert np.abs(part[[0, -1]]).max() < 1e-9
    # dr' = rotation x d3, integrated by Simpson's rule on a polynomial through many points.
    s = mode.s
    d3 = found.sample(s, "d3")
    slope = np.cross(mode.rotation, d3)
    for axis in range(3):
        curve = np.polynomial.Chebyshev.fit(s, slope[:, axis], 24)
        moved = curve.integ(lbnd=0.0)(s)
        np.testing.assert_allclose(moved, mode.displacement[:, axis], atol=1e-5)


@pytest.mark.parametrize("load", [20, 38, 39.4, 39.5, 60])
def test_a_straight_column_is_softest_as_it_buckles(
    solved: Callable[..., Solution], load: float
) -> None:
    """Closed form: 1 - P / (4 pi^2) times the compliance, and a cosine, clamped and guided."""
    found = solved("column_clamped", f"parameters.P={load}", f"guess.force=[0, 0, {-load}]")
    mode = lowest(found)
    assert mode.eigenvalue == pytest.approx(1 - load / (4 * np.pi**2), rel=1e-8)
    exact = (1 - np.cos(2 * np.pi * mode.s)) / 2
    sign = np.sign(mode.displacement[len(exact) // 2, 0])
    np.testing.assert_allclose(sign * mode.displacement[:, 0], exact / exact.max(), atol=1e-7)
    assert np.abs(mode.displacement[:, 1:]).max() < 1e-6


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("moebius_whole", "{type: variational, delta: 0.1}"),
        ("moebius_whole", "{type: sadowsky}"),  # one switch, which slides with it
        ("band_three_whole", "{type: sadowsky}"),  # three
    ],
)
def test_a_loop_that_slides_along_itself_has_a_neutral_mode(
    solved: Callable[..., Solution], name: str, law: str
) -> None:
    """Every point moves along the tangent, and all together so that the start is where it was."""
    found = solved(name, f"law={law}")
    mode = lowest(found)
    assert abs(mode.eigenvalue) < 1e-8 and negative_directions(found) == 0
    o = found.outputs(mode.s)
    turning = found.u0[1] * o["d2"][0] + found.u0[2] * o["d3"][0]
    exact = o["d3"] - o["d3"][0] - np.cross(turning, o["r"])
    size = np.linalg.norm(exact, axis=1).max()
    sign = np.sign((exact * mode.displacement).sum())
    np.testing.assert_allclose(sign * mode.displacement, exact / size, atol=1e-7)


def test_units_are_those_of_the_scene(solved: Callable[..., Solution]) -> None:
    """A compliance is one over D w, a moment times a length."""
    law = "law={type: variational, delta: 0.1}"
    si, plain = (solved(name, law) for name in ("ribbon_si", "moebius_half"))
    stiffness = si.units.moment * si.units.length
    assert lowest(si).eigenvalue * stiffness == pytest.approx(lowest(plain).eigenvalue, rel=1e-6)
    np.testing.assert_allclose(lowest(si).s[[0, -1]], si.scene.interval)


def test_a_branch_records_it_where_a_stage_asks() -> None:
    stage = "continuation: {parameter: parameters.turn, from: 0.4, to: 0.6, largest: 0.05,"
    text = snapping_text(0.4) + f"{stage} stability: eigenvalue, stop: [softest < -0.05]}}"
    continuation = Continuation(loads_scene(text))
    rows = [dict(point.row) for point in continuation]
    points = [row for row in rows if row["kind"] == "point"]
    assert "softest < -0.05" in continuation.ending.reason
    assert rows[-1]["softest"] < -0.05 and rows[0]["softest"] > 0.1
    for row in points:
        assert row["negative"] == int(row["softest"] < 0)
    assert [row["softest"] for row in rows if row["kind"] == "fold"] == [None]
    plain = Continuation(loads_scene(snapping_text(0.4) + f"{stage} points: 2}}"))
    assert all("softest" not in point.row for point in plain)
    with pytest.raises(ModelError, match="found 'softest', expected a recorded quantity"):
        Continuation(loads_scene(snapping_text(0.4) + f"{stage} stop: [softest < 0]}}"))


@pytest.mark.parametrize("law", ["{type: regularized, epsilon: 0.1}"])
def test_what_has_no_energy_has_no_mode(solved: Callable[..., Solution], law: str) -> None:
    assert "no energy" in str(softest(solved("moebius_half", f"law={law}")))
