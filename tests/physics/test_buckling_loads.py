"""Buckling under loads along a ribbon and at single places: columns, strips on edge.

Truth: zeros of Bessel functions, and the linearised equations written out here, by DOP853. A strip
along z bears f(s) = -m1 of loads along its width y; an infinitesimal deflection with the turn w3
about its axis has m2 = f w3, w3' = u3*, m3' = -f u2*, without moment where nothing acts beyond.
"""

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ribbonopt.checks.stability import negative_directions
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import Scene, load_scene, loads_scene
from ribbonopt.scene.lens import with_value
from ribbonopt.studies.buckling.buckling import buckling_loads
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, BUCKLING, POINT

SCENE = """
name: buckling
law: {{type: {law}}}
parameters: {{q: {q}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free}}
tolerance: 1e-9
record: {{side: "dot(r, ex) at 1"}}
{more}
"""
DOWN = "loads: {force: {z: -q}}"  # a column that bears its own weight
ON_EDGE = "loads: {force: {y: q}}"  # a strip that bears its own weight along its width
PLANAR = "states: planar\n"


def scene(law: str, *more: str, q: float = 1.0) -> Scene:
    return loads_scene(SCENE.format(law=law, q=q, more="\n".join(more)))


def first_load(scene: Scene, end: float) -> float:
    first, *_ = buckling_loads(scene, "parameters.q", 1, end)
    return first.value


def greenhill() -> float:
    """Load q L^3 / B at which a clamped column buckles by its own weight."""
    return 9 / 4 * float(mp.findroot(lambda x: mp.besselj(mp.mpf(-1) / 3, x), 1.87)) ** 2


def on_edge(P: float, arm: Callable[[float], float], power: int, ends: list[float]) -> float:
    """w3 at the clamp, by Sadowsky's law, of a strip of width w(s) that bears f = P arm(s).

    `ends` are places between which arm is smooth, the first of them where it is zero, as
    (distance from there)^power / power.
    """

    def rates(s: float, y: np.ndarray) -> list[float]:
        f = P * arm(s)
        m2, m3 = f * y[0] / width(s), y[1] / width(s)
        M = np.hypot(m2, m3)
        return [m3 * (m2 + M) / (4 * M), -f * (m2 + M) ** 2 / (4 * M)]

    t, there = 1e-4, width(ends[0])
    y = np.array([1.0, P**2 / power**2 / there * t ** (2 * power + 1) / (2 * power + 1)])
    for a, b in zip([ends[0] - t, *ends[1:-1]], ends[1:], strict=True):
        y = solve_ivp(rates, (a, b), y, "DOP853", rtol=1e-12, atol=1e-15).y[:, -1]
    return float(y[0])


def width(s: float) -> float:
    return 1.0


# Strips on edge.


@pytest.mark.parametrize("law", ["sadowsky", "variational, delta: 0.1"])
def test_a_force_at_a_single_place_buckles_what_is_before_it(law: str) -> None:
    """As a tip load does a shorter strip: P a^2 is the same for all a."""
    at_tip = loads_scene(
        SCENE.format(law=law, q=1, more="").replace(
            "support: free", "support: free, force: {x: 0, y: q, z: 0}"
        )
    )
    found = first_load(scene(law, "loads: {points: [{at: 0.3, force: {y: q}}]}"), 100)
    assert 0.3**2 * found == pytest.approx(first_load(at_tip, 8), abs=1e-9)


def test_own_weight_and_a_force_at_a_single_place() -> None:
    def arm(s: float) -> float:
        return (1 - s) ** 2 / 2 + max(0.37 - s, 0.0)

    this = scene("sadowsky", "loads: {force: {y: q}, points: [{at: 0.37, force: {y: q}}]}")
    expected = brentq(on_edge, 15, 16.5, (arm, 2, [1, 0.37, 0]), xtol=1e-12)
    assert first_load(this, 20) == pytest.approx(expected, abs=5e-9)


