"""Wunderlich's ribbon: numbers that two methods agree on, found from nothing to all their digits.

The whole band's energies are twice those of the half; 5.93 is the published E(1/30) / pi^2.
"""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

from ribbonopt import solve
from ribbonopt.accuracy.estimate import analyse
from ribbonopt.scene import Scene, Wunderlich, load_scene, loads_scene
from ribbonopt.solution.solution import Solution

CONFIGS = Path(__file__).parents[2] / "configs"
BAND = replace(load_scene(CONFIGS / "wunderlich_moebius.yaml"), continuation=None, tolerance=1e-9)

#: w / L: n2, n3, m2, m3, u2, eta at the start, energy of the whole band, H, p at the end, by
#: multiple shooting of another program
TABLE = {
    0.01: (
        *(43.5095034741, 42.5050020113, 1.937429962352, -9.014081731556, 3.37647461523),
        *(-0.80760250104, 57.75377205483, 58.0658649826, -0.246116247),
    ),
    1 / 60: (
        *(43.5123603229, 42.8131696605, 1.889528686715, -9.120469075507, 3.37191313505),
        *(-0.81321713623, 57.96539482388, 58.5034408822, -0.413305988),
    ),
    0.1 / pi: (
        *(43.5003746252, 43.5345191595, 1.771950600742, -9.393441498676, 3.36821661678),
        *(-0.82586094315, 58.47416895441, 59.5834432608, -0.804338043),
    ),
    1 / 30: (
        *(43.4977374346, 43.6076140077, 1.759588861121, -9.422936105858, 3.36836946751),
        *(-0.82710186949, 58.52672234314, 59.6971645386, -0.843977433),
    ),
    0.2 / pi: (
        *(43.3849767498, 45.1537441540, 1.477049826039, -10.122560228798, 3.39288726045),
        *(-0.85148349861, 59.67720476657, 62.2814509829, -1.686644199),
    ),
    0.1: (
        *(43.0898457384, 47.2160231598, 1.030857460743, -11.266473268704, 3.48329933732),
        *(-0.87791239127, 61.31032435335, 66.2380316386, -2.837869897),
    ),
    0.3: (
        *(38.3351103277, 66.7250849100, -8.002389855877, -32.168304649522, 6.46971954714),
        *(-0.87187057014, 80.07425413124, 131.5652879012, -18.589535418),
    ),
}
#: twist of the whole band in turns, and what is published of its energy over pi^2
TWISTS = {1 / 60: 0.315489, 0.1 / pi: 0.308448}
PUBLISHED = {1 / 30: 5.93}

CLAMP = """
name: clamp
law: {{type: wunderlich, width: {width}}}
boundary:
  start: {{position: [0, 0, 0], directors: identity, edge: {edge}}}
  end: {{position: {place}, directors: {{rotation_vector: {turn}}}, edge: {edge}}}
tolerance: 1e-10
"""
C = {"width": 0.05, "place": [0.68, 0.15, 0.31], "turn": [0, 2.4, 0.6]}
S = {"width": 0.1, "place": [0.3, 0.06, 0.9], "turn": [0, -0.6, 0.5]}


def told(printed: str, value: float) -> bool:
    """Whether a value has the digits printed, half a unit of the last of them apart at most."""
    digits = len(printed.partition(".")[2])
    return abs(value - float(printed)) <= 0.501 * 10.0**-digits


def solved(scene: Scene) -> Solution:
    found = solve(scene)
    assert found.verified, found.message
    return found


def start_of(found: Solution) -> tuple[float, ...]:
    """What the table says of a start, but for energy and H."""
    return (*found.n0[1:], *found.m0[1:], found.u0[1], float(found.sample(0.0, "own.eta")))


