"""Buckling loads of straight ribbons without moments m2, m3: numbers, and an independent truth.

A strip along z bears f(s) = -m1 of a load along its width y. An infinitesimal deflection with the
turn w3 about its axis has m2 = f w3, w3' = u3*, m3' = -f u2*, and m3 = 0 at the free end; the load
is that with w3(0) = 0. That is integrated here from the free end, by DOP853, the laws written out.
"""

from collections.abc import Callable

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ribbonopt.errors import ModelError
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.scene.lens import with_value
from ribbonopt.studies.buckling.buckling import buckling_loads
from ribbonopt.studies.buckling.found import Buckling

Strains = Callable[[float, float, float], tuple[float, float]]

TIP = """
name: lateral
law: {{type: {law}}}
parameters: {{P: 1}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: {{x: 0, y: P, z: 0}}}}
"""
WEIGHT = """
name: weight
law: {{type: {law}}}
parameters: {{P: 1}}
loads: {{force: {{y: P}}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free}}
"""
COLUMN = """
name: column
law: {{type: {law}}}
parameters: {{P: 1}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: {{x: 0, y: 0, z: -P}}}}
"""


def scene(text: str, law: str) -> Scene:
    return loads_scene(text.format(law=law))


def loads(text: str, law: str, end: float) -> tuple[Buckling, ...]:
    return buckling_loads(scene(text, law), "parameters.P", 1, end)


# the laws, written out


def sadowsky(m2: float, m3: float, chi: float) -> tuple[float, float]:
    M = np.hypot(m2, m3)
    return chi * (chi * m2 + M) ** 2 / (4 * M), m3 * (chi * m2 + M) / (4 * M)


def variational(delta: float) -> Strains:
    def strains(m2: float, m3: float, chi: float) -> tuple[float, float]:
        M, q = np.hypot(m2, m3), np.hypot(m2, delta * m3)
        return m2 * (q + M) ** 2 / (4 * q * M), m3 * (q + M) * (q + delta**2 * M) / (4 * q * M)

    return strains


def regularized(epsilon: float) -> Strains:
    def strains(m2: float, m3: float, chi: float) -> tuple[float, float]:
        M, mu = np.hypot(m2, m3), chi * m2
        return (
            m2 * (M + mu) ** 2 / (2 * M * (2 * mu + epsilon * (M + mu))),
            m3 * (M + mu) / (4 * M),
        )

    return strains


def turn_at_clamp(P: float, power: int, strains: Strains) -> float:
    """w3(0) for w3(1) = 1 and f = P (1 - s)^power / power!; t = 1 - s."""

    def rates(t: float, y: np.ndarray, chi: float) -> list[float]:
        f = P * t**power / power
        m2, m3 = f * y[0], y[1]
        u2, u3 = strains(m2, m3, chi)
        return [-u3, f * u2]

    def crosses(t: float, y: np.ndarray, chi: float) -> float:
        return float(y[0])

    crosses.terminal = True  # type: ignore[attr-defined]
    # Next to the free end m3 is smaller than m2 by t^(power + 1): u2 = m2 times what B2 says.
    t, chi = 1e-4, 1.0
    f = P * t**power / power
    slope = strains(f, 0.0, 1.0)[0] / f
    y = np.array([1.0, slope * P**2 / power**2 * t ** (2 * power + 1) / (2 * power + 1)])
    while t < 1:
        found = solve_ivp(
            rates, (t, 1), y, "DOP853", args=(chi,), events=crosses, rtol=1e-12, atol=1e-15
        )
        t, y = float(found.t[-1]), found.y[:, -1]
        if found.status != 1:
            break
        # Over the change of sign by a step that the event does not see.
        h, chi = 1e-9, -chi
        y, t = y + h * np.array(rates(t, y, chi)), t + h
    return float(y[0])


def truth(low: float, high: float, power: int, strains: Strains) -> float:
    return float(brentq(turn_at_clamp, low, high, (power, strains), xtol=1e-12, rtol=1e-13))


KNOWN = [
    ("sadowsky", 6.729347255, sadowsky),
    ("variational, delta: 0.1", 6.5555789, variational(0.1)),
    ("variational, delta: 0.01", 6.7257477, variational(0.01)),
    ("variational, delta: 0.001", 6.7292928, variational(0.001)),
    ("regularized, epsilon: 0.001", 6.7343797, regularized(0.001)),
]


@pytest.mark.parametrize(("law", "known", "strains"), KNOWN, ids=[law for law, _, _ in KNOWN])
def test_a_tip_load_along_the_width(law: str, known: float, strains: Strains) -> None:
    (found,) = loads(TIP, law, 8)
    assert found.value == pytest.approx(known, abs=1e-7)
    expected = truth(known - 0.1, known + 0.1, 1, strains)
    assert found.value == pytest.approx(expected, abs=2e-9)
    assert abs(found.value - expected) < found.error + 2e-9


@pytest.mark.parametrize(("law", "strains"), [(law, s) for law, _, s in KNOWN[:3]])
def test_own_weight_along_the_width(law: str, strains: Strains) -> None:
    (found,) = loads(WEIGHT, law, 24)
    expected = truth(20, 22, 2, strains)
    assert found.value == pytest.approx(expected, abs=1e-8)
    if law == "sadowsky":
        assert found.value == pytest.approx(21.4906596, abs=1e-7)


