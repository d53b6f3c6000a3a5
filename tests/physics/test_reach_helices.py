"""Clamps that a helix joins: mixtures |u2| < |u3|, and sheets; from nothing, and known."""

import numpy as np
import pytest
from helices import clamped_at, drawn, end_of, energy_of, loads_of
from scipy.spatial.transform import Rotation

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Boundary, Directors, End, Kirchhoff, Scene

DRAWN = drawn(60, 7, 2.0)
each_helix = pytest.mark.parametrize("i", range(10))


def is_mixture(u2: float, u3: float) -> bool:
    return abs(u2) < abs(u3)


@each_helix
def test_from_the_exact_strains_the_helix_itself(i: int) -> None:
    u2, u3 = DRAWN[i]
    found = solve(clamped_at(*end_of(u2, u3), known=True, strains=(u2, u3)))
    assert found.verified, found.message
    assert not found.given_up
    assert found.sheets == ((0,) if is_mixture(u2, u3) else ())
    assert found.energy == pytest.approx(energy_of(u2, u3), rel=2e-8)
    n, m = loads_of(u2, u3)
    size = max(np.abs(n).max(), np.abs(m).max())
    np.testing.assert_allclose(found.n0, n, atol=2e-8 * size)
    np.testing.assert_allclose(found.m0, m, atol=2e-8 * size)
    u = found.sample(np.linspace(0, 1, 21), "u")
    np.testing.assert_allclose(u, np.tile([0, u2, u3], (21, 1)), atol=1e-6 * np.hypot(u2, u3))


@each_helix
def test_from_nothing_no_more_energy_than_the_helix(i: int) -> None:
    found = solve(clamped_at(*end_of(*DRAWN[i])))
    assert found.verified, found.message
    assert found.energy <= energy_of(*DRAWN[i]) * (1 + 2e-8)


@pytest.mark.slow
@pytest.mark.parametrize("i", range(10, 60))
def test_from_nothing_no_more_energy_than_other_helices(i: int) -> None:
    test_from_nothing_no_more_energy_than_the_helix(i)
    test_from_the_exact_strains_the_helix_itself(i)


@pytest.mark.parametrize(("u2", "u3"), [(1.5, 2.5), (2.0, 2.6)])
@pytest.mark.parametrize("off", [1e-6, 1e-3, 1e-2])
def test_short_phases_of_one_sheet_where_the_clamp_is_off_a_mixture(
    u2: float, u3: float, off: float
) -> None:
    # Their lengths are of the order of what the clamp is off; the energy changes as little.
    r, frame = end_of(u2, u3)
    turned = Rotation.from_rotvec(off * np.array([-0.3, 0.6, 0.5])).as_matrix() @ frame
    found = solve(clamped_at(r + off * np.array([0.1, -0.2, -0.15]), turned))
    assert found.verified, found.message
    first, middle, last = found.sheets
    assert middle == 0
    assert first * last != 0
    a, b = found.switch_points
    assert 0 < a < 5 * off
    assert 0 < 1 - b < 5 * off
    assert found.energy == pytest.approx(energy_of(u2, u3), rel=off)


@pytest.mark.parametrize(("u2", "u3"), [(3.1, 0.565), (-3.97, -1.26), (4.3, 2.9), (-5.0, 0.4)])
@pytest.mark.parametrize("off", [1e-2])
def test_arcs_of_more_than_half_a_turn_that_are_nearly_helices(
    u2: float, u3: float, off: float
) -> None:
    r, frame = end_of(u2, u3)
    turned = Rotation.from_rotvec(off * np.array([0.5, -0.3, 0.7])).as_matrix() @ frame
    found = solve(clamped_at(r + off * np.array([0.2, 0.1, -0.2]), turned))
    assert found.verified, found.message
    assert found.energy == pytest.approx(energy_of(u2, u3), rel=15 * off)


@pytest.mark.parametrize("angle", [200, 270, 340])
def test_a_rod_bent_to_an_arc_of_more_than_half_a_turn(angle: float) -> None:
    bent = np.deg2rad(angle)
    r, frame = end_of(bent, 0.0)
    found = solve(clamped_at(r, frame, Kirchhoff(B2=1.5, B3=2.5)))
    assert found.verified, found.message
    assert found.energy == pytest.approx(1.5 * bent**2 / 2, rel=1e-8)


def test_a_mixture_elsewhere_in_space() -> None:
    u2, u3 = 0.8, 2.0
    r, frame = end_of(u2, u3)
    directors = Directors(*(tuple(column) for column in frame.T.tolist()))
    moved = np.array([1.0, 2.0, 3.0])
    start = End(position=tuple(moved.tolist()), directors="identity")
    end = End(position=tuple((moved + r).tolist()), directors=directors)
    law = clamped_at(r, frame).law
    found = solve(Scene("moved", law, Boundary(start, end), tolerance=1e-8))
    assert found.verified, found.message
    assert found.energy == pytest.approx(energy_of(u2, u3), rel=1e-8)
