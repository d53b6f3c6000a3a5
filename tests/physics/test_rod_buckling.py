"""Where rods buckle by twist: Michell's ring, and a straight rod between clamps.

Of an isotropic rod modes come in pairs, turned about the axis; a half that is held on an axis of
two-fold symmetry has one of each. Branch points there, against the homogeneous problem below.
"""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ribbonopt import loads_scene, solve
from ribbonopt.checks.stability import negative_range, second_variation
from ribbonopt.studies.continuation.continuation import Continuation

ZAJAC = 2 * np.pi * np.sqrt(3)  # total twist, times B1 / B3
GREENHILL = 2 * float(brentq(lambda x: np.tan(x) - x, 4.4, 4.6, xtol=1e-15))  # M L / B1

#: a ring of length 1, closed without the twist that it has when free
NATURAL = """
name: ring
law: {{type: rod, B: [1, 1, {C}], natural: [0, 0, 0]}}
interval: [0, 0.5]
formulation: {form}
boundary:
  start: {{position: [0, 0, 0], directors: identity}}
  loop: {{half_twists: 0, piece: half}}
guess: {{force: [0, -{n}, 0], moment: [0, 6.283185307179586, -{m}]}}
tolerance: 1e-10
continuation: {{parameter: law.natural.d3, from: {a}, to: {b}, first: {w}, largest: {w}}}
"""
#: a ring that is cut, twisted and joined
JOINED = """
name: ring
law: {{type: rod, B: [1, 1, {C}]}}
parameters: {{twist: {a}}}
interval: [0, 0.5]
formulation: {form}
boundary:
  start: {{position: [0, 0, 0], directors: identity, force: {{d1: 0}}, moment: {{d1: 0}}}}
  end: {{position: {{y: 0, z: 0}}, d3: {{x: 0}}}}
  also: ["cos(twist/2)*dot(d2(end), ex) = -sin(twist/2)*dot(d1(end), ex)"]
guess: {{force: [0, {n}, 0], moment: [0, 6.283185307179586, {m}]}}
tolerance: 1e-10
continuation: {{parameter: parameters.twist, from: {a}, to: {b}, first: {w}, largest: {w}}}
"""
#: half of a straight rod between clamps that may come nearer, turned against one another
TURNED = """
name: torque
law: {{type: rod, B: [1, 1, {C}]}}
parameters: {{twist: {a}}}
interval: [0, 0.5]
formulation: {form}
boundary:
  start:
    support: sliding
    position: [0, 0, 0]
    along: [0, 0, 1]
    directors: {{turns: [{{z: -twist/2}}]}}
  end: {{support: flip, position: [0, 0, 0.5], axis: d1, along: [1, 0, 0]}}
guess: {{force: [0, 0, 0], moment: [0, 0, {m}]}}
tolerance: 1e-10
continuation: {{parameter: parameters.twist, from: {a}, to: {b}, first: {w}, largest: {w}}}
"""
#: the same, by the moment
MOMENT = """
name: torque
law: {{type: rod, B: [1, 1, {C}]}}
parameters: {{M: {a}}}
interval: [0, 0.5]
formulation: {form}
boundary:
  start: {{position: {{x: 0, y: 0}}, force: {{z: 0}}, d3: {{x: 0, y: 0}}, moment: {{d3: M}}}}
  end: {{support: flip, position: [0, 0, 0.5], axis: d1, along: [1, 0, 0]}}
guess: {{force: [0, 0, 0], moment: [0, 0, {m}]}}
tolerance: 1e-10
continuation: {{parameter: parameters.M, from: {a}, to: {b}, first: {w}, largest: {w}}}
"""


def branch(text: str, C: float, known: float, form: str = "inverted") -> tuple[float, list[Any]]:
    """The branch point between 0.95 and 1.05 of what is known, and the counts of all rows."""
    a, b = 0.95 * known, 1.05 * known
    m = a if "M:" in text else C * a
    numbers = {"C": C, "a": a, "b": b, "w": 0.06 * known, "m": m, "n": 2 * np.pi * m}
    this = loads_scene(text.format(form=form, **numbers))
    points = list(Continuation(this))
    (found,) = [point for point in points if point.kind == "branch point"]
    return found.position, [(p.position, p.row["negative"]) for p in points if p.kind == "point"]


SLOW = pytest.mark.slow
FORMS = ("inverted", "algebraic", "differentiated")
RINGS: list[Any] = [
    pytest.param(text, C, form, marks=() if (C, form) == (1.0, "inverted") else SLOW)
    for text in (NATURAL, JOINED)
    for C in (1.0, 0.8)
    for form in FORMS
]


