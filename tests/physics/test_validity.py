"""Warnings where a ribbon is not one to which Sadowsky's model applies, and nowhere else."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ribbonopt.checks.validity import generatrix_slopes, warnings_of, wunderlich_factor
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.scene import Boundary, Loop, RibbonSizes
from ribbonopt.scene.units import units_of
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

Solved = Callable[..., Solution]
SLOPE = 6.21195648  # largest eta' of the half Moebius ribbon, L = 1
FINE = "transcription={type: collocation, degree: 8, intervals: 80}"


def of_size(
    solution: Solution, width: float, thickness: float = 1e-4, length: float = 1.0
) -> Solution:
    """Return a solution as that of a ribbon of some sizes (length of the whole loop)."""
    start, end = solution.scene.interval
    interval = (start * length, end * length)
    ribbon = RibbonSizes(length, width, thickness, 1e9, 0.3)
    given = replace(solution.scene, interval=interval, ribbon=ribbon)
    posed = replace(solution.posed, given=given, units=units_of(given))
    return replace(solution, posed=posed)


def with_loop(solution: Solution, loop: Loop) -> Solution:
    given = replace(solution.scene, boundary=Boundary(loop=loop))
    return replace(solution, posed=replace(solution.posed, given=given))


@pytest.mark.parametrize(
    "name", [["moebius_half"], ["elastica_clamped", "states=planar"], ["helix_clamped"]]
)
def test_no_warning_without_sizes_or_for_slender_ribbons(solved: Solved, name: list[str]) -> None:
    found = solved(*name)
    assert warnings_of(found) == []
    assert warnings_of(of_size(found, 0.01)) == []
    assert "warning" not in report(summarize(of_size(found, 0.01)))


def test_the_shipped_ribbon_is_slender(solved: Solved) -> None:
    assert summarize(solved("ribbon_si"))["warnings"] == []


def test_sizes_must_be_far_apart(solved: Solved) -> None:
    helix = solved("helix_clamped")
    assert warnings_of(of_size(helix, 0.0999)) == []
    (found,) = warnings_of(of_size(helix, 0.125))
    assert "length is only 8 times the width" in found
    assert warnings_of(of_size(helix, 0.05, 0.00499)) == []
    (found,) = warnings_of(of_size(helix, 0.05, 0.02))
    assert "width is only 2.5 times the thickness" in found


@pytest.mark.parametrize("length", [1.0, 0.3])
def test_wunderlichs_energy_is_compared_where_generatrices_turn_fastest(
    solved: Solved, length: float
) -> None:
    half = solved("moebius_half")
    assert warnings_of(of_size(half, 0.49 / SLOPE * length, length=length)) == []
    (found,) = warnings_of(of_size(half, 0.6 / SLOPE * length, length=length))
    assert f"{np.log(2.6 / 1.4) / 0.6 - 1:.1%} above Sadowsky's" in found
    assert f"at s = {0.1784 * length:.3g}" in found
    assert "(|eta'| w = 0.6)" in found
    *_, found = warnings_of(of_size(half, 2.01 / SLOPE * length, length=length))
    assert "generatrices meet" in found
    assert "out of its range" in found
    text = report(summarize(of_size(half, 2.01 / SLOPE * length, length=length)))
    assert "\n  warning: the generatrices meet" in text


def test_slopes_are_those_of_eta(solved: Solved) -> None:
    for name in ("moebius_half", "helix_clamped"):
        found = solved(name, FINE)
        s = np.linspace(*found.scene.interval, 4001)[1:-1]
        expected = np.gradient(found.sample(s, "eta"), s, edge_order=2)
        np.testing.assert_allclose(generatrix_slopes(found, s), expected, atol=2e-5)


def test_laws_that_smooth_the_leap_are_not_blamed_for_it(solved: Solved) -> None:
    for name in ("moebius_variational", "moebius_regularized"):
        found = solved(name)
        s = np.linspace(*found.scene.interval, 2001)
        assert np.abs(generatrix_slopes(found, s)).max() == pytest.approx(SLOPE, rel=0.05)
        assert warnings_of(of_size(found, 0.05)) == []


def test_rods_have_no_generatrices_and_planar_ribbons_straight_ones(solved: Solved) -> None:
    for name in (["moebius_kirchhoff"], ["elastica_clamped", "states=planar"]):
        found, *others = warnings_of(of_size(solved(*name), 0.9))
        assert "the length is only" in found
        assert not any("generatrices" in text for text in others)


def test_moebius_bands_can_only_be_so_wide(solved: Solved) -> None:
    half = of_size(solved("moebius_half"), 0.58)
    one = with_loop(half, Loop(1, "half"))
    assert any("no embedded developable Moebius band" in text for text in warnings_of(one))
    narrower = of_size(one, 0.57)
    others = (half, narrower, with_loop(half, Loop(2, "half")), with_loop(half, Loop(0, "half")))
    for other in others:
        assert not any("embedded" in text for text in warnings_of(other))
    # The solved half is a whole loop, or a sixth of one.
    whole = with_loop(of_size(half, 0.3), Loop(-1))
    assert any("w/L = 0.6" in text for text in warnings_of(whole))
    sixth = with_loop(half, Loop(3, "fundamental"))
    assert not any("embedded" in text for text in warnings_of(sixth))


def test_what_did_not_converge_is_judged_by_its_sizes_only(solved: Solved) -> None:
    lost = replace(of_size(solved("moebius_half"), 0.9), status=Status.MAX_ITERATIONS)
    (found,) = warnings_of(lost)
    assert "the length is only" in found


def test_wunderlichs_factor() -> None:
    assert wunderlich_factor(0.0) == 1.0
    for x in (1e-3, -1e-3, 0.1):
        assert wunderlich_factor(x) == pytest.approx(1 + x**2 / 12, abs=x**4)
    assert wunderlich_factor(1.0) == pytest.approx(np.log(3))
