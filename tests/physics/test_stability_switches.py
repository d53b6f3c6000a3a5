"""Stability of Sadowsky's ribbon where its strains leap: thresholds, smooth laws, the energy.

The sheared arch: both ends clamped, shortened to .6875, the far end moved across along d2. Its
thresholds are those of an order-8 shooting of symmetric halves, which knows nothing of energies.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from ribbonopt.checks.softest import Softest, softest
from ribbonopt.checks.stability import negative_directions, variation_of, why_not
from ribbonopt.checks.variation import Variation
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.solution.solution import Solution

Array = np.ndarray
SADOWSKY = "{type: sadowsky}"
BORN, LEVEL = 0.25060501787, 0.38286571873  # a phase at each clamp; the level state is symmetric

#: loads near those of the arch that is symmetric under half a turn about d1, by shear
NEAR = {
    0.1: ([0.0, 16.64, -43.71], [-7.905, 6.522, 5.982]),
    0.3: ([0.0, 67.98373, -17.63267], [-26.01431, -1.32271, 18.36979]),
    0.38: ([0.0, 84.09953, -10.89217], [-30.97873, -4.01012, 18.21611]),
}


def arch(law: str, shear: float, near: tuple[list[float], list[float]], weight: str = "") -> Scene:
    """Return the scene of an arch, from loads near those at its start, under a force per length."""
    loads = f"loads: {{force: {{{weight}}}}}" if weight else ""
    return loads_scene(
        f"""
        name: arch
        law: {law}
        boundary:
          start: {{support: clamped, position: [0, 0, 0], directors: identity}}
          end: {{support: clamped, position: [0, {shear}, 0.6875], directors: identity}}
        guess: {{force: {near[0]}, moment: {near[1]}}}
        tolerance: 1e-8
        {loads}
        """
    )


@cache
def family() -> Prepared:
    return prepare(arch(SADOWSKY, 0.3, NEAR[0.3]))


def symmetric(shear: float, near: Solution) -> Solution:
    """Return Sadowsky's arch next to another solution."""
    found = family().solve(Posed.of(arch(SADOWSKY, shear, NEAR[0.3])), guess=near, fallback=False)
    assert found.verified, found.message
    assert abs(found.sample(0.5, "dot(r, ey)") - shear / 2) < 1e-6
    return found


def lowest(solution: Solution) -> Softest:
    found = softest(solution)
    assert not isinstance(found, str), found
    return found


def test_a_phase_born_at_a_clamp_takes_the_stability_at_once() -> None:
    """No eigenvalue goes through zero there: a direction appears that was not, and is negative."""
    near = family().solve(arch(SADOWSKY, 0.3, NEAR[0.3]))
    for shear in (0.3, 0.27, 0.252, 0.2507, BORN + 1e-5):
        near = symmetric(shear, near)
        assert near.sheets == (-1, 1, -1, 1, -1)
        assert negative_directions(near) == 1
    assert near.switch_points[0] < 1e-5
    assert -0.13 < lowest(near).eigenvalue < -0.1
    before = prepare(arch(SADOWSKY, 0.1, NEAR[0.1])).solve(arch(SADOWSKY, 0.1, NEAR[0.1]))
    for shear in (0.1, 0.2, 0.24, BORN - 1e-5):
        before = symmetric(shear, before)
        assert before.sheets == (1, -1, 1)
        assert negative_directions(before) == 0
    assert lowest(before).eigenvalue > 0.04


def test_the_level_state_is_stable_from_its_threshold_on() -> None:
    """The eigenvalue is zero where the determinant of the symmetric half is, to seven digits."""
    loads = ([26.57097, 23.26906, -46.5021], [-16.9031, 9.13377, -5.08788])
    values = []
    for shear in (LEVEL + 1e-4, LEVEL - 1e-4):
        scene = arch(SADOWSKY, shear, loads)
        near = prepare(scene).solve(scene)
        assert near.sheets == (1, -1, 1, -1) and abs(near.sample(0.5, "dot(r, ex)")) < 1e-9
        assert negative_directions(near) == int(shear < LEVEL)
        values.append(lowest(near).eigenvalue)
    above, below = values
    slope = (above - below) / 2e-4
    assert abs((above + below) / 2 / slope) < 1e-7
    mode = lowest(near).displacement
    # It breaks the inversion: even, where a displacement should be odd.
    assert np.abs(mode + mode[::-1]).max() > 1.5
    assert np.abs(mode - mode[::-1]).max() < 5e-3  # places of stages differ about as much


