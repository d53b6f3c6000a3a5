"""Point loads and supports between the ends: known numbers, and the same by other ways."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

from ribbonopt import Continuation, load_solution, loads_scene, save_solution, solve
from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.checks.stability import negative_range
from ribbonopt.scene import ContinuationStage
from ribbonopt.scene.lens import with_value

CANTILEVER = """
name: point_loads
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free, force: [-1, 0, 0]}
loads: {points: [{at: 0.5, force: [-2, 0, 0]}]}
"""
BEAM = """
name: three_supports
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {support: pinned, position: [0, 0, 0]}
  end: {position: {x: 0, y: 0}, force: {z: 0}, moment: [0, 0, 0]}
loads: {force: {x: -20}}
supports: [{at: 0.4, position: {x: 0}}]
states: planar
"""
CLAMPS = """
name: clamps
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {position: [0.68, 0.15, 0.31], directors: {rotation_vector: [0, 2.4, 0.6]}}
loads:
  points: [{at: 0.3, force: {d1: 4, d3: 2}}, {at: 0.6, force: [1, 2, 3], moment: {x: 0.2, y: 0.1}}]
tolerance: 1e-10
"""
#: m2 changes its sign between the two loads
SWITCHING = """
name: switching
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {position: [0.3, 0.06, 0.9], directors: {rotation_vector: [0, -0.6, 0.5]}}
loads: {points: [{at: 0.3, force: [2, 1, 0]}, {at: 0.6, force: [1, 2, 3]}]}
tolerance: 1e-9
"""
WAYS = [
    *product(("inverted", "algebraic", "differentiated"), ("reduced", "planar", "full")),
    ("energy", "reduced"),
]


@pytest.mark.parametrize(("formulation", "states"), WAYS)
def test_cantilever_with_two_loads(formulation: str, states: str) -> None:
    # By shooting of order 8 and by least energy, without this package.
    scene = replace(loads_scene(CANTILEVER), formulation=formulation, states=states)
    found = solve(replace(scene, transcription=replace(scene.transcription, intervals=16)))
    middle, tip = found.outputs(np.array([0.5, 1.0]))["r"]
    assert found.verified
    assert found.m0[1] == pytest.approx(-1.809822691708, abs=1e-11)
    assert middle == pytest.approx([-0.160450778122, 0, 0.466926876671], abs=1e-11)
    assert tip == pytest.approx([-0.447606589454, 0, 0.875968938365], abs=1e-11)
    assert found.energy + 2 * middle[0] + tip[0] == pytest.approx(-0.417310998215, abs=1e-11)


def shot_beam(load: float, place: float) -> tuple[float, float]:
    """Reactions at the start and at the support of an elastica on three supports, by shooting."""

    def along(unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        angle, first, middle = unknown

        def rates(force: float):
            # x, z, angle, moment about y, force along x; no force along z at the free end
            def f(s, y):
                return [np.sin(y[2]), np.cos(y[2]), y[3], -np.cos(y[2]) * y[4], load]

            return f

        options = {"rtol": 1e-12, "atol": 1e-13, "method": "DOP853"}
        one = solve_ivp(rates(0), (0, place), [0, 0, angle, 0, first], **options).y[:, -1]
        after = one - [0, 0, 0, 0, middle]
        two = solve_ivp(rates(0), (place, 1), after, **options).y[:, -1]
        return one, two

    def off(unknown: np.ndarray) -> list[float]:
        one, two = along(unknown)
        return [one[0], two[0], two[3]]

    found = fsolve(off, [0.0, -load / 6, load / 2], xtol=1e-13)
    return float(found[1]), float(found[2])


@pytest.mark.parametrize("formulation", ["inverted", "algebraic", "differentiated", "energy"])
def test_reaction_of_a_support(formulation: str) -> None:
    states = "reduced" if formulation == "energy" else "planar"
    scene = replace(loads_scene(BEAM), formulation=formulation, states=states)
    found = solve(scene)
    first, middle = shot_beam(20.0, 0.4)
    before, behind = found.outputs(np.array([0.4 - 1e-9, 0.4]))["n"]
    assert found.verified
    assert found.n0[0] == pytest.approx(first, rel=1e-9)
    assert before[0] - behind[0] == pytest.approx(middle, rel=1e-7)
    assert found.outputs(np.array([0.4]))["r"][0, 0] == pytest.approx(0, abs=1e-12)


def test_reaction_of_a_light_beam() -> None:
    # Of Bernoulli's beam on three supports at equal distances: 5/8 of the load on the middle one.
    scene = with_value(loads_scene(BEAM), "supports.0.at", 0.5)
    found = solve(with_value(scene, "loads.force.x", -1e-3))
    before, behind = found.outputs(np.array([0.5 - 1e-9, 0.5]))["n"]
    assert before[0] - behind[0] == pytest.approx(0.625e-3, rel=1e-5)


@pytest.mark.parametrize("formulation", ["algebraic"])
def test_loads_that_follow(formulation: str) -> None:
    scene = loads_scene(CLAMPS)
    found = solve(scene)
    other = solve(replace(scene, formulation=formulation, states="full"))
    bars = estimate_error(found)
    s = np.array([0.3 - 1e-12, 0.3, 0.6 - 1e-12, 0.6])
    o = found.outputs(s)
    drop = o["n"][0] - o["n"][1]
    assert drop == pytest.approx(4 * o["d1"][1] + 2 * o["d3"][1], abs=1e-8)
    assert o["n"][2] - o["n"][3] == pytest.approx([1, 2, 3], abs=1e-8)
    assert o["m"][2] - o["m"][3] == pytest.approx([0.2, 0.1, 0], abs=1e-8)
    assert np.abs(found.n0 - other.n0).max() < 1e-9
    assert np.abs(found.m0 - other.m0).max() < 1e-9
    assert max(bars.values()) < 1e-8


def test_the_strains_of_a_moment_leap_which_states_do_not() -> None:
    with pytest.raises(ValueError, match=r"loads\.points\.1\.moment makes the strains leap"):
        solve(replace(loads_scene(CLAMPS), formulation="differentiated"))


def test_what_follows_has_no_energy() -> None:
    with pytest.raises(ValueError, match=r"loads\.points\.0: it follows the ribbon"):
        solve(replace(loads_scene(CLAMPS), formulation="energy", tolerance=None))


def test_the_law_switches_between_loads() -> None:
    scene = loads_scene(SWITCHING)
    found = solve(scene)
    least = replace(scene, formulation="energy", tolerance=None)
    least = solve(replace(least, transcription=replace(scene.transcription, intervals=60)))
    assert found.verified and found.sheets == (1, 1, -1, -1)
    assert len(found.switch_points) == 1
    assert found.outputs(found.switch_points)["m2"] == pytest.approx([0], abs=1e-9)
    assert least.energy == pytest.approx(found.energy, rel=5e-5)  # it smears the jump
    assert negative_range(found) is not None


@pytest.mark.slow
def test_a_load_passes_the_switch() -> None:
    scene = loads_scene(SWITCHING)
    stage = ContinuationStage(parameter="loads.points.0.at", to=0.5)
    points = list(Continuation(replace(scene, continuation=stage)))
    last = points[-1].solution
    direct = solve(with_value(scene, "loads.points.0.at", 0.5))
    assert points[0].solution.sheets == (1, 1, -1, -1)
    assert last.sheets == direct.sheets == (1, -1, -1, -1)
    assert last.energy == pytest.approx(direct.energy, rel=1e-10)


@pytest.mark.parametrize(("force", "count"), [(-30.0, 0), (-45.0, 1)])
def test_column_with_a_support_in_the_middle(force: float, count: int) -> None:
    # Straight, it buckles in two half waves, at 4 pi^2 = 39.5, instead of at pi^2.
    text = BEAM.replace("at: 0.4", "at: 0.5").replace("force: {x: -20}", "force: {x: 0}")
    scene = with_value(loads_scene(text), "boundary.end.force.z", force)
    found = solve(scene)
    straight = np.abs(found.outputs(np.linspace(0, 1, 9))["r"][:, 0]).max() < 1e-6
    assert straight or count  # below the load there is nothing else
    if straight:
        # The straight strip, pinned, may turn about itself: one direction costs nothing.
        assert negative_range(found) == (count, count + 1)


@pytest.mark.parametrize("text", [CANTILEVER, BEAM, CLAMPS, SWITCHING])
def test_saved_and_loaded(text: str, tmp_path: Path) -> None:
    found = solve(loads_scene(text))
    save_solution(found, tmp_path)
    again = load_solution(tmp_path)
    s = np.linspace(0, 1, 7)
    for name, values in found.outputs(s).items():
        assert np.array_equal(values, again.outputs(s)[name], equal_nan=True), name


def test_in_metres_and_newtons() -> None:
    text = """
