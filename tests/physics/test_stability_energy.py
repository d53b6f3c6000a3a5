"""The second variation where strains leap, against the energy itself.

Moments are disturbed by a finite amount, so that the switches move, the ribbon is integrated by
DOP853 from one change of sign of m2 to the next, and its ends are mended by Newton's method.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from sheared_arch import NEAR, SADOWSKY, arch

from ribbonopt.checks.stability import variation_of
from ribbonopt.checks.variation import Variation
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.solution.solution import Solution

Array = np.ndarray


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
