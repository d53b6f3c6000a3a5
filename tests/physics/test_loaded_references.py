"""Loads along the ribbon: numbers of two methods that share no equations, by every formulation."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ribbonopt import Continuation, buckling_loads, dump_scene, save_solution
from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.checks.stability import negative_directions, why_not
from ribbonopt.errors import ModelError
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import Scene, load_scene, loads_scene
from ribbonopt.solution.potential import potential
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.recorded import value_of

Array = np.ndarray
EQUATIONS = ("inverted", "algebraic", "differentiated")
each_form = pytest.mark.parametrize("form", [*EQUATIONS, "energy"])
each_equation = pytest.mark.parametrize("form", EQUATIONS)
DIGITS = 6e-11  # references have ten decimals
FREE = "{support: free}"
CLAMP_C = """{support: clamped, position: [0.68, 0.15, 0.31],
        directors: {rotation_vector: [0, 2.4, 0.6]}}"""


def ribbon(loads: str, end: str = FREE, form: str = "inverted", **more: Any) -> Scene:
    """Return a ribbon clamped at the origin along z, under loads."""
    mesh = "{type: collocation, degree: 8, intervals: 16}"
    rest = {"law": "{type: sadowsky}", "states": "reduced", "transcription": mesh} | more
    return loads_scene(
        f"""
