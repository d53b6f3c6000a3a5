"""Answers under Wunderlich's law beside equilibria found by means of their own."""

from collections.abc import Mapping
from types import SimpleNamespace

import numpy as np
import pytest
from independent.confirm import MOST, confirm, examine
from independent.wide_near import near
from wide_numbers import CLAMPS, HALVES

from ribbonopt import solve
from ribbonopt.scene import Boundary, End, Loop, Natural, RotationVector, Scene, Wunderlich
from ribbonopt.solution.solution import Solution

Array = np.ndarray
START = End("clamped", (0.0, 0.0, 0.0), "identity")
BENT = Boundary(START, End("clamped", (0.68, 0.15, 0.31), RotationVector((0.0, 2.4, 0.6))))
TURNED = Boundary(START, End("clamped", (0.3, 0.06, 0.9), RotationVector((0.0, -0.6, 0.5))))
TOLERANCE = 1e-9


@pytest.fixture(scope="module")
def bent() -> Solution:
    return solve(Scene("C", Wunderlich(width=0.05), BENT, tolerance=TOLERANCE))


def test_the_bent_clamp(bent: Solution) -> None:
    known = CLAMPS["C, edges straight"]
    assert bent.n0 == pytest.approx(known.n0, rel=TOLERANCE)
    assert bent.m0 == pytest.approx(known.m0, rel=TOLERANCE)
    assert bent.energy == pytest.approx(known.energy, rel=TOLERANCE)


def test_it_is_confirmed(bent: Solution) -> None:
    assert confirm(bent) < TOLERANCE / 100


@pytest.mark.parametrize(
    "name", ["own.p", "own.eta", *(pytest.param(name, marks=pytest.mark.sweep) for name in "nmr")]
)
def test_what_is_a_little_off_is_seen(bent: Solution, name: str) -> None:
    """By a millionth of its size, everywhere in one half."""
    scale = float(np.abs(bent.trajectory.outputs(np.linspace(0, 1, 33))[name]).max())

    def outputs(fraction: Array) -> Mapping[str, Array]:
        at = dict(bent.trajectory.outputs(fraction))
        off = np.where(fraction > 0.5, 1e-6, 0.0).reshape(-1, *[1] * (at[name].ndim - 1))
        return at | {name: at[name] + off * scale}

    trajectory = SimpleNamespace(outputs=outputs, ends=bent.trajectory.ends)
    altered = SimpleNamespace(posed=SimpleNamespace(scene=bent.posed.scene), trajectory=trajectory)
    assert confirm(altered) > 1e-6 / MOST


def test_another_width_is_seen(bent: Solution) -> None:
    scene = Scene("C", Wunderlich(width=0.0501), BENT)
    altered = SimpleNamespace(posed=SimpleNamespace(scene=scene), trajectory=bent.trajectory)
    assert confirm(altered) > 1e-7


def test_a_held_edge_is_seen(bent: Solution) -> None:
    """Where the scene says that an edge is free, p is to vanish there."""
    end = End("clamped", (0.68, 0.15, 0.31), RotationVector((0.0, 2.4, 0.6)), edge="free")
    scene = Scene("C", Wunderlich(width=0.05), Boundary(START, end))
    altered = SimpleNamespace(posed=SimpleNamespace(scene=scene), trajectory=bent.trajectory)
    found = examine(altered)
    assert found.worst > 1e-3
    assert found.where == "free edge at end"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("edge", "natural"),
    [
        ("straight", None),
        ("free", Natural(curvature=1.5, poisson_ratio=0.3)),
        pytest.param("free", None, marks=pytest.mark.sweep),
        pytest.param(
            "straight", Natural(curvature=1.5, poisson_ratio=0.3), marks=pytest.mark.sweep
        ),
    ],
)
def test_a_clamp_with_an_inflection(edge: str, natural: Natural | None) -> None:
    """As from the solution, so from nothing of the package: Newton's method by other means."""
    ends = (
        End("clamped", end.position, end.directors, edge=edge)
        for end in (TURNED.start, TURNED.end)
        if end is not None
    )
    scene = Scene("S", Wunderlich(width=0.1), Boundary(*ends), natural=natural, tolerance=TOLERANCE)
    found = solve(scene)
    truth, coarse = near(found)
    assert len(found.sheets) == 2
    assert truth.energy == pytest.approx(coarse.energy, rel=1e-12)
    assert found.energy == pytest.approx(truth.energy, rel=TOLERANCE)
    assert found.n0 == pytest.approx(truth.y[12:15, 0], rel=TOLERANCE)
    assert found.m0 == pytest.approx(truth.y[15:18, 0], rel=TOLERANCE)
    assert found.switch_points == pytest.approx(truth.ends[1:-1], abs=TOLERANCE)
    assert confirm(found) < 10 * TOLERANCE
    if natural is None:
        assert found.energy == pytest.approx(CLAMPS[f"S, edges {edge}"].energy, rel=TOLERANCE)


@pytest.mark.parametrize(
    "width",
    ["0.2/pi", *(pytest.param(width, marks=pytest.mark.sweep) for width in ("0.01", "0.3"))],
)
def test_half_a_moebius_band(width: str) -> None:
    known = HALVES[width]
    boundary = Boundary(loop=Loop(1, "half"))
    law = Wunderlich(width=known.width)
    found = solve(Scene("half", law, boundary, interval=(0.0, 0.5), tolerance=TOLERANCE))
    truth, _ = near(found, doubled=False)
    assert found.energy == pytest.approx(known.energy, rel=TOLERANCE)
    assert truth.energy == pytest.approx(known.energy, rel=1e-11)
    frame = np.array([found.start[d] for d in ("d1", "d2", "d3")])
    for ours, theirs in ((found.n0, known.n0), (found.m0, known.m0)):
        size = float(np.abs(theirs).max())
        assert frame @ ours == pytest.approx(theirs, abs=10 * TOLERANCE * size)
    assert confirm(found) < 10 * TOLERANCE
