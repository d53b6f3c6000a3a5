"""Extensible ribbons and Sano's in scenes: numbers of the notes, limits, sides that leap."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.checks.stability import negative_directions
from ribbonopt.checks.validity import warnings_of
from ribbonopt.errors import SceneError
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT

Solved = Callable[..., Solution]
Array = np.ndarray

CLAMP = ("extensible_clamped",)
N0 = (-3.2860898525, -3.7762068058, -1.7395962384)
M0 = (2.2251158402, 1.6110355251, -0.0653687590)
FORMULATIONS = ("inverted", "algebraic", "differentiated")

S_CLAMP = """
name: s-clamp
law: {{type: {law}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end:
    support: clamped
    position: [0.3, 0.06, 0.9]
    directors: {{rotation_vector: [0, -0.6, 0.5]}}
{more}
"""
WIDE = "extensible, width: 0.05, thickness: 2.0e-5, poisson_ratio: 0.3"  # k* = 0.0024
LAYER = "extensible, width: 0.05, thickness: 2.0e-4, poisson_ratio: 0.3"  # k* = 0.024


def s_clamp(law: str, *more: str) -> Solution:
    return solve(loads_scene(S_CLAMP.format(law=law, more="\n".join(more))))


@pytest.mark.parametrize("states", ["reduced", "full"])
@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_clamp_of_the_notes(solved: Solved, formulation: str, states: str) -> None:
    found = solved(*CLAMP, f"formulation={formulation}", f"states={states}")
    bars = estimate_error(found)
    np.testing.assert_allclose(found.n0, N0, rtol=0, atol=6e-11 + 5 * bars["n0"])
    np.testing.assert_allclose(found.m0, M0, rtol=0, atol=6e-11 + 5 * bars["m0"])
    middle = found.sample(np.array([0.5]), "u")[0]
    np.testing.assert_allclose(middle, (0, 2.6206567330, 0.8464543921), atol=6e-11)
    np.testing.assert_allclose(found.u0, (0, 1.7555950877, -0.0458293329), atol=6e-11)
    assert found.energy == pytest.approx(2.965209684562, abs=6e-13)
    assert float(found.sample(0.0, "H")) == pytest.approx(-0.3182118476, abs=6e-11)
    assert max(bars["n0"], bars["m0"]) < 1e-9
    assert negative_directions(found) == 0


def test_clamp_of_the_notes_as_least_energy(solved: Solved) -> None:
    found = solved(*CLAMP, "formulation=energy", "tolerance=null")
    np.testing.assert_allclose(found.n0, N0, atol=1e-8)
    np.testing.assert_allclose(found.m0, M0, atol=1e-8)


def test_sanos_ribbon_integrated_with_strains_as_states(solved: Solved) -> None:
    found = solved("sano_clamped")
    B2, B3, c = 0.91, 1.4, 1 / 0.12315302**2
    n, m0 = found.n0, found.m0

    def rates(_: float, x: Array) -> Array:
        r, d, (a, b) = x[:3], x[3:12].reshape(3, 3), x[12:]
        D = c + a**2
        hessian = np.array(
            [
                [B2 - b**4 / D**2 + 4 * a**2 * b**4 / D**3, -4 * a * b**3 / D**2],
                [-4 * a * b**3 / D**2, B3 + 6 * b**2 / D],
            ]
        )
        m1 = d[0] @ (m0 + np.cross(n, r))
        slopes = np.linalg.solve(hessian, [-n @ d[0] - b * m1, a * m1])
        u = a * d[1] + b * d[2]
        return np.concatenate([d[2], np.cross(u, d).ravel(), slopes])

    x0 = np.concatenate([np.zeros(3), np.eye(3).ravel(), found.u0[1:]])
    end = solve_ivp(rates, (0, 1), x0, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    np.testing.assert_allclose(end[:3], (0.68, 0.15, 0.31), atol=1e-9)
    reached = found.sample(1.0, "d1"), found.sample(1.0, "d2"), found.sample(1.0, "d3")
    np.testing.assert_allclose(end[3:12], np.ravel(reached), atol=1e-9)
    np.testing.assert_allclose(end[12:], found.sample(1.0, "u")[1:], atol=1e-8)
    a, b = found.u0[1:]
    D = c + a**2
    np.testing.assert_allclose(
        m0[1:], [B2 * a - a * b**4 / D**2, B3 * b + 2 * b**3 / D], atol=1e-10
    )


# Sides that leap, and layers where they nearly do.


def test_a_wide_ribbon_leaps_and_says_so() -> None:
    found = s_clamp(WIDE, "tolerance: 1e-9")
    assert found.verified and found.sheets == (1, -1)
    assert negative_directions(found) == 0
    at = found.trajectory.ends[1]
    before, after = (found.outputs(np.array([at + e]))["u2"][0] for e in (-1e-9, 1e-9))
    assert before > 0.4 and after < -0.4
    (said,) = [line for line in warnings_of(found) if "convexity" in line]
    assert f"at s = {at:.4g}" in said
    fine = s_clamp(
        WIDE, "transcription: {type: collocation, scheme: radau, degree: 5, intervals: 120}"
    )
    assert fine.sheets == (1, -1)
    bars, reached = estimate_error(found), estimate_error(fine)
    for name in ("n0", "m0"):
        error = np.abs(getattr(found, name) - getattr(fine, name)).max()
        assert error <= bars[name] + reached[name]


def test_a_leap_without_phases_is_no_solution() -> None:
    found = s_clamp(WIDE, "switching: off")
    assert not found.verified
    assert any("strains jump" in problem for problem in found.verification.problems)


def test_a_mixture_of_a_wide_ribbon_tends_to_sadowskys() -> None:
    """A clamp whose ribbon by Sadowsky's law is a mixture in its middle (test_mixture.py)."""
    rng = np.random.default_rng(1)
    for _ in range(5):
        q, distance, v = rng.normal(size=4), rng.uniform(0.3, 0.95), rng.normal(size=3)
    turn = Rotation.from_quat(q[[1, 2, 3, 0]]).as_rotvec().tolist()
    place = (distance * v / np.linalg.norm(v)).tolist()

    def solved_with(law: str) -> Solution:
        end = f"{{support: clamped, position: {place}, directors: {{rotation_vector: {turn}}}}}"
        start = "{support: clamped, position: [0, 0, 0], directors: identity}"
        text = f"name: mixture\nlaw: {{type: {law}}}\ntolerance: 1e-8\n"
        found = solve(loads_scene(f"{text}boundary: {{start: {start}, end: {end}}}\n"))
        assert found.verified and found.sheets == (-1, 0, 1)
        return found

    exact = solved_with("sadowsky")
    sizes = "extensible, width: 0.05, poisson_ratio: 0.3, thickness: "
    off = []
    for thickness in (1e-5, 1e-6):
        found = solved_with(f"{sizes}{thickness:.1e}")
        off.append(exact.energy - found.energy)
        H = found.sample(np.linspace(0, 1, 101), "H")
        np.testing.assert_allclose(H, H[0], rtol=1e-7)
    assert np.log10(off[0] / off[1]) == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-8])