@pytest.mark.parametrize(("text", "C", "form"), RINGS)
def test_michells_ring(text: str, C: float, form: str) -> None:
    known = ZAJAC / C
    found, counts = branch(text, C, known, form)
    assert found == pytest.approx(known, abs=1e-9)
    assert known == pytest.approx({1.0: 10.8827961854, 0.8: 13.6034952318}[C], abs=1e-10)
    for twist, negative in counts:
        assert negative == (0 if twist < known else 1)


@pytest.mark.parametrize("form", ["inverted", *(pytest.param(f, marks=SLOW) for f in FORMS[1:])])
def test_a_straight_rod_under_a_torque(form: str) -> None:
    assert GREENHILL == pytest.approx(8.9868189, abs=1e-7)
    found, _ = branch(MOMENT, 0.8, GREENHILL, form)
    assert found == pytest.approx(GREENHILL, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
def test_a_straight_rod_turned_at_its_clamps(form: str) -> None:
    found, counts = branch(TURNED, 0.8, GREENHILL / 0.8, form)
    assert found == pytest.approx(GREENHILL / 0.8, abs=1e-9)
    for twist, negative in counts:
        assert negative == (0 if twist < found else 1)


# the homogeneous problems, written out


def clamped_line(M: float) -> float:
    """Size of a determinant: a line of length and stiffness 1 between clamps, no thrust.

    Its tangent t (complex, across the axis) obeys t'' - i M t' = P, a constant force: it is
    a + b exp(i M s) + c s, which vanishes at both ends, and so does its integral.
    """
    e = np.exp(1j * M)
    rows = [[1, 1, 0], [1, e, 1], [1, (e - 1) / (1j * M), 0.5]]
    return float(abs(np.linalg.det(np.array(rows))))


def test_the_line_between_clamps_has_a_mode_there() -> None:
    assert clamped_line(GREENHILL) < 1e-12
    assert min(map(clamped_line, np.linspace(6.5, 8.9, 50))) > 1e-2


def off_the_ring(values: np.ndarray, twist: float, C: float) -> np.ndarray:
    """Conditions (4,) at the end of half a ring, from n2, n3, m2, m3 at the start."""

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        d, n, m = y[3:12].reshape(3, 3), y[12:15], y[15:]
        w = d.T @ (d @ m / np.array([1, 1, C]))
        return np.concatenate([d[2], *(np.cross(w, x) for x in d), 0 * n, np.cross(n, d[2])])

    n2, n3, m2, m3 = values
    start = np.concatenate([np.zeros(3), np.eye(3).ravel(), [0, n2, n3], [0, m2, m3]])
    y = solve_ivp(rates, (0, 0.5), start.astype(complex), "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    r, (d1, d2, d3) = y[:3], y[3:12].reshape(3, 3)
    joined = np.cos(twist / 2) * d2[0] + np.sin(twist / 2) * d1[0]
    return np.array([r[1], r[2], d3[0], joined])


def ring_determinant(twist: float, C: float) -> float:
    circle = np.array([2 * np.pi * C * twist, 0, 2 * np.pi, C * twist])
    assert np.abs(off_the_ring(circle, twist, C)).max() < 1e-10
    steps = 1e-20j * np.eye(4)  # derivatives by a complex step
    columns = [off_the_ring(circle + step, twist, C).imag / 1e-20 for step in steps]
    return float(np.linalg.det(np.array(columns)))


@pytest.mark.parametrize("C", [1.0, 0.8])
def test_the_ring_has_a_mode_there(C: float) -> None:
    known = ZAJAC / C
    sides = [ring_determinant(known + off, C) for off in (-1e-3, 1e-3)]
    assert sides[0] * sides[1] < 0
    # By the secant through both sides, which is off by some 1e-7 of its width.
    root = known - 1e-3 + 2e-3 * sides[0] / (sides[0] - sides[1])
    assert root == pytest.approx(known, abs=1e-6)


# the whole ring, held at one point: its rod spins


@pytest.mark.parametrize(("share", "negative"), [(0.98, 0), (1.02, 2)])
def test_the_whole_ring_on_both_sides(share: float, negative: int) -> None:
    twist = share * ZAJAC
    scene = loads_scene(f"""
name: whole
law: {{type: rod, B: [1, 1, 1]}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: [0, 0, 0], directors: {{turns: [{{z: {twist}}}]}}}}
guess: {{force: [0, {2 * np.pi * twist}, 0], moment: [0, {2 * np.pi}, {twist}]}}
tolerance: 1e-9
""")
    found = solve(scene)
    assert found.verified
    assert found.energy == pytest.approx(2 * np.pi**2 + twist**2 / 2, rel=1e-9)
    judged = second_variation(found)
    assert not isinstance(judged, str)
    assert (judged.negative, judged.spins) == (negative, True)
    assert "neutral: the rod, isotropic, turns about" in judged.verdict
    assert negative_range(found) == (negative, negative)