def test_modes_whose_m2_changes_sign() -> None:
    """Sadowsky's strains jump there: phases that meet where m2 of the mode vanishes."""
    first, second = loads(TIP, "sadowsky", 20)
    assert first.mode.pieces is not None and second.mode.pieces is not None
    assert len(first.mode.pieces.kinds) == 1
    assert len(second.mode.pieces.kinds) == 2
    assert second.value == pytest.approx(truth(17, 17.6, 1, sadowsky), abs=1e-7)


def test_a_rod_is_a_law_of_this_family() -> None:
    """At delta = 1: tip load x with J_{-1/4}(x / 2) = 0; own weight 12.85376332."""
    (found,) = loads(TIP, "variational, delta: 1", 6)
    exact = 2 * mp.findroot(lambda x: mp.besselj(-0.25, x), 2.0)
    assert found.value == pytest.approx(float(exact), abs=1e-9)
    (found,) = loads(WEIGHT, "variational, delta: 1", 15)
    assert found.value == pytest.approx(12.85376332, abs=1e-8)


@pytest.mark.parametrize("states", ["reduced", "planar"])
@pytest.mark.parametrize(
    ("law", "bending"),
    [("sadowsky", 1.0), ("variational, delta: 0.1", 1.0), ("regularized, epsilon: 0.01", 1.01)],
)
def test_columns_buckle_as_eulers(law: str, bending: float, states: str) -> None:
    this = loads_scene((COLUMN + "states: {states}\n").format(law=law, states=states))
    found = [one.value for one in buckling_loads(this, "parameters.P", 1, 30)]
    expected = np.pi**2 / 4 * bending * np.array([1.0, 9.0])
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_loads_the_other_way_and_of_other_units() -> None:
    (found,) = buckling_loads(scene(TIP, "sadowsky"), "parameters.P", -1, -8)
    assert found.value == pytest.approx(-6.729347255, abs=1e-8)
    # D w = Y h^3 w / (12 (1 - nu^2)); force in units of D w / L^2
    L, w, h, Y, nu = 0.3, 0.01, 1e-4, 2e9, 0.25
    unit = Y * h**3 * w / (12 * (1 - nu**2)) / L**2
    material = f"youngs_modulus: {Y}, poisson_ratio: {nu}"
    sizes = f"ribbon: {{length: {L}, width: {w}, thickness: {h}, {material}}}\n"
    si = loads_scene(TIP.format(law="sadowsky").replace("P: 1", f"P: {unit}") + sizes)
    (found,) = buckling_loads(si, "parameters.P", unit, 8 * unit)
    assert found.value / unit == pytest.approx(6.729347255, abs=1e-8)


def test_a_straight_state_that_is_not_affine_in_what_moves() -> None:
    """A force P^2 along the width, so that P is the root of the load."""
    text = TIP.format(law="sadowsky").replace("y: P", "y: P**2")
    (found,) = buckling_loads(loads_scene(text), "parameters.P", 1, 3)
    assert found.value**2 == pytest.approx(6.729347255, abs=1e-7)


@pytest.mark.parametrize("law", ["sadowsky", "variational, delta: 0.1"])
def test_a_mode_is_a_guess_for_the_buckled_ribbon(law: str) -> None:
    this = scene(TIP, law)
    (found,) = buckling_loads(this, "parameters.P", 1, 8)
    prepared = prepare(this)
    sides = []
    for share in (1.01, 1.02, 1.04):
        beyond = with_value(this, "parameters.P", share * found.value)
        buckled = prepared.solve(beyond, guess=found.guess(0.1), fallback=False)
        assert buckled.verified
        sides.append(float(buckled.sample(1.0, "dot(r, ex)")))
    # A pitchfork: the square of the deflection grows as the load does.
    slopes = np.array(sides) ** 2 / [0.01, 0.02, 0.04]
    assert np.abs(sides).min() > 0.05
    np.testing.assert_allclose(slopes, slopes[0], rtol=0.1)


def test_shapes_of_a_mode() -> None:
    (found,) = loads(TIP, "variational, delta: 0.1", 8)
    f = np.linspace(0, 1, 51)
    straight, small, large = (found.guess(a).fields(f) for a in (0.0, 1e-6, 2e-6))
    np.testing.assert_allclose(straight.r, np.outer(f, [0, 0, 1]), atol=1e-12)
    assert np.abs(small.r - straight.r).max() == pytest.approx(1e-6, rel=1e-5)
    np.testing.assert_allclose(large.r - straight.r, 2 * (small.r - straight.r), atol=1e-11)
    # x' = w2 of the deflection, which is the turn of d3.
    slope = np.gradient(small.r[:, 0], f, edge_order=2)
    np.testing.assert_allclose(small.frames[:, 0, 2], slope, atol=1e-8)


@pytest.mark.parametrize(
    ("law", "text"), [("kirchhoff", TIP), ("sadowsky", TIP.replace("x: 0", "x: 0.1"))]
)
def test_what_has_a_linearisation_is_refused(law: str, text: str) -> None:
    with pytest.raises(ModelError, match="branch points"):
        loads(text, law, 8)