def test_bars_hold_where_a_layer_nearly_leaps(tolerance: float) -> None:
    found = s_clamp(LAYER, f"tolerance: {tolerance}")
    fine = s_clamp(
        LAYER, "transcription: {type: collocation, scheme: radau, degree: 6, intervals: 200}"
    )
    assert found.verified and found.sheets == fine.sheets == ()
    assert not any("convexity" in line for line in warnings_of(found))
    bars, reached = estimate_error(found), estimate_error(fine)
    for name in ("n0", "m0"):
        error = np.abs(getattr(found, name) - getattr(fine, name)).max()
        assert error <= bars[name] + reached[name]
        assert bars[name] <= tolerance * np.abs(getattr(found, name)).max()


# Limits.


def test_clamps_tend_to_those_of_sadowsky_and_of_rods(solved: Solved) -> None:
    """Loads by the root of k* = h / w^2 / sqrt(12 (1 - nu^2)), and by its inverse square."""
    ribbon = solved(*CLAMP, "law=sadowsky")
    thin = [solved(*CLAMP, f"law.thickness={0.0025 / f}") for f in (64, 256)]
    off = [np.abs(each.n0 - ribbon.n0).max() for each in thin]
    assert np.log2(off[0] / off[1]) / 2 == pytest.approx(0.5, abs=0.01)
    rod = solved(*CLAMP, "law={type: kirchhoff, B2: 0.91, B3: 1.4}")
    narrow = [solved(*CLAMP, f"law.width={0.05 / f}") for f in (4, 8)]
    off = [np.abs(each.n0 - rod.n0).max() for each in narrow]
    assert np.log2(off[0] / off[1]) / 2 == pytest.approx(2, abs=0.01)


