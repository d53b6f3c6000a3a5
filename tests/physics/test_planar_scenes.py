"""`planar: true`: answers of elliptic integrals, those in space, and stability judged there."""

from dataclasses import replace
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve

from ribbonopt import prepare, solve
from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.arrays import Array
from ribbonopt.checks.stability import SecondVariation, second_variation
from ribbonopt.errors import ModelError, SceneError
from ribbonopt.scene import Scene, load_scene, loads_scene
from ribbonopt.solution.solution import Solution

TURNED = "d3: [0.6, 0, 0.8], d1: [0.8, 0, -0.6]"
CLAMPS = """
name: planar
law: {{{law}}}
boundary:
  start: {{position: [0, 0, 0], directors: identity{edge}}}
  end: {{position: [{x}, 0, {z}], {frame}{edge}}}
tolerance: {tolerance}
{more}
"""
#: laws, and what else the ribbon is or bears
RIBBONS = {
    "type: sadowsky": ["loads: {force: {x: -3}}", "width: 1 - 0.3*s"],
    "type: regularized, epsilon: 0.1": ["natural: {curvature: 1.5}"],
    "type: variational, delta: 0.1": ["natural: {curvature: 1.5, across: 0.4}"],
    "type: kirchhoff, B2: 1.3": ["loads: {points: [{at: 0.4, force: [1, 0, -2]}]}"],
    "type: wunderlich, width: 0.2": ["natural: {curvature: 1.5}"],
    "type: extensible, width: 0.1, thickness: 0.001, poisson_ratio: 0.3": ["loads: {pressure: 4}"],
    "type: sano, B2: 1, B3: 1.1, zeta: 0.3": ["membrane: {bending: 30, stretching: 900}"],
}
#: guesses of the three first equilibria of clamps a quarter nearer, and how many negative
#: directions each has among planar disturbances
MODES = {0: (-45, 6.5), 1: (-89.9, 10), 2: (-180.9, 13)}


def clamps(
    law: str,
    more: str,
    x: float = 0.0,
    z: float = 0.75,
    frame: str = "directors: identity",
    tolerance: float = 1e-9,
) -> Scene:
    given = {"x": x, "z": z, "frame": frame, "tolerance": tolerance}
    given["edge"] = ", edge: straight" if "wunderlich" in law else ""
    return loads_scene(CLAMPS.format(law=law, more=more, **given))


def mode(law: str, number: int, more: str = "planar: true", tolerance: float = 1e-9) -> Scene:
    force, moment = MODES[number]
    guess = f"guess: {{force: [0, 0, {force}], moment: [0, {moment}, 0]}}\n"
    guess += "transcription: {type: collocation, intervals: 20}\n"
    return clamps(law, guess + more, tolerance=tolerance)


def variation(scene: Scene) -> SecondVariation:
    found = second_variation(solve(scene))
    assert isinstance(found, SecondVariation)
    return found


# Truth: elliptic integrals.


def elastica(shortening: float) -> tuple[float, float, float]:
    """Return the force, the moment at a clamp and the energy of a clamped elastica."""
    m = mp.findroot(lambda m: 2 * mp.ellipe(m) / mp.ellipk(m) - 2 + shortening, 0.3)
    K, E = mp.ellipk(m), mp.ellipe(m)
    return float(16 * K**2), float(8 * mp.sqrt(m) * K), float(32 * K * (E - (1 - m) * K))


@pytest.mark.parametrize("law", ["type: sadowsky", "type: wunderlich, width: 0.3"])
@pytest.mark.parametrize("tolerance", [1e-9, 1e-12])
def test_it_is_the_elastica(law: str, tolerance: float) -> None:
    found = solve(mode(law, 0, tolerance=tolerance))
    force, moment, energy = elastica(0.25)
    assert found.verified
    assert found.scene.states == "planar"
    bars = estimate_error(found)
    for name, off in (
        ("n0", found.n0[2] + force),
        ("m0", abs(found.m0[1]) - moment),
        ("energy", found.energy - energy),
    ):
        assert abs(off) <= bars[name]
        assert bars[name] <= tolerance * force


def test_inflections_ask_for_no_finer_mesh_and_no_phases() -> None:
    """Sadowsky's ribbon is solved as the rod that it is: on the same mesh, in as many steps."""
    ribbon, rod = (solve(mode(law, 2)) for law in ("type: sadowsky", "type: kirchhoff"))
    assert len(np.flatnonzero(np.diff(np.sign(ribbon.sample(ribbon.nodes, "m2"))))) == 4
    assert ribbon.sheets == ()
    np.testing.assert_array_equal(ribbon.nodes, rod.nodes)
    assert [step["step"] for step in ribbon.steps] == [step["step"] for step in rod.steps]


