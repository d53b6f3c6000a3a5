"""Loops of many half twists from nothing: all laws, all pieces, and the figure of eight.

From four half twists on, Sadowsky's bands are a mixture of both sheets from end to end. Truth: the
equations written out here and integrated by DOP853, a closed band's E = H L, the linking of its
edges with its centre line, and the energy of the smooth law extrapolated to delta = 0.
"""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import (
    Boundary,
    Collocation,
    End,
    Law,
    Loop,
    Quaternion,
    Regularized,
    Sadowsky,
    Scene,
    Variational,
)
from ribbonopt.solution.solution import Solution

Array = np.ndarray
SADOWSKY, PAPER, SMOOTH = Sadowsky(), Regularized(epsilon=1e-3), Variational(delta=1e-2)


@cache
def band(half_twists: int, law: Law, piece: str = "whole") -> Solution:
    loop = Loop(half_twists, piece)  # type: ignore[arg-type]
    interval = (0.0, 1 / loop.pieces)
    found = solve(Scene("band", law, Boundary(loop=loop), interval=interval, tolerance=1e-8))
    assert found.verified, found.message
    return found


def linking(first: Array, second: Array) -> float:
    """Gauss's linking integral of two closed polygons, by midpoints."""
    sides = [np.roll(c, -1, axis=0) - c for c in (first, second)]
    middles = [c + side / 2 for c, side in zip((first, second), sides, strict=True)]
    gap = middles[0][:, None] - middles[1][None]
    triple = np.einsum("ijk,ijk->ij", gap, np.cross(sides[0][:, None], sides[1][None]))
    return float(np.sum(triple / np.linalg.norm(gap, axis=2) ** 3)) / (4 * np.pi)


def assert_closed_band(found: Solution, half_twists: int) -> None:
    """Assert that a whole band closes, with its half twists and the energy that its H gives."""
    s = np.linspace(0, 1, 601)
    o = found.outputs(s)
    sign = (-1.0) ** half_twists
    np.testing.assert_allclose(o["r"][-1], o["r"][0], atol=1e-7)
    for name, factor in (("d1", sign), ("d2", sign), ("d3", 1.0)):
        np.testing.assert_allclose(o[name][-1], factor * o[name][0], atol=1e-7)
    r, d2 = o["r"][:-1], o["d2"][:-1]
    edge = np.concatenate([r + 0.02 * d2, r + sign * 0.02 * d2])
    assert linking(r, edge) == pytest.approx(half_twists, abs=0.05)


def rates(_: float, y: Array) -> Array:
    """Return y' of y = r, d1, d2, d3, n, m, energy along a mixture of both sheets."""
    d, n, m = y[3:12].reshape(3, 3), y[12:15], y[15:18]
    (_, n2, n3), (m1, _, m3) = d @ n, d @ m
    u3 = m3 / 4
    u2 = 2 * n2 * u3 / (n3 + m3 * u3 - m1**2 / 4)
    turn = np.cross(u2 * d[1] + u3 * d[2], d).ravel()
    return np.concatenate([d[2], turn, np.zeros(3), np.cross(n, d[2]), [2 * u3**2]])


@pytest.mark.parametrize("half_twists", [-9, -6, -2, -1, 2, 3, 4, 5, 7, 8])
def test_bands_of_sadowskys_law_close_as_asked(half_twists: int) -> None:
    found = band(half_twists, SADOWSKY)
    H = found.sample(found.nodes, "H")
    np.testing.assert_allclose(H, found.energy, rtol=1e-7)
    if abs(half_twists) != 2:  # edges of the figure of eight meet
        assert_closed_band(found, half_twists)
    mirrored = band(-half_twists, SADOWSKY)
    assert mirrored.energy == pytest.approx(found.energy, rel=1e-8)