@pytest.mark.parametrize(
    ("shear", "count", "weight"),
    [
        (0.1, 0, ""),
        (0.3, 1, ""),
        (0.38, 1, ""),
        (0.1, 0, "x: -5, y: 2, z: 3"),
        (0.3, 1, "x: 3, y: 1, z: -2"),
    ],
)
def test_it_is_the_limit_of_the_smooth_law(shear: float, count: int, weight: str) -> None:
    scene = arch(SADOWSKY, shear, NEAR[shear], weight)
    limit = prepare(scene).solve(scene)
    assert limit.sheets
    assert negative_directions(limit) == count
    gaps = []
    for delta in (1e-2, 1e-3):
        scene = arch(f"{{type: variational, delta: {delta}}}", shear, NEAR[shear], weight)
        found = prepare(scene).solve(scene)
        assert negative_directions(found) == count
        gaps.append(abs(lowest(found).eigenvalue - lowest(limit).eigenvalue))
    assert gaps[1] < gaps[0] / 2 and gaps[1] < 0.01


@pytest.mark.parametrize("length", [1.0, 1000.0, 0.01])
def test_neither_place_nor_size_matter(length: float) -> None:
    plain = prepare(arch(SADOWSKY, 0.3, NEAR[0.3])).solve(arch(SADOWSKY, 0.3, NEAR[0.3]))
    turn = Rotation.from_rotvec([0.3, 1.1, -2.0]).as_matrix()
    force, moment = (turn @ np.array(load) for load in NEAR[0.3])
    start = np.array([1.0, 2.0, -3.0]) * length
    end = start + length * turn @ [0.0, 0.3, 0.6875]
    frame = {f"d{i + 1}": turn[:, i].tolist() for i in range(3)}
    scene = loads_scene(
        f"""
        name: elsewhere
        law: {SADOWSKY}
        interval: [0, {length}]
        boundary:
          start: {{support: clamped, position: {start.tolist()}, directors: {frame}}}
          end: {{support: clamped, position: {end.tolist()}, directors: {frame}}}
        guess: {{force: {(force / length**2).tolist()}, moment: {(moment / length).tolist()}}}
        tolerance: 1e-8
        """
    )
    found = prepare(scene).solve(scene)
    assert negative_directions(found) == 1
    assert lowest(found).eigenvalue == pytest.approx(lowest(plain).eigenvalue, rel=1e-6)


# The energy itself, along a finite disturbance of the moments, integrated by DOP853.