name: loaded
formulation: {form}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {end}
loads: {loads}
"""
        + "".join(f"{key}: {value}\n" for key, value in rest.items())
    )


def covered(found: Solution, name: str, value: Any, reference: Any) -> None:
    """Assert that a value is the reference to its digits, and as near as its bar says."""
    off = np.abs(np.asarray(value) - reference).max()
    assert off < DIGITS
    if not found.problem.recovered:
        assert off < estimate_error(found)[name] + DIGITS


# Planar: W = u2^2 / 2, the clamp along z, loads along -x or -z.

HEAVY = {5: -0.55803344042, 50: -17.0738188486}


@pytest.mark.parametrize("q", HEAVY)
@pytest.mark.parametrize("form", ["inverted", "energy"])
def test_potential_of_the_heavy_cantilever(q: float, form: str) -> None:
    found = solve(ribbon(f"{{force: {{x: -{q}}}}}", form=form))
    covered(found, "potential", potential(found), HEAVY[q])


@pytest.mark.parametrize("load", ["-12", "'-12 + 0*sin(s)'", "{s: [0, 1], values: [-12, -12]}"])
@pytest.mark.parametrize(("form", "states"), [("inverted", "planar"), ("energy", "reduced")])
def test_a_heavy_column_has_fallen_over(load: str, form: str, states: str) -> None:
    found = solve(ribbon(f"{{force: {{z: {load}}}}}", form=form, states=states))
    assert found.verified
    tip = np.abs(found.sample(1.0, "r"))[[0, 2]]
    covered(found, "states", tip, (0.849526933032, 0.162135277437))
    covered(found, "m0", abs(found.sample(0.0, "m2")), 4.48427846387)
    covered(found, "potential", potential(found), 5.283036846566)
    assert negative_directions(found) == 0


@pytest.mark.parametrize("load", ["-{q}", "'-{q} + 0*sin(s)'"])
def test_it_falls_over_at_its_critical_weight(load: str) -> None:
    for q, negative in ((7.83, 0), (7.84, 1)):  # Greenhill: 7.83734743894
        force = f"{{force: {{z: {load.format(q=q)}}}}}"
        found = solve(ribbon(force, law="{type: kirchhoff}", guess="{strains: [0, 0]}"))
        assert np.abs(found.sample(1.0, "r") - [0, 0, 1]).max() < 1e-12
        assert negative_directions(found) == negative


@pytest.mark.parametrize("load", ["-q", "'-q*exp(0*s)'"])
@pytest.mark.parametrize("law", ["{type: variational, delta: 0.1}", "{type: sadowsky}"])
def test_its_critical_weight_is_that_of_bessel(law: str, load: str) -> None:
    more = {"guess": "{strains: [0, 0]}", "parameters": "{q: 5}"}
    (found,) = buckling_loads(
        ribbon(f"{{force: {{z: {load}}}}}", law=law, **more), "parameters.q", 5, 10
    )
    assert found.value == pytest.approx(7.83734743894348, abs=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("states", ["reduced", "planar"])
def test_a_heavy_rod_leaves_the_vertical_there(states: str) -> None:
    stage = "{parameter: parameters.q, to: 8.5, switch: true, largest: 0.5}"
    more = {"guess": "{strains: [0, 0]}", "parameters": "{q: 7}", "continuation": stage}
    scene = ribbon("{force: {z: -q}}", law="{type: kirchhoff}", states=states, **more)
    rows = [one.row for one in Continuation(scene)]
    (buckled,) = [row for row in rows if row["kind"] == "branch point"]
    assert value_of(buckled) == pytest.approx(7.83734743894348, abs=1e-8)
    sides = [
        (row["branch"], value_of(row) > 7.84, row["negative"]) for row in rows if row is not buckled
    ]
    assert set(sides) == {(0, False, 0), (0, True, 1), *((b, up, 0) for b, up, _ in sides if b)}


@pytest.mark.parametrize("form", ["inverted", "energy"])
def test_the_work_of_loads_at_places_counts(form: str) -> None:
    end = "{support: free, force: [-1, 0, 0]}"
    found = solve(ribbon("{points: [{at: 0.5, force: [-2, 0, 0]}]}", end, form))
    assert found.verified
    covered(found, "potential", potential(found), -0.417310998215)


@pytest.mark.slow
def test_loads_of_all_kinds_by_all_formulations() -> None:
    """Along the ribbon without a closed form, at places, and an energy to tell them together."""
    point = "points: [{at: 0.5, force: [0, 3, 0]}, {at: 0.7, force: {x: -2}}]"
    load = f"{{force: {{z: '-4*exp(s)'}}, {point}}}"
    one, other = (solve(ribbon(load, CLAMP_C, form)) for form in ("inverted", "energy"))
    for found in (one, other):
        assert found.verified
        assert negative_directions(found) == 0
        assert summarize(found)["conserved"] == {}
    np.testing.assert_allclose(one.n0, other.n0, atol=1e-8)
    assert potential(one) == pytest.approx(potential(other), abs=1e-10)


SPAN = "{support: clamped, position: [0, 0, 0.6], directors: identity}"


@each_form
def test_a_strip_hangs_between_two_clamps(form: str) -> None:
    found = solve(ribbon("{force: {x: -20}}", SPAN, form))
    assert found.verified
    covered(found, "n0", found.n0, (-10, 0, -46.8051307226))
    covered(found, "m0", found.sample(0.0, "m2"), -9.3200784860)
    covered(found, "states", found.sample(0.5, "dot(r, ex)"), -0.349660666208)
    covered(found, "potential", potential(found), 14.155784141498)


@pytest.mark.slow
def test_hanging_and_arched_are_found_by_starts(configs: Path) -> None:
    found = solve(load_scene(configs / "hanging_strip.yaml"))
    all_ = (found, *found.others)
    middles = [one.sample(0.5, "dot(r, ez)") for one in all_]
    assert middles[0] == pytest.approx(-0.349660666208, abs=1e-9)
    assert potential(found) == pytest.approx(14.155784141498, abs=1e-8)
    assert max(middles) > 0.3
    told = [potential(one) for one in all_]
    assert told == sorted(told)
    assert "equilibria, by potential" in report(summarize(found))


@pytest.mark.slow
def test_an_arch_loses_its_stability_where_it_may_lean_to_a_side() -> None:
    """Two ways to the same weight: singular equations, and the inertia of the second variation."""
    stage = "{parameter: parameters.q, to: 200, stop: [fold], largest: 10}"
    bowed = "{support: clamped, position: [0, 0, 0.9], directors: identity}"
    more = {"states": "planar", "parameters": "{q: 0}", "continuation": stage}
    law = "{type: variational, delta: 0.1}"
    *points, last = (
        one.row for one in Continuation(ribbon("{force: {x: -q}}", bowed, law=law, **more))
    )
    assert last["kind"] == "fold"
    (side,) = [row["number"] for row in points if row["kind"] == "branch point"]
    negative = [row["negative"] for row in points]
    assert negative == [0] * side + [None] + [1] * (len(points) - side - 1)


TAPERED = ["-5*(1 - 0.7*s)", "-5*(1 - 0.7*s) + 0*sin(s)", "{s: [0, 1], values: [-5, -1.5]}"]


@pytest.mark.parametrize("weight", TAPERED)
@pytest.mark.parametrize(("form", "states"), [("inverted", "planar"), ("energy", "reduced")])
def test_a_tapered_strip_bears_its_own_weight(weight: str, form: str, states: str) -> None:
    load = weight if weight.startswith("{") else f"'{weight}'"
    found = solve(
        ribbon(f"{{force: {{x: {load}}}}}", form=form, states=states, width="'1 - 0.7*s'")
    )
    assert found.verified
    covered(found, "states", found.sample(1.0, "r")[[0, 2]], (-0.326452366854, 0.936274162831))
    covered(found, "m0", found.sample(0.0, "m2"), -1.28159628887)


# Clamp C: a Sadowsky ribbon in space.

COUPLE = (
    "{couple: [0, 1.5, 0.5]}",
    (-4.4581107192, -5.5622614721, -0.4653804234),
    (3.5560629400, 1.8253131263, -0.1311663744),
    (2.6145039375, 0.8401219420),
)
PRESSURE = (
    "{pressure: 8}",
    (-3.4489154847, -4.8918439300, -5.3525944828),
    (3.2151020023, 1.7627574234, -0.1085666133),
    (2.6206831018, 0.8408084000),
)
FORCE = (
    "{force: [2, 4, -4]}",
    (-4.1881657369, -3.0727523281, -4.7864697120),
    (2.8470743636, 1.7145038741, -0.0415239075),
    (2.6038842867, 0.8392531311),
)
VARIED = ("{force: [2, '4 + 0*sin(s)', {s: [0, 1], values: [-4, -4]}]}", *FORCE[1:])
ROWS = [COUPLE, PRESSURE, FORCE, VARIED]
each_row = pytest.mark.parametrize("row", ROWS, ids=["couple", "pressure", "force", "varied"])


@each_row
@each_equation
def test_clamps_under_loads_from_nothing(row: tuple[Any, ...], form: str) -> None:
    check(solve(ribbon(row[0], CLAMP_C, form)), row)


@each_row
def test_clamps_under_loads_by_the_papers_states(row: tuple[Any, ...]) -> None:
    check(solve(ribbon(row[0], CLAMP_C, states="full")), row)


@pytest.mark.parametrize("row", [FORCE, VARIED], ids=["force", "varied"])
def test_clamps_under_dead_forces_by_the_energy(row: tuple[Any, ...]) -> None:
    found = solve(ribbon(row[0], CLAMP_C, "energy"))
    check(found, row)
    assert potential(found) == pytest.approx(3.885127825565, abs=1e-11)


def check(found: Solution, row: tuple[Any, ...]) -> None:
    _, n0, m0, u = row
    assert found.verified, found.message
    covered(found, "n0", found.n0, n0)
    covered(found, "m0", found.m0, m0)
    covered(found, "u", found.sample(0.5, "u")[1:], u)


@pytest.mark.parametrize(
    ("row", "kept", "values"),
    [
        (COUPLE, ["n", "e x (m + r x n)"], {}),
        (PRESSURE, ["H"], {"H": -3.7959923331}),
        (FORCE, ["H + f.r", "e.(m + r x n)", "e x n"], {"H + f.r": -3.3162769178}),
    ],
    ids=["couple", "pressure", "force"],
)
def test_what_loads_leave_constant_is_told_by_name(
    row: tuple[Any, ...], kept: list[str], values: dict[str, float], tmp_path: Path
) -> None:
    found = solve(ribbon(row[0], CLAMP_C))
    drift = dict(found.verification.drift)
    assert drift.pop("orthonormality") < 1e-13
    assert [name for name, value in drift.items() if value == value] == kept
    assert max(drift[name] for name in kept) < 1e-12
    told = summarize(found)["conserved"]
    for name, value in values.items():
        assert told[name] == pytest.approx(value, abs=DIGITS)
    if "e.(m + r x n)" in told:
        assert abs(told["e.(m + r x n)"]) == pytest.approx(2.1197099756, abs=DIGITS)
    text = report(summarize(found))
    assert ("invariant H(0)" in text) == ("H" in kept)
    save_solution(found, tmp_path)


def test_what_varies_leaves_less() -> None:
    drift = solve(ribbon("{force: [1, 's', 0], couple: [0, 0, 1]}", CLAMP_C)).verification.drift
    assert [name for name, value in drift.items() if value == value] == ["orthonormality"]


@pytest.mark.parametrize(
    ("load", "why"),
    [
        ("pressure: 8", "loads.pressure follows the ribbon"),
        ("couple: [0, 1, 0]", "loads.couple keeps its direction while sections turn, so that"),
    ],
)
def test_what_has_no_potential_is_refused_where_energy_is_minimised(load: str, why: str) -> None:
    with pytest.raises(ModelError, match=f"formulation energy: {why}"):
        prepare(ribbon(f"{{{load}}}", CLAMP_C, "energy"))
    found = solve(ribbon(f"{{{load}}}", CLAMP_C))
    assert potential(found) is None
    assert summarize(found)["potential"] is None
    assert negative_directions(found) is None
    assert why in why_not(found)


@pytest.mark.slow
def test_a_load_is_continued_from_none() -> None:
    for path, row in (("loads.pressure", PRESSURE), ("loads.force.z", FORCE)):
        scene = ribbon(row[0], CLAMP_C)
        to = 8.0 if "pressure" in path else -4.0
        begin = dump_scene(scene).replace("8.0", "0.0") if to == 8 else dump_scene(scene)
        stage = f"continuation: {{parameter: {path}, from: 0, to: {to}}}\n"
        *_, last = Continuation(loads_scene(begin + stage))
        assert value_of(last.row) == to
        np.testing.assert_allclose(last.solution.n0, row[1], atol=1e-7)
        assert (last.row["potential"] is None) == (to == 8)


@pytest.mark.slow
@pytest.mark.parametrize("load", ["pressure: 60", "pressure: -100", "couple: [0, 50, 0]"])
def test_large_followers_are_brought_on(load: str) -> None:
    found = solve(ribbon(f"{{{load}}}", CLAMP_C, tolerance="1e-8"))
    assert found.verified
    assert not found.fell_back


def test_a_strip_under_pressure_in_a_plane_has_one_more_invariant() -> None:
    found = solve(ribbon("{pressure: 6}", states="planar"))
    drift = found.verification.drift
    assert max(drift[name] for name in ("n^2/2 - p m2", "H")) < 1e-12
    # At the free end nothing is left.
    assert abs(summarize(found)["conserved"]["n^2/2 - p m2"]) < 1e-12


def test_a_load_that_leaves_the_plane_somewhere_is_refused() -> None:
    for load in ("{force: {y: s}}", "{couple: {x: s}}"):
        with pytest.raises(ModelError, match="leads out of the plane"):
            prepare(ribbon(load, states="planar"))