@pytest.mark.parametrize("width", TABLE)
def test_half_moebius_band(width: float) -> None:
    found = solved(replace(BAND, law=Wunderlich(width=width)))
    end = float(found.sample(0.5, "own.p"))
    values = *start_of(found), 2 * found.energy, found.start["H"], end
    np.testing.assert_allclose(values, TABLE[width], rtol=2e-9)
    assert found.sample(0.0, "own.p") == pytest.approx(0, abs=1e-14)
    assert found.sample(0.5, "own.eta") == pytest.approx(0, abs=1e-13)
    assert abs(found.sample(0.5, "u3")) < 1e-6
    if width in TWISTS:
        assert 2 * found.twist == pytest.approx(TWISTS[width], abs=0.5e-6)
    if width in PUBLISHED:
        assert 2 * found.energy / pi**2 == pytest.approx(PUBLISHED[width], abs=0.005)


def test_whole_band_is_twice_the_half() -> None:
    found = solved(
        loads_scene(
            f"{{name: whole, law: {{type: wunderlich, width: {0.2 / pi}}}, tolerance: 1e-8, "
            "boundary: {loop: {half_twists: 1}}}"
        )
    )
    values = (*start_of(found), found.energy, found.start["H"])
    np.testing.assert_allclose(values, TABLE[0.2 / pi][:-1], rtol=1e-8)
    assert found.switch_points == pytest.approx([0.5], abs=1e-9)


def test_clamp_c_with_straight_edges() -> None:
    found = solved(loads_scene(CLAMP.format(edge="straight", **C)))
    n0 = (-3.7739657322, -4.9038081743, -2.1688975453)
    m0 = (3.2218579377, 1.7418099804, -0.1128457461)
    np.testing.assert_allclose(found.n0, n0, atol=0.6e-10)
    np.testing.assert_allclose(found.m0, m0, atol=0.6e-10)
    assert told("-0.00098182428", found.sample(0.0, "own.p"))
    assert told("1.7409354339", found.u0[1])
    assert told("3.322380384314", found.energy)
    assert told("-0.651184282", found.start["H"])


def test_free_edges_have_slightly_less_energy() -> None:
    free, held = (
        solved(loads_scene(CLAMP.format(edge=edge, **C))) for edge in ("free", "straight")
    )
    assert 0 < held.energy - free.energy < 1e-3
    assert free.sample([0.0, 1.0], "own.p") == pytest.approx([0, 0], abs=1e-14)


def test_clamp_s_with_one_inflection() -> None:
    found = solved(loads_scene(CLAMP.format(edge="straight", **S)))
    n0 = (25.0314210028, 14.6760005957, 40.3430363220)
    m0 = (-18.9877762694, 1.2088281207, 8.6221913641)
    # The truth is known to 4e-10.
    np.testing.assert_allclose(found.n0, n0, atol=2e-9)
    np.testing.assert_allclose(found.m0, m0, atol=2e-9)
    assert found.energy == pytest.approx(4.475217972870, abs=1e-10)
    (at,) = found.switch_points
    assert told(".4321563094", at)
    assert found.sample(at, "own.eta") == pytest.approx(0.0036535478, abs=1e-8)
    assert found.sample(at, "own.p") == pytest.approx(0.0833070352, abs=1e-9)
    assert found.sample(0.0, "own.p") == pytest.approx(0.4697280614, abs=1e-9)
    assert found.start["H"] == pytest.approx(49.934298487, abs=1e-8)
    bars = analyse(found).errors
    assert np.abs(found.n0 - n0).max() <= bars["n0"] + 4e-10
    assert np.abs(found.m0 - m0).max() <= bars["m0"] + 4e-10


def test_narrow_ribbons_tend_to_sadowskys() -> None:
    """Half bands: the energy per width tends to Sadowsky's with the width, to first order."""
    energy = 2 * solved(replace(BAND, law=load_scene(CONFIGS / "moebius_half.yaml").law)).energy
    more = [
        2 * solved(replace(BAND, law=Wunderlich(width=w))).energy - energy
        for w in (0.004, 0.002, 0.001)
    ]
    orders = np.log2(np.array(more[:-1]) / more[1:])
    assert (np.array(more) > 0).all()
    np.testing.assert_allclose(orders, 1.0, atol=0.1)