class Disturbed:
    """Sadowsky's ribbon whose moments differ from those of a solution by given functions."""

    def __init__(self, solution: Solution) -> None:
        self.breaks = solution.switch_points
        edges = np.concatenate([[0.0], self.breaks, [1.0]])
        self.pieces = []
        for a, b in pairwise(edges):
            x = np.cos(np.pi * (np.arange(28) + 0.5) / 28)
            s = a + (b - a) * (x + 1) / 2
            o = solution.outputs(s)
            fits = [
                np.polynomial.Chebyshev.fit(s, o[name], 27, domain=[a, b]) for name in ("m2", "m3")
            ]
            self.pieces.append((b, fits))

    def moments(self, s: float, change: Callable[[float], Array]) -> Array:
        """Moments (2,) at s."""
        fits = next((fits for end, fits in self.pieces if s < end), self.pieces[-1][1])
        return np.array([fit(s) for fit in fits]) + change(s)

    def ends(self, change: Callable[[float], Array]) -> tuple[Array, float]:
        """Six deviations of the far end from the clamp, and the energy."""
        grid = np.linspace(0, 1, 400)
        m2 = [self.moments(s, change)[0] for s in grid]
        zeros = [
            brentq(lambda s: self.moments(s, change)[0], a, b, xtol=1e-15)
            for (a, b), (p, q) in zip(pairwise(grid), pairwise(m2), strict=True)
            if p * q < 0
        ]
        edges = np.unique(np.concatenate([[0.0], self.breaks, zeros, [1.0]]))
        y = np.array([1.0, 0, 0, 0, 0, 0, 0, 0])
        for a, b in pairwise(edges):
            side = np.sign(self.moments((a + b) / 2, change)[0])

            def rates(s: float, y: Array, side: float = side) -> Array:
                m2, m3 = self.moments(s, change)
                M, p = np.hypot(m2, m3), np.hypot(m2, m3) + side * m2
                u2, u3 = side * p * p / (4 * M), m3 * p / (4 * M)
                w, x, v, z = y[:4]
                turn = [-v * u2 - z * u3, v * u3 - z * u2, w * u2 - x * u3, w * u3 + x * u2]
                d3 = [2 * (x * z + w * v), 2 * (v * z - w * x), 1 - 2 * (x * x + v * v)]
                return np.array([*(0.5 * np.array(turn)), *d3, (m2 * u2 + m3 * u3) / 2])

            y = solve_ivp(rates, (a, b), y, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        return np.concatenate([y[4:7], y[1:4]]), float(y[7])


def test_the_energy_along_a_disturbance_has_that_second_difference() -> None:
    solution = prepare(arch(SADOWSKY, 0.1, NEAR[0.1])).solve(arch(SADOWSKY, 0.1, NEAR[0.1]))
    ribbon, rng = Disturbed(solution), np.random.default_rng(3)
    # Smooth functions with a part that jumps nowhere: the first is the disturbance, six mend ends.
    a = rng.normal(size=(7, 2, 5))

    def change(c: Array) -> Callable[[float], Array]:
        mixed = np.tensordot(c, a, 1)
        return lambda s: mixed @ np.cos(np.pi * np.arange(5) * s + 0.3)

    rest, energy = ribbon.ends(change(np.zeros(7)))

    def mended(step: float) -> tuple[Array, float]:
        """Coefficients (7,) of a disturbance of this size that keeps the ends, and its energy."""
        c = np.zeros(7)
        c[0] = step
        for _ in range(8):
            off = ribbon.ends(change(c))[0] - rest
            if np.abs(off).max() < 1e-12:
                break
            c[1:] -= np.linalg.solve(slopes, off)
        return c, ribbon.ends(change(c))[1]

    h = 1e-4
    slopes = np.stack(
        [
            (ribbon.ends(change(h * e))[0] - ribbon.ends(change(-h * e))[0]) / (2 * h)
            for e in np.eye(7)[1:]
        ],
        axis=1,
    )
    step = 2e-2
    (forward, more), (back, less) = mended(step), mended(-step)
    direction = (forward - back) / (2 * step)
    found = (more + less - 2 * energy) / step**2
    variation = variation_of(solution)
    assert not isinstance(variation, str)
    exact, still = quadratic(variation, solution, change(direction))
    assert found == pytest.approx(exact, rel=2e-3)
    assert abs(still - exact) > 0.05 * abs(exact)  # what it would be if the switches stood still


def quadratic(
    variation: Variation, solution: Solution, change: Callable[[float], Array]
) -> tuple[float, float]:
    """Value of the second variation for a change of the moments; switches moving, standing."""
    form, at = variation.form, variation.stages
    N, nx, _ = form.B.shape
    weights = np.sqrt(at.widths[:, None] * at.tableau.weights).ravel()
    z = np.array([change(s) for s in at.places]) * weights[:, None]
    own = np.hstack([z.reshape(N, -1), np.zeros((N, 1))])
    values = []
    for moving in (True, False):
        for e, s in zip(at.firsts, solution.switch_points, strict=True):
            o = {k: v[0] for k, v in solution.outputs(np.array([s])).items()}
            slope = -o["n1"] - o["u3"] * o["m1"]  # m2'
            # It moves by -dm2 / m2', and the shape turns by the leap |m3| / 2 on the way.
            own[e, -1] = moving * abs(o["m3"]) / 2 * change(s)[0] / slope
        _, rest = form.times(np.zeros(nx), own)
        values.append(float((own * rest).sum()))
    return values[0], values[1]


def test_where_it_cannot_be_told_it_is_said() -> None:
    off = arch(SADOWSKY, 0.1, NEAR[0.1])
    crossed = prepare(replace(off, switching="off")).solve(replace(off, switching="off"))
    assert negative_directions(crossed) is None
    assert "no phases meet there" in why_not(crossed)


def test_neither_in_mixtures_nor_beyond_a_sheet() -> None:
    found = prepare(arch(SADOWSKY, 0.1, NEAR[0.1])).solve(arch(SADOWSKY, 0.1, NEAR[0.1]))
    for kinds, words in (((1, 0, 1), "mixture"), ((-1, 1, -1), "wrong sign")):
        assert words in str(variation_of(replace(found, sheets=kinds)))