def test_a_tapered_strip_under_its_own_weight(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(globals(), "width", lambda s: 1 - 0.9 * s)
    expected = brentq(on_edge, 16, 17.5, (lambda s: (1 - s) ** 2 / 2, 2, [1, 0]), xtol=1e-12)
    found = first_load(scene("sadowsky", ON_EDGE, "width: 1 - 0.9*s"), 20)
    assert found == pytest.approx(expected, abs=1e-8)


def test_a_weight_that_fades_towards_the_tip() -> None:
    """q (1 - s) along the width; the same by a formula whose integral is no closed form."""
    expected = brentq(on_edge, 80, 95, (lambda s: (1 - s) ** 3 / 6, 3, [1, 0]), xtol=1e-12)
    assert first_load(scene("sadowsky", "loads: {force: {y: q*(1 - s)}}"), 100) == pytest.approx(
        expected, abs=2e-8
    )
    same = "loads: {force: {y: q*exp(log(1.0001 - s))}}"
    found = first_load(scene("variational, delta: 0.1", same), 100)
    near = first_load(scene("variational, delta: 0.1", "loads: {force: {y: q*(1.0001 - s)}}"), 100)
    assert found == pytest.approx(near, rel=1e-9)


@pytest.mark.parametrize(
    ("load", "printed"),
    [(ON_EDGE, 22.0167761285), ("loads: {points: [{at: 1, force: {y: q}}]}", 6.8988862429)],
    ids=["own weight", "tip load"],
)
def test_a_buckled_strip_is_that_of_shooting(load: str, printed: float) -> None:
    """The quaternion of the tip has q3 = 0.08 there (shooting of order 8, SCIENCE-NEXT 7)."""
    text = SCENE.format(law="sadowsky", q=1, more="" if "points" in load else load)
    if "points" in load:
        text = text.replace("support: free", "support: free, force: {x: 0, y: q, z: 0}")
    this = loads_scene(text)
    (mode,) = buckling_loads(this, "parameters.q", 0.8 * printed, 1.2 * printed)
    there = with_value(this, "parameters.q", printed)
    found = prepare(there).solve(guess=mode.guess(0.2), fallback=False)
    assert found.verified
    d1, d2, d3 = (found.sample(1.0, name) for name in ("d1", "d2", "d3"))
    q0 = np.sqrt(1 + d1[0] + d2[1] + d3[2]) / 2
    assert abs(d1[1] - d2[0]) / (4 * q0) == pytest.approx(0.08, abs=1e-8)
    assert negative_directions(found) == 0


def test_the_clamp_of_a_strip_on_edge_has_the_strains_of_its_side() -> None:
    """m2 = 0 there, where Sadowsky's strains leap from -|m3| / 4 to |m3| / 4."""
    this = scene("sadowsky", ON_EDGE)
    (mode,) = buckling_loads(this, "parameters.q", 20, 22)
    prepared = prepare(this)
    for side, q in itertools.product((1, -1), (21.55, 22.3, 23.1, 26.0)):
        there = with_value(this, "parameters.q", q)
        found = prepared.solve(there, guess=mode.guess(0.3 * side), fallback=False)
        assert found.verified
        m2, m3, u2 = (found.sample([0.0, 1e-3], name) for name in ("m2", "m3", "u2"))
        assert abs(m2[0]) < 1e-12 * abs(m3[0])
        assert u2[0] == pytest.approx(np.sign(m2[1]) * abs(m3[0]) / 4, rel=1e-9)
        assert summarize(found)["error_estimate"]["u0"] < 1e-8


def test_branches_leave_the_straight_strip_by_both_of_its_modes() -> None:
    """The second has m2 of both signs: it begins in two phases, with one negative direction."""
    stage = "continuation: {parameter: parameters.q, from: 20, to: 56, largest: 6, switch: true}"
    points = list(Continuation(scene("sadowsky", ON_EDGE, stage, q=20)))
    loads = [value_of(point.row) for point in points if point.kind == BUCKLING]
    second = brentq(turn_of_second, 52, 54, xtol=1e-12)
    assert loads == pytest.approx([21.49065961, second], abs=2e-8)
    for branch in (1, 2, 3, 4):
        rows = [point.row for point in points if point.branch == branch]
        assert value_of(rows[0]) == pytest.approx(loads[(branch - 1) // 2], abs=0.01)
        assert value_of(rows[-1]) == 56
        assert {row["negative"] for row in rows} == {(branch - 1) // 2}
        assert all(row["error"] <= 1e-9 and row["note"] == "" for row in rows)
    ends = [point for point in points if point.branch and value_of(point.row) == 56]
    assert sorted(len(end.solution.sheets) for end in ends) == [1, 1, 2, 2]
    sides = [end.row["side"] for end in ends]
    assert sides[::2] == pytest.approx([-side for side in sides[1::2]], rel=1e-7)


def turn_of_second(P: float) -> float:
    """w3 at the clamp as by `on_edge`, Sadowsky's law of the other side behind the zero of w3."""

    def rates(s: float, y: np.ndarray, side: float) -> list[float]:
        f = P * (1 - s) ** 2 / 2
        m2, m3 = f * y[0], y[1]
        M = np.hypot(m2, m3)
        return [m3 * (side * m2 + M) / (4 * M), -f * side * (side * m2 + M) ** 2 / (4 * M)]

    def zero(s: float, y: np.ndarray, side: float) -> float:
        return float(y[0])

    zero.terminal = True  # type: ignore[attr-defined]
    t, exact = 1e-4, {"method": "DOP853", "rtol": 1e-12, "atol": 1e-15}
    y = np.array([1.0, P**2 / 4 * t**5 / 5])
    found: Any = solve_ivp(rates, (1 - t, 0), y, args=(1.0,), events=zero, **exact)
    s, y = found.t[-1], found.y[:, -1]
    h = 1e-9  # over the zero, by a step that the event does not see
    y = y - h * np.array(rates(s, y, -1.0))
    return float(solve_ivp(rates, (s - h, 0), y, args=(-1.0,), **exact).y[0, -1])


# Columns.


@pytest.mark.parametrize("states", ["", PLANAR], ids=["space", "planar"])
def test_a_heavy_column_has_the_load_of_bessel_functions(states: str) -> None:
    found = first_load(scene("sadowsky", DOWN, states), 10)
    assert found == pytest.approx(greenhill(), abs=1e-9)


@pytest.mark.parametrize(
    ("law", "states"),
    [("kirchhoff", PLANAR), ("kirchhoff, B2: 1, B3: 1", "")],
    ids=["planar", "space"],
)
def test_a_heavy_column_loses_its_stability_where_a_branch_crosses(law: str, states: str) -> None:
    stage = "continuation: {parameter: parameters.q, from: 7, to: 9, largest: 1, switch: true}"
    points = list(Continuation(scene(law, DOWN, states, stage, q=7)))
    (crossing,) = [point for point in points if point.kind == BRANCH_POINT]
    assert value_of(crossing.row) == pytest.approx(greenhill(), abs=1e-9)
    straight = [p.row for p in points if p.branch == 0 and p.kind == POINT]
    for row in straight:
        assert row["negative"] == (value_of(row) > greenhill())
    buckled = [p.row for p in points if p.branch]
    assert {row["negative"] for row in buckled} == {0}
    ends = sorted(row["side"] for row in buckled if value_of(row) == 9)
    assert ends[0] == pytest.approx(-ends[1], rel=1e-7)


@pytest.mark.parametrize("law", ["kirchhoff", "sadowsky"])
def test_a_buckled_column_is_that_of_shooting(law: str) -> None:
    """At q = 12, as SCIENCE-NEXT prints it."""
    stage = "continuation: {parameter: parameters.q, from: 7.5, to: 12, largest: 2, switch: true}"
    points = list(Continuation(scene(law, DOWN, PLANAR, stage, q=7.5)))
    kinds = {point.kind for point in points} - {POINT}
    assert kinds == {BRANCH_POINT if law == "kirchhoff" else BUCKLING}
    ends = [p.solution for p in points if p.branch and value_of(p.row) == 12]
    assert len(ends) == 2
    for found in ends:
        x, _, z = found.sample(1.0, "r")
        assert abs(x) == pytest.approx(0.849526933032, abs=2e-11)
        assert z == pytest.approx(0.162135277437, abs=2e-11)
        assert abs(found.sample(0.0, "m2")) == pytest.approx(4.48427846387, abs=2e-10)


def test_a_column_on_a_support_between_its_ends() -> None:
    """x' = w, w' = m, m' = -q (1 - s) w - R before the support, where x = 0."""

    def determinant(q: float) -> float:
        def rates(s: float, y: np.ndarray, R: float) -> list[float]:
            return [y[1], y[2], -q * (1 - s) * y[1] - R]

        exact: dict[str, Any] = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}
        columns = []
        for m, R in ((1.0, 0.0), (0.0, 1.0)):
            before = solve_ivp(rates, (0, 0.6), [0, 0, m], args=(R,), **exact).y[:, -1]
            behind = solve_ivp(rates, (0.6, 1), before, args=(0.0,), **exact).y[:, -1]
            columns.append([before[0], behind[2]])
        return float(np.linalg.det(columns))

    expected = brentq(determinant, 40, 42, xtol=1e-12)
    support = "supports: [{at: 0.6, position: {x: 0}}]"
    for more in (PLANAR, PLANAR + "formulation: energy"):
        found = first_load(scene("sadowsky", DOWN, support, more), 60)
        assert found == pytest.approx(expected, abs=5e-9)


def test_a_column_that_a_support_in_the_middle_bears() -> None:
    """The reaction q is there before it buckles: w'' = n w, n = q s before it and q (s - 1) behind.

    The clamp slides up and down.
    """

    def slope(q: float) -> float:
        y = np.array([0.0, 1.0])
        for a, b, off in ((0, 0.5, 0.0), (0.5, 1, 1.0)):
            found = solve_ivp(
                lambda s, y, off: [y[1], q * (s - off) * y[0]],
                (a, b),
                y,
                "DOP853",
                args=(off,),
                rtol=1e-12,
                atol=1e-14,
            )
            y = found.y[:, -1]
        return float(y[1])

    this = loads_scene(
        SCENE.format(law="sadowsky", q=1, more=DOWN).replace(
            "{support: clamped, position: [0, 0, 0], directors: identity}",
            "{position: {x: 0, y: 0}, directors: identity, force: {z: 0}}",
        )
        + "supports: [{at: 0.5, position: {z: 0.5}}]\nstates: planar\n"
    )
    expected = brentq(slope, 10, 40, xtol=1e-12)
    assert first_load(this, 40) == pytest.approx(expected, abs=5e-9)


def test_a_place_and_a_width_may_be_what_moves() -> None:
    """A force 30 at the place a: 30 a^2 is the load of a tip; beyond w = 1 - q s there is none."""
    at = "loads: {points: [{at: q, force: {y: 30}}]}"
    (moved,) = buckling_loads(scene("sadowsky", at, q=0.3), "parameters.q", 0.3, 0.6)
    assert 30 * moved.value**2 == pytest.approx(6.729347255, abs=2e-9)
    tapered = scene("sadowsky", "loads: {force: {y: 20}}", "width: 1 - q*s", q=0.1)
    (found,) = buckling_loads(tapered, "parameters.q", 0.1, 0.9)
    same = scene("sadowsky", ON_EDGE, f"width: 1 - {found.value!r}*s")
    assert first_load(same, 24) == pytest.approx(20, abs=1e-8)


# A rod on edge.


def test_a_heavy_rod_on_edge_buckles_where_bessel_functions_say() -> None:
    """w3'' = -(q t^2 / 2)^2 w3 / (B2 B3): J_{-1/6}(q / (6 sqrt(B2 B3))) = 0."""
    exact = 6 * float(mp.findroot(lambda x: mp.besselj(mp.mpf(-1) / 6, x), 2.1))
    assert exact == pytest.approx(12.85376332, abs=5e-9)
    stage = "continuation: {parameter: parameters.q, from: 12, to: 24, largest: 4, switch: false}"
    points = list(Continuation(scene("kirchhoff, B2: 2, B3: 1.3", ON_EDGE, stage, q=12)))
    (crossing,) = [point for point in points if point.kind == BRANCH_POINT]
    load = exact * np.sqrt(2 * 1.3)
    assert value_of(crossing.row) == pytest.approx(load, abs=1e-8)
    for row in (p.row for p in points if p.kind == POINT):
        assert row["negative"] == (value_of(row) > load)


def test_the_strip_of_the_shipped_scene_in_si(configs: Path) -> None:
    """At density h w g = 21.49065961 Dw / L^3, and on earth it is one of the buckled ones."""
    this = load_scene(configs / "lateral_buckling_si.yaml")
    (found,) = buckling_loads(this, "parameters.g", 5, 20)
    sizes = this.ribbon
    assert sizes is not None and sizes.density is not None
    stiffness = sizes.youngs_modulus * sizes.thickness**2 / 12 / (1 - sizes.poisson_ratio**2)
    unit = stiffness / (sizes.density * sizes.length**3)
    assert found.value / unit == pytest.approx(21.49065961, abs=1e-7)
    hanging = prepare(this).solve()
    assert hanging.verified and negative_directions(hanging) == 0
    assert abs(hanging.sample(0.2, "dot(r, ey)")) > 0.1


# A ring.

RING = """
name: ring
law: {{type: kirchhoff, B2: 1, B3: {B3}}}
parameters: {{k: 5}}
natural: {{curvature: 2*pi*k}}
interval: [0, 0.5]
boundary: {{loop: {{half_twists: 0, piece: half}}}}
guess: circle
tolerance: 1e-9
continuation: {{parameter: parameters.k, from: {low}, to: {high}, switch: false}}
"""


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_a_ring_of_a_curved_rod_opens_where_it_is_said_to(nu: float) -> None:
    """Covered once it is flat up to 1 + 3 B3 of its curvature: at k = 2 of SCIENCE-NEXT 2c."""
    exact = 1 + 3 * 2 / (1 + nu)
    text = RING.format(B3=2 / (1 + nu), low=exact - 0.4, high=exact + 0.4)
    points = list(Continuation(loads_scene(text)))
    (crossing,) = [point for point in points if point.kind == BRANCH_POINT]
    assert value_of(crossing.row) == pytest.approx(exact, abs=1e-8)
    counts = [(value_of(p.row), p.row["negative"]) for p in points if p.kind == POINT]
    assert all(count == (value > exact) for value, count in counts) and len(counts) > 2