@pytest.mark.parametrize(
    ("law", "stiffnesses"),
    [("extensible, width: 0.05, thickness: 0.0025, poisson_ratio: 0.3", 0.91 * 1.4),
     ("sano, B2: 0.8, B3: 1.5, zeta: 0.3", 0.8 * 1.5)],
)  # fmt: skip
def test_lateral_buckling_begins_at_the_load_of_the_rod(
    configs: Path, law: str, stiffnesses: float
) -> None:
    overrides = [f"law={{type: {law}}}", "parameters.q=13"]
    stage = "continuation={parameter: parameters.q, from: 13, to: 16, switch: false}"
    scene = load_scene(configs / "lateral_buckling.yaml", [*overrides, stage])
    (crossing,) = [point for point in Continuation(scene) if point.kind == BRANCH_POINT]
    expected = 12.85376332 * np.sqrt(stiffnesses)
    assert value_of(crossing.row) == pytest.approx(expected, abs=1e-7)


# What stands in a scene beside the law.


def test_a_ribbon_of_another_width_all_along_is_the_law_of_that_width(solved: Solved) -> None:
    """Dw is that of the reference width."""
    half = solved(*CLAMP, "width=0.5")
    law = solved(*CLAMP, "law.width=0.025")
    np.testing.assert_allclose(half.n0, 0.5 * law.n0, rtol=1e-10)
    np.testing.assert_allclose(half.m0, 0.5 * law.m0, rtol=1e-10, atol=1e-10)
    sano = solved("sano_clamped", "width=0.5"), solved("sano_clamped", f"law.zeta={0.12315302 / 4}")
    np.testing.assert_allclose(sano[0].n0, 0.5 * sano[1].n0, rtol=1e-10)


def test_a_width_that_varies_is_the_same_as_least_energy(solved: Solved) -> None:
    taper = "width=1 - 0.4*s"
    found = solved(*CLAMP, taper)
    least = solved(*CLAMP, taper, "formulation=energy", "tolerance=null")
    np.testing.assert_allclose(found.n0, least.n0, atol=1e-7)
    # And where the unit of strains was that of the start everywhere it would not be.
    assert np.abs(found.n0 - solved(*CLAMP, "width=0.8").n0).max() > 1e-2


def test_natural_curvature_shifts_moments_and_needs_no_curvature_across(solved: Solved) -> None:
    found = solved(*CLAMP, "natural={curvature: 1.5}")
    u2, u3 = found.u0[1:]
    plain = solved(*CLAMP)
    k = 0.0025 / 0.05**2 / np.sqrt(12 * 0.91)
    # m2 + 1.5 is the moment of these strains: compared by the closed form for a small a.
    a, b, c0, c1 = u2 / k, u3 / k, 1 / 360, -1 / 181440
    q, phi, slope = 0.3 * a**2 + b**2, c0 + c1 * a**2, 2 * c1 * a
    m2 = k * (0.91 * a + q * 0.3 * a * phi + q**2 * slope / 4)
    assert found.m0[1] + 1.5 == pytest.approx(m2, rel=1e-2)
    assert np.abs(found.n0 - plain.n0).max() > 0.05
    with pytest.raises(SceneError, match="across"):
        solved(*CLAMP, "natural={curvature: 1.5, across: 0.2}")


def test_numbers_of_a_ribbon_in_metres_are_those_of_its_law(configs: Path) -> None:
    """L = 0.3 m, w = 10 mm, h = 0.1 mm, nu = 0.38."""
    path = configs / "ribbon_si.yaml"
    zeta = ((1 - 0.38**2) / 60) ** 0.5 * 0.01**2 / 1e-4
    said = {
        "extensible": "width: 0.01, thickness: 1.0e-4, poisson_ratio: 0.38",
        "sano": f"B2: {1 - 0.38**2}, B3: {2 * 0.62}, zeta: {zeta!r}",
    }
    for law, numbers in said.items():
        found = solve(load_scene(path, [f"law={law}"]))
        same = solve(load_scene(path, [f"law={{type: {law}, {numbers}}}"]))
        assert found.verified
        np.testing.assert_allclose(found.n0, same.n0, rtol=1e-12)
        np.testing.assert_allclose(found.m0, same.m0, rtol=1e-12)