@pytest.mark.parametrize("law", RIBBONS)
def test_the_plane_has_the_answers_of_space(law: str) -> None:
    for more in RIBBONS[law]:
        scenes = [
            clamps(law, f"{more}\nplanar: {planar}", 0.2, 0.6, TURNED)
            for planar in ("false", "true")
        ]
        space, plane = (solve(scene) for scene in scenes)
        assert space.verified
        assert plane.verified
        bars = [estimate_error(found) for found in (space, plane)]
        for name in ("n0", "m0", "energy", "H0"):
            if name == "H0" and space.posed.loaded:
                continue
            values = [np.array(value(found, name)) for found in (space, plane)]
            assert np.abs(values[0] - values[1]).max() <= bars[0][name] + bars[1][name]


def value(found: Solution, name: str) -> Array | float:
    return found.start["H"] if name == "H0" else getattr(found, name)


# What is across the plane.


@pytest.mark.parametrize(
    ("more", "match"),
    [
        ("boundary.end.position.y=0.1", r"^planar: true, but boundary\.end\.position\.y leads out"),
        ("states=full", r"planar: found true, states: full has what is across the plane"),
        ("formulation=energy", r"formulation energy: .*; leave planar out"),
    ],
)
def test_what_leads_out_of_the_plane_is_told_with_its_key(more: str, match: str) -> None:
    key, _, given = more.partition("=")
    scene = mode("type: sadowsky", 0)
    if key.startswith("boundary"):
        text = scene.boundary
        end = replace(text.end, position=(0.0, 0.1, 0.75))
        scene = replace(scene, boundary=replace(text, end=end))
    else:
        scene = replace(scene, **{key: given})
    with pytest.raises((ModelError, SceneError), match=match):
        prepare(scene)


@pytest.mark.parametrize("number", MODES)
def test_stability_is_judged_in_space_and_told_of_the_plane(number: int) -> None:
    """In the plane as many as SCIENCE-MAPS prints; in space as without `planar`."""
    plane = variation(mode("type: kirchhoff, B3: 0.1", number))
    space = variation(mode("type: kirchhoff, B3: 0.1", number, ""))
    assert plane.negative == space.negative
    assert plane.negative >= number
    assert (plane.in_plane or 0) == number
    assert space.in_plane is None
    of_them = f", {number} of them in its plane" if number else ""
    assert plane.verdict.endswith(of_them or "stable")


def lost_across(at: tuple[float, float]) -> float:
    """Return the B3 between two at which small disturbances across the plane of mode 1 appear.

    A displacement y and turns a, c about d1 and d3: y' = -a, a' = -k c, c' = (M3 - a k) / B3 + k a,
    M' = -dr' x n - r' x dn, k being the curvature. Nothing else moves in first order.
    """
    exact = {"method": "DOP853", "rtol": 1e-9, "atol": 1e-9}

    def rates(_: float, v: Array, B3: float, Fx: float, Fz: float, N: float) -> list[float]:
        _, _, turn, k, _, a, c, Mx, Mz = v
        sin, cos = np.sin(turn), np.cos(turn)
        twist = (Mx * sin + Mz * cos - a * k) / B3
        across = [a * Fz + N * cos, -a * Fx - N * sin]
        return [sin, cos, k, sin * Fz - cos * Fx, -a, -k * c, twist + k * a, *across]

    def end(B3: float, z: Array, first: Array) -> Array:
        start, forces = [0, 0, 0, z[2], 0, 0, 0, *first[1:]], (B3, *z[:2], first[0])
        found: Array = solve_ivp(rates, (0, 1), start, args=forces, **exact).y[:, -1]
        return found

    z = fsolve(lambda z: end(1.0, z, np.zeros(3))[:3] - [0, 0.75, 0], [0.0, -89.9, 10.0])

    def determinant(B3: float) -> float:
        return float(np.linalg.det([end(B3, z, row)[4:7] for row in np.eye(3)]))

    return float(brentq(determinant, *at, xtol=1e-5))


def test_a_rod_soft_in_twist_leaves_its_plane_where_a_determinant_vanishes() -> None:
    critical = lost_across((0.1, 0.3))
    for B3, across in ((0.998 * critical, 1), (1.002 * critical, 0)):
        found = variation(mode(f"type: kirchhoff, B3: {B3}", 1))
        assert (found.negative, found.in_plane) == (1 + across, 1)


@pytest.mark.parametrize(("offset", "negative"), [(-1e-4, 0), (1e-4, 1)])
def test_the_shipped_arch_gives_way_across_its_plane(
    configs: Path, offset: float, negative: int
) -> None:
    """Where the determinant of those disturbances vanishes, at a shortening of 0.58208583."""
    scene = load_scene(configs / "arch_planar.yaml")
    at = {"shortening": 0.58208583 + offset}
    found = variation(replace(scene, parameters=at, continuation=None))
    assert (found.negative, found.in_plane or 0) == (negative, 0)