name: si
law: {type: sadowsky}
ribbon: {length: 0.2, width: 0.01, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.3}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free, force: [-F1, 0, 0]}
parameters: {F1: UNIT, F2: TWICE}
loads: {points: [{at: 0.1, force: [-F2, 0, 0]}]}
"""
    unit = 2e9 * 1e-12 / (12 * (1 - 0.09)) * 0.01 / 0.2**2  # D w / L^2
    found = solve(loads_scene(text.replace("UNIT", f"{unit}").replace("TWICE", f"{2 * unit}")))
    assert found.m0[1] == pytest.approx(-1.809822691708 * unit * 0.2, rel=1e-10)


def test_turned_and_mirrored() -> None:
    scene = loads_scene(CANTILEVER)
    found = solve(scene)
    turned = loads_scene(
        CANTILEVER.replace(
            "directors: identity", "directors: {rotation_vector: [0, 0, 1.5707963267948966]}"
        )
        .replace("[-1, 0, 0]", "[0, -1, 0]")
        .replace("[-2, 0, 0]", "[0, -2, 0]")
    )
    other = solve(turned)
    assert other.energy == pytest.approx(found.energy, rel=1e-12)
    assert other.outputs(np.array([1.0]))["r"][0, 1] == pytest.approx(
        found.outputs(np.array([1.0]))["r"][0, 0], abs=1e-12
    )
