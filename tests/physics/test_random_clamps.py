"""Ribbons clamped at random places and orientations, solved from nothing, integrated again.

An equilibrium with a mixture (section 4) is unstable as an initial-value problem, with growth
rates of about 1 / sqrt(delta): errors of rounding in n(0), m(0) become errors of order one at the
far end. There the integration is started again on the solution at equal parts of the length; the
number of parts is the least power of two with which all joints close, and is bounded.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ribbonopt.mechanics.rotations import matrix_of
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import Boundary, Collocation, Directors, End, Scene, Variational
from ribbonopt.solution.solution import Solution

DELTA = 0.01
FAR_END = 1e-7
MOST_PARTS = 16


def clamps(count: int) -> list[Scene]:
    rng = np.random.default_rng(2026)
    return [clamp(rng) for _ in range(count)]


def clamp(rng: np.random.Generator) -> Scene:
    frame = matrix_of(rng.normal(size=4))  # uniform on the rotations
    distance, direction = rng.uniform(0.3, 0.95), rng.normal(size=3)
    x, y, z = (distance * direction / np.linalg.norm(direction)).tolist()
    d1, d2, d3 = (tuple(frame[:, i].tolist()) for i in range(3))
    start = End("clamped", position=(0, 0, 0), directors="identity")
    end = End("clamped", position=(x, y, z), directors=Directors(d1, d2, d3))
    return Scene(
        name="clamp",
        law=Variational(delta=DELTA),
        boundary=Boundary(start, end),
        transcription=Collocation(degree=6, intervals=40),
        tolerance=1e-11,  # so that what is integrated again starts well
    )


def rates(_: float, y: np.ndarray, n: np.ndarray) -> np.ndarray:
    """(2.1), (2.2), (2.7) with the strains dW_Leg/dm of W_Leg = (q + M)^2 / 8."""
    d, m = y[3:12].reshape(3, 3), y[12:]  # rows d1, d2, d3
    m2, m3 = d[1] @ m, d[2] @ m
    M, q = np.hypot(m2, m3), np.hypot(m2, DELTA * m3)
    u2 = (q + M) / 4 * (m2 / q + m2 / M)
    u3 = (q + M) / 4 * (DELTA**2 * m3 / q + m3 / M)
    # u x d_i, (A 1); written out, because this is all that the test spends time on.
    d1, d2, d3 = d
    n1, n2, n3 = n
    x, y, z = d3
    moment = np.array([n2 * z - n3 * y, n3 * x - n1 * z, n1 * y - n2 * x])
    return np.concatenate([d3, u3 * d2 - u2 * d3, -u3 * d1, u2 * d1, moment])


def state(solution: Solution, s: float) -> np.ndarray:
    return np.concatenate([solution.sample(s, name) for name in ("r", "d1", "d2", "d3", "m")])


def gap(solution: Solution, parts: int) -> float:
    """Largest gap in positions and directors; the end's is to what the scene prescribes."""
    joints = np.linspace(0, 1, parts + 1)
    end = solution.scene.boundary.end
    assert isinstance(end.directors, Directors)
    asked = np.concatenate([end.position, end.directors.d1, end.directors.d2, end.directors.d3])
    worst = 0.0
    for a, b in pairwise(joints):
        path = solve_ivp(
            rates, (a, b), state(solution, a), "DOP853", rtol=1e-11, atol=1e-12, args=(solution.n0,)
        )
        target = asked if b == 1 else state(solution, b)[:12]
        worst = max(worst, float(np.abs(path.y[:12, -1] - target).max()))
    return worst


def solved_and_integrated(scenes: list[Scene]) -> tuple[int, int]:
    """Numbers solved and confirmed, in parts or in one, and confirmed in one integration."""
    prepared = prepare(scenes[0])
    confirmed = whole = 0
    for scene in scenes:
        found = prepared.solve(scene)
        if not found.verified:
            continue
        parts = 1
        while (error := gap(found, parts)) > FAR_END and parts < MOST_PARTS:
            parts *= 2
        confirmed += error <= FAR_END
        whole += error <= FAR_END and parts == 1
    return confirmed, whole


def test_clamps_are_solved_from_nothing() -> None:
    confirmed, _ = solved_and_integrated(clamps(12))  # the first of those below
    assert confirmed == 12


@pytest.mark.parametrize(
    "count", [pytest.param(100, marks=pytest.mark.slow), pytest.param(200, marks=pytest.mark.sweep)]
)
def test_many_clamps_are_solved_from_nothing(count: int) -> None:
    confirmed, whole = solved_and_integrated(clamps(count))
    assert confirmed >= 0.97 * count
    assert whole >= count / 2