@pytest.mark.parametrize("half_twists", [4, 5, 9])
def test_pieces_of_a_mixture_integrated_again(half_twists: int) -> None:
    found = band(half_twists, SADOWSKY, "fundamental")
    assert found.sheets == (0,)
    names = ("r", "d1", "d2", "d3", "n", "m")
    s = np.array(found.scene.interval)
    start, end = (np.concatenate([found.sample(at, name) for name in names]) for at in s)
    exact = solve_ivp(rates, s, [*start, 0], method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(end[:12], exact[:12], atol=1e-7)
    np.testing.assert_allclose(end[12:], exact[12:18], atol=1e-7 * np.abs(end[12:]).max())
    assert found.energy == pytest.approx(exact[18], rel=1e-8)
    # where the piece is reflected, and what makes it a mixture
    d, n, m = start[3:12].reshape(3, 3), start[12:15], start[15:]
    assert abs(d[0] @ n) + abs(d[0] @ m) + abs(d[1] @ m) < 1e-8 * np.abs(n).max()
    d = exact[3:12].reshape(3, 3)
    axis = np.array([-np.cos(np.pi / half_twists), 0, np.sin(np.pi / half_twists)])
    np.testing.assert_allclose(np.cross(exact[:3], axis), 0, atol=1e-8)
    np.testing.assert_allclose(np.cross(d[1], axis), 0, atol=1e-8)
    u = found.sample(np.linspace(*s, 41), "u")
    assert (np.abs(u[:, 1]) < np.abs(u[:, 2])).all()


@pytest.mark.parametrize("half_twists", [4, 5, 7])
def test_the_smooth_law_tends_to_the_mixture(half_twists: int) -> None:
    count = 2 * half_twists
    delta = np.array([1e-3, 3e-3, 1e-2])
    smooth = [band(half_twists, Variational(delta=d), "fundamental").energy * count for d in delta]
    limit = np.polynomial.polynomial.polyfit(delta, smooth, 2)[0]
    assert band(half_twists, SADOWSKY).energy == pytest.approx(limit, rel=1e-4)
    assert smooth[0] < band(half_twists, SADOWSKY).energy  # q <= M: energies grow as delta falls


@pytest.mark.parametrize("half_twists", [4, 7])
def test_all_pieces_are_of_one_band(half_twists: int) -> None:
    energies = [
        band(half_twists, SADOWSKY, piece).energy * Loop(half_twists, piece).pieces  # type: ignore[arg-type]
        for piece in ("fundamental", "half", "whole")
    ]
    np.testing.assert_allclose(energies, energies[0], rtol=1e-8)


@pytest.mark.parametrize("piece", ["whole", "half"])
@pytest.mark.parametrize("half_twists", [2, -2])
def test_the_figure_of_eight_meets_its_tolerance(half_twists: int, piece: str) -> None:
    # Planar elastica whose ends meet: 2 E(k) = K(k).
    m = brentq(lambda m: 2 * ellipe(m) - ellipk(m), 0.5, 0.99, xtol=1e-15)
    energy = 32 * ellipk(m) ** 2 * (m - 0.5)
    found = band(half_twists, SADOWSKY, piece)
    pieces = 1 if piece == "whole" else 2
    assert found.energy * pieces == pytest.approx(energy, rel=1e-8)
    assert np.abs(found.sample(found.nodes, "m3")).max() < 1e-8


def test_the_figure_of_eight_is_no_band_of_six() -> None:
    loop = Loop(6, "half")
    scene = Scene("band", SADOWSKY, Boundary(loop=loop), interval=(0.0, 0.5))
    found = solve(scene)
    assert found.verified, found.message
    assert found.energy * 2 == pytest.approx(band(6, SADOWSKY).energy, rel=1e-5)
    assert found.energy > 300  # the figure of eight has 28 on its half


def test_a_band_elsewhere_is_the_band_moved() -> None:
    q = np.array([0.5, 0.1, -0.7, 0.4])
    directors = Quaternion(tuple((q / np.linalg.norm(q)).tolist()))
    start = End(position=(0.3, -2.0, 1.5), directors=directors)
    mesh = Collocation(degree=6, intervals=20)
    scene = Scene("band", SADOWSKY, Boundary(start, loop=Loop(5)), transcription=mesh)
    found = solve(scene)
    assert found.verified, found.message
    assert found.energy == pytest.approx(band(5, SADOWSKY).energy, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("law", [SADOWSKY, PAPER, SMOOTH], ids=lambda law: law.type)
@pytest.mark.parametrize("half_twists", [k for k in range(-9, 10) if k])
def test_every_band_of_every_law(half_twists: int, law: Law) -> None:
    found = band(half_twists, law)
    if abs(half_twists) != 2:
        assert_closed_band(found, half_twists)
    if law is not PAPER:
        np.testing.assert_allclose(found.sample(found.nodes, "H"), found.energy, rtol=1e-6)
