"""Ribbons of varying width: numbers of two other programs, and the equations written out here.

Energy w W(u): strains are those of m / w. Each phase is integrated again by DOP853.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from scipy.special import jv, yv
from test_mixture import clamp, draw, ends, state

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.checks.stability import negative_directions
from ribbonopt.checks.validity import warnings_of
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import (
    Boundary,
    Collocation,
    ContinuationStage,
    End,
    Kirchhoff,
    RibbonSizes,
    Scene,
    Shooting,
    Table,
    load_scene,
)
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation

Array = np.ndarray
Width = Callable[[float], float]
FORMULATIONS = ("inverted", "algebraic", "differentiated", "energy")
#: 0.5 in the last digit printed
HALF = 5.1e-11
N0 = (-1.8869542126, -2.4611621770, -3.2609453378)
M0 = (1.6747929952, 1.7809224232, 0.2080106729)
UNIFORM = (-3.7729664362, -4.8803077155, -2.1644709480)


@pytest.fixture
def strip(configs: Path) -> Scene:
    """Return the strip of the shipped scene, w = 1 - 0.7 s."""
    return replace(load_scene(configs / "tapered_strip.yaml"), continuation=None, record={})


def rates(width: Width, slope: Width, kind: int) -> Callable[[float, Array], Array]:
    """Return y' of y = r, d1, d2, d3, n, m, energy on one sheet (+1, -1) or a mixture (0)."""

    def rates_at(s: float, y: Array) -> Array:
        w = width(s)
        d, n, m = y[3:12].reshape(3, 3), y[12:15], y[15:18]
        _, n2, n3 = d @ n
        m1, m2, m3 = d @ m
        if kind:
            M = np.hypot(m2, m3)
            u2 = kind * (kind * m2 + M) ** 2 / (4 * M * w)
            u3 = m3 * (kind * m2 + M) / (4 * M * w)
            energy = w * (u2**2 + u3**2) ** 2 / (2 * u2**2)
        else:
            # m2 = 0 and m2' = -(n1 + m1 u3) = 0, the rate of which is zero too, with u3 = m3/(4 w)
            u3 = m3 / (4 * w)
            turning = 2 * n2 * u3 - m1 * u3 * slope(s) / w
            u2 = turning / (n3 + m3 * u3 - m1**2 / (4 * w))
            energy = 2 * w * u3**2
        turn = np.cross(u2 * d[1] + u3 * d[2], d).ravel()
        return np.concatenate([d[2], turn, np.zeros(3), np.cross(n, d[2]), [energy]])

    return rates_at


def assert_integrated_again(found: Solution, width: Width, slope: Width, close: float) -> None:
    """Integrate each phase from its start to its end, and compare all of it and the energy."""
    energy, s = 0.0, ends(found)
    for kind, a, b in zip(found.sheets or (1,), s[:-1], s[1:], strict=True):
        run = solve_ivp(
            rates(width, slope, kind), (a, b), state(found, a), "DOP853", rtol=1e-12, atol=1e-12
        )
        y, there = run.y[:, -1], state(found, b)
        np.testing.assert_allclose(y[:12], there[:12], rtol=0, atol=close)
        np.testing.assert_allclose(y[12:18], there[12:18], atol=close * np.abs(y[12:18]).max())
        energy += y[18]
    assert found.energy == pytest.approx(energy, rel=close)


@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_clamp_has_the_printed_digits(strip: Scene, formulation: Any) -> None:
    tolerance = None if formulation == "energy" else strip.tolerance  # it has no bars
    found = solve(replace(strip, formulation=formulation, tolerance=tolerance))
    assert found.verified
    np.testing.assert_allclose(found.n0, N0, rtol=0, atol=1.5e-10)
    np.testing.assert_allclose(found.m0, M0, rtol=0, atol=1e-10)
    # In the energy formulation strains are free controls, whose errors energies see squared.
    close = 5e-8 if formulation == "energy" else HALF
    middle = found.sample(0.5, "u")
    np.testing.assert_allclose(middle, (0, 2.6211922804, 0.8144819563), rtol=0, atol=close)
    assert found.energy == pytest.approx(2.100233929442, abs=1e-12)
    H = found.sample([0.0, 1.0], "H")
    np.testing.assert_allclose(H, (-1.6643042104, 0.6664438724), rtol=0, atol=1.5e-10)
    assert np.isnan(found.verification.drift["H"])  # it is no invariant
    if formulation != "energy":
        bars = estimate_error(found)
        assert np.abs(found.n0 - N0).max() <= bars["n0"] + HALF
        assert np.abs(found.m0 - M0).max() <= bars["m0"] + HALF
        assert negative_directions(found) == 0


@pytest.mark.parametrize(
    "scheme", [Collocation(scheme="radau"), Shooting(), Shooting(scheme="gauss", degree=4)]
)
def test_clamp_has_them_by_other_schemes(strip: Scene, scheme: Any) -> None:
    found = solve(replace(strip, transcription=scheme))
    np.testing.assert_allclose(found.n0, N0, rtol=0, atol=2e-9)


