"""Stability of Sadowsky's ribbon where its strains leap: thresholds, and the limit of smooth laws.

The sheared arch: both ends clamped, shortened to .6875, the far end moved across along d2. Its
thresholds are those of an order-8 shooting of symmetric halves, which knows nothing of energies.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from sheared_arch import NEAR, SADOWSKY, arch

from ribbonopt.checks.softest import Softest, softest
from ribbonopt.checks.stability import negative_directions, variation_of, why_not
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.problem import Posed
from ribbonopt.scene import loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

BORN, LEVEL = 0.25060501787, 0.38286571873  # a phase at each clamp; the level state is symmetric


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
    near, values = None, []
    for shear in (LEVEL + 1e-4, LEVEL - 1e-4):
        scene = arch(SADOWSKY, shear, loads)
        near = prepare(scene).solve(scene, guess=near)  # an arch of height 1e-3 is below it too
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
    found, gaps = limit, []
    for delta in (1e-3, 1e-2):  # from the limit, that it be the same of several equilibria
        scene = arch(f"{{type: variational, delta: {delta}}}", shear, NEAR[shear], weight)
        found = prepare(scene).solve(scene, guess=found, fallback=False)
        assert found.verified, found.message
        assert negative_directions(found) == count
        gaps.append(abs(lowest(found).eigenvalue - lowest(limit).eigenvalue))
    assert gaps[0] < gaps[1] / 2 and gaps[0] < 0.01


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


def test_where_it_cannot_be_told_it_is_said() -> None:
    off = arch(SADOWSKY, 0.1, NEAR[0.1])
    off = replace(off, switching="off")
    crossed = prepare(off).solve(off, fallback=False)
    assert crossed.status is Status.WRONG_SOLUTION
    assert negative_directions(crossed) is None
    assert "no phases meet there" in why_not(crossed)


def test_neither_in_mixtures_nor_beyond_a_sheet() -> None:
    found = prepare(arch(SADOWSKY, 0.1, NEAR[0.1])).solve(arch(SADOWSKY, 0.1, NEAR[0.1]))
    for kinds, words in (((1, 0, 1), "mixture"), ((-1, 1, -1), "wrong sign")):
        assert words in str(variation_of(replace(found, sheets=kinds)))
