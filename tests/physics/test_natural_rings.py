"""Rings that are forced flat out of a larger natural curvature: up to where they stay flat.

Truth: a ring of curvature 1, covered once, is stable in its plane up to a natural curvature of
7 / (1 + 6 nu), by the Hessian of a collocated energy and by a determinant; there are two neutral
directions, the saddle in any place. Here the length is 1 and curvatures are 2 pi times as large.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.checks.softest import softest
from ribbonopt.checks.stability import negative_directions
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import Natural, Sadowsky, Scene, Variational, load_scene, loads_scene
from ribbonopt.scene.laws import Law
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation

CONFIGS = Path(__file__).parents[2] / "configs"
RING = """
name: ring
law: {type: sadowsky}
natural: {curvature: 7, poisson_ratio: 0}
boundary: {loop: {half_twists: 0, piece: whole}}
guess: circle
transcription: {type: collocation, scheme: gauss, degree: 6, intervals: 20}
"""


def threshold(nu: float) -> float:
    return 2 * np.pi * 7 / (1 + 6 * nu)


def ring(nu: float, curvature: float, law: Law) -> Scene:
    return replace(loads_scene(RING), law=law, natural=Natural(curvature, poisson_ratio=nu))


def flat(prepared: Prepared, scene: Scene) -> Solution:
    found = prepared.solve(scene)
    assert found.verified, found.message
    strains = found.at_nodes["u"]
    np.testing.assert_allclose(strains, np.tile((0, 2 * np.pi, 0), (len(strains), 1)), atol=1e-9)
    return found


@pytest.mark.parametrize("nu", [0.0, 0.3])
@pytest.mark.parametrize("law", [Sadowsky(), Variational(delta=0.001)], ids=lambda law: law.type)
def test_flat_ring_is_stable_up_to_the_threshold(law: Law, nu: float) -> None:
    at = threshold(nu)
    prepared = prepare(ring(nu, at, law))
    counts = [
        negative_directions(flat(prepared, ring(nu, at * share, law))) for share in (0.999, 1.001)
    ]
    assert counts == [0, 2]


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_threshold_to_eight_digits(nu: float) -> None:
    """The root of the softest eigenvalue: it changes its sign there, and is straight across."""
    at = threshold(nu)
    prepared = prepare(ring(nu, at, Sadowsky()))
    a, b = at * 0.9999, at * 1.0001
    for _ in range(3):
        low, high = (lowest(flat(prepared, ring(nu, value, Sadowsky()))) for value in (a, b))
        root = a - low * (b - a) / (high - low)
        a, b = root - 1e-5 * at, root + 1e-5 * at
    assert root == pytest.approx(at, rel=1e-8)


def lowest(solution: Solution) -> float:
    found = softest(solution)
    assert not isinstance(found, str), found
    return found.eigenvalue


def test_ring_opens_into_a_saddle() -> None:
    """The shipped scene: a pitchfork at 5 pi, whose branches are stable mirror images."""
    points = list(Continuation(load_scene(CONFIGS / "curved_ring.yaml")))
    (fork,) = (p for p in points if p.kind == "branch point")
    assert fork.row["natural.curvature"] == pytest.approx(5 * np.pi, rel=1e-9)
    ends = [p for p in points if p.row["natural.curvature"] == 18]
    rises = sorted(float(p.row["rise"]) for p in ends)
    assert rises[0] == pytest.approx(-rises[2], rel=1e-6)
    assert abs(rises[1]) < 1e-9 < rises[2]
    flat_end, *open_ends = sorted(ends, key=lambda p: abs(float(p.row["rise"])))
    assert flat_end.row["negative"] == 1
    assert [p.row["negative"] for p in open_ends] == [0, 0]
    assert all(p.row["energy"] < flat_end.row["energy"] for p in open_ends)