@pytest.mark.parametrize("formulation", FORMULATIONS)
@pytest.mark.parametrize("states", ["reduced", "planar"])
def test_cantilever_in_a_plane(formulation: Any, states: Any) -> None:
    if (formulation, states) == ("energy", "planar"):
        return
    start = End("clamped", (0.0, 0.0, 0.0), "identity")
    boundary = Boundary(start, End("free", force=(-1.0, 0.0, 0.0)))
    settings: dict[str, Any] = {"formulation": formulation, "states": states}
    found = solve(Scene("tip", Kirchhoff(), boundary, width="1 - 0.7*s", **settings))
    assert found.verified
    tip = (-0.356148547888, 0, 0.916335210590)
    np.testing.assert_allclose(found.sample(1.0, "r"), tip, rtol=0, atol=1e-10)
    assert found.m0[1] == pytest.approx(-0.91633521059, abs=1e-10)


@pytest.mark.parametrize("number", [4, pytest.param(0, marks=pytest.mark.slow), 5, 2])
def test_mixtures_and_jumps_integrated_again(number: int) -> None:
    found = solve(replace(clamp(*draw(number)), width="1 - k*s", parameters={"k": 0.3}))
    assert found.verified
    assert (0 in found.sheets) == (number != 2) and len(found.sheets) > 1
    assert_integrated_again(found, lambda s: 1 - 0.3 * s, lambda s: -0.3, 1e-7)


def test_width_of_a_table_is_the_spline_and_its_knots_are_in_the_bars(strip: Scene) -> None:
    s, w = (-0.1, 0.13, 0.37, 0.55, 0.81, 1.1), (1.0, 1.2, 0.7, 0.8, 1.1, 0.6)
    spline = CubicSpline(s, w)
    scene = replace(strip, width=Table(s, w))
    found = solve(scene)
    assert found.verified
    assert_integrated_again(found, spline, spline.derivative(), 1e-8)
    coarse = solve(replace(scene, tolerance=None, transcription=Collocation(intervals=5)))
    bar = estimate_error(coarse)["n0"]
    assert 1e-9 < np.abs(coarse.n0 - found.n0).max() < bar < 1e-3


def test_in_si_formula_and_table_are_of_metres(strip: Scene) -> None:
    sizes = RibbonSizes(0.3, 0.01, 2e-4, 2e9, 0.3)
    end = replace(strip.boundary.end, position=(0.3 * 0.68, 0.3 * 0.15, 0.3 * 0.31))
    boundary = replace(strip.boundary, end=end)
    si = replace(strip, ribbon=sizes, interval=(0.0, 0.3), boundary=boundary)
    for width in ("1 - taper*s/0.3", Table((0.0, 0.3), (1.0, 0.3))):
        found = solve(replace(si, width=width))
        assert found.verified
        np.testing.assert_allclose(found.n0 / found.units.force, N0, rtol=0, atol=1e-9)


def test_a_number_scales_the_loads_and_is_continued_through_one(strip: Scene) -> None:
    stage = ContinuationStage("width", values=(0.5, 1.0, 1.5))
    scene = replace(strip, width=0.5, continuation=stage)
    points = list(Continuation(scene))
    assert [point.row["width"] for point in points] == [0.5, 1.0, 1.5]
    for point in points:
        w = point.row["width"]
        np.testing.assert_allclose(point.solution.n0, w * np.array(UNIFORM), rtol=0, atol=1e-9)
        assert point.solution.verification.drift["H"] < 1e-8


def test_what_tapers_fast_or_is_too_wide_somewhere_is_told() -> None:
    def told(width: str) -> str:
        start = End("clamped", (0.0, 0.0, 0.0), "identity")
        boundary = Boundary(start, End("free", force=(-1e-3, 0.0, 0.0)))
        sizes = RibbonSizes(1.0, 0.09, 0.005, 1e7, 0.3)
        scene = Scene("told", Kirchhoff(), boundary, width=width, ribbon=sizes, states="planar")
        return " ".join(warnings_of(solve(scene)))

    assert told("1 - 0.4*s") == ""
    assert "the length is only 7.41 times the width" in told("1 + 0.5*s")
    assert "the width is only 9 times the thickness" in told("1 - 0.5*s")
    fast = told("1.05 + 0.05*sin(160*s)")
    assert "the width changes by 0.719 per length at s = 0;" in fast and "|w'| << 1" in fast


def test_the_law_declares_what_it_does_without_a_width(strip: Scene) -> None:
    for law in (strip.law, Kirchhoff()):
        with_width = capabilities(replace(strip, law=law))
        without = capabilities(replace(strip, law=law, width=None))
        for name in ("kinked", "smooth", "linear_at_zero", "bounds_eta", "developable"):
            assert getattr(with_width, name) == getattr(without, name), name


def test_a_tapered_column_buckles_at_the_zero_of_bessel_functions(configs: Path) -> None:
    # w y'' + P y = 0 between hinges: y = sqrt(w) times J1 and Y1 of 2 sqrt(P w) / 0.7.
    def determinant(P: float) -> float:
        a, b = (2 * np.sqrt(P * w) / 0.7 for w in (1.0, 0.3))
        return float(jv(1, a) * yv(1, b) - jv(1, b) * yv(1, a))

    critical = brentq(determinant, 4, 8, xtol=1e-13)
    column = load_scene(configs / "column_pinned.yaml")
    stage = ContinuationStage("parameters.P", from_=5.5, to=6.5, largest=0.5)
    scene = replace(column, width="1 - 0.7*s", parameters={"P": 5.5}, continuation=stage)
    points = list(Continuation(scene))
    counts = {p.row["parameters.P"]: p.row["negative"] for p in points if p.kind == "point"}
    assert counts[5.5] == 0 and counts[6.5] == 1
    (found,) = (p for p in points if p.kind == "branch point")
    assert found.row["parameters.P"] == pytest.approx(critical, abs=1e-10)
