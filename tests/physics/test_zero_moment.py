"""States with m2 = m3 = 0 along the ribbon: nothing is claimed that the law cannot tell.

Laws that are homogeneous of degree one have no linearisation there; what is known all the same is
the load that buckles the ribbon, where a branch of buckled ribbons leaves.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
import pytest

from ribbonopt.arrays import Array
from ribbonopt.checks.stability import negative_directions, why_not
from ribbonopt.checks.validity import warnings_of
from ribbonopt.checks.zero_moment import lacks_linearisation, unbent_share
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.loads.load import Load
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import Loads, loads_scene
from ribbonopt.scene.lens import with_value
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.files import BranchFolder
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, BUCKLING, POINT

TIP = """
name: lateral
law: {{type: {law}}}
parameters: {{P: 1}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: {{x: {x}, y: P, z: 0}}}}
tolerance: 1e-9
record: {{side: "dot(r, ex) at 1"}}
"""
COLUMN = """
name: column
law: {{type: {law}}}
parameters: {{P: 2}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: {{x: 0, y: 0, z: -P}}}}
tolerance: 1e-9
record: {{side: "dot(r, ex) at 1"}}
continuation: {{parameter: parameters.P, from: 2, to: 3, largest: 0.3, switch: true}}
"""
FOLLOWED = "continuation: {parameter: parameters.P, from: 1, to: 8, largest: 1, switch: true}\n"
HOMOGENEOUS = ["sadowsky", "variational, delta: 0.01", "regularized, epsilon: 0.001"]


def tip(law: str, x: float = 0.0, more: str = "") -> Any:
    return loads_scene(TIP.format(law=law, x=x) + more)


@pytest.mark.parametrize("law", HOMOGENEOUS)
def test_what_has_no_linearisation_has_no_error_and_no_stability(law: str) -> None:
    found = solve(tip(law))
    assert found.verified
    assert lacks_linearisation(found)
    assert negative_directions(found) is None
    assert why_not(found)
    summary = summarize(found)
    assert set(summary["error_estimate"].values()) == {None}
    (warning,) = [text for text in summary["warnings"] if "m2 = m3 = 0" in text]
    assert "along the ribbon" in warning
    assert report(summary).count("+-") == report(summary).count("+- not known")
    # It is the exact straight ribbon all the same.
    np.testing.assert_allclose(found.sample(1.0, "r"), [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(found.m0, [-1, 0, 0], atol=1e-12)


def test_all_other_states_have_one() -> None:
    for law in HOMOGENEOUS:
        bent = solve(tip(law, x=0.5))
        assert not lacks_linearisation(bent)
        assert summarize(bent)["error_estimate"]["n0"] is not None
        assert not any("m2 = m3 = 0" in text for text in warnings_of(bent))
    assert not lacks_linearisation(solve(tip("kirchhoff, B2: 1, B3: 2")))


@pytest.mark.parametrize("x", [1e-5, -1e-3])
def test_a_little_is_not_nothing(x: float) -> None:
    found = solve(tip("variational, delta: 0.1", x=x))
    assert not lacks_linearisation(found)
    # As the rod that the law is in bending alone, |side| = x / 3, to the order of x and P.
    assert negative_directions(found) == 0


@dataclass(frozen=True)
class FirstHalf(Load):
    """A force per length along x, on the first half of the ribbon."""

    q: float
    name = "loads.half"

    def numbers(self) -> dict[str, float]:
        return {"loads.half.q": self.q}

    def force(self, section: Any, theta: Any) -> ca.SX:
        return ca.vertcat(ca.if_else(section.s < 0.5, theta("loads.half.q"), 0), 0, 0)

    def symmetries(self, motions: Array) -> Array:
        return np.vstack([np.eye(3), np.zeros((3, 3))])


@pytest.mark.parametrize("law", ["sadowsky", "variational, delta: 0.1"])
def test_a_part_of_the_ribbon_is_enough(law: str) -> None:
    scene = replace(tip(law), loads=Loads(own=(FirstHalf(0.3),)), parameters={"P": 0.0})
    found = solve(replace(scene, tolerance=None))
    assert found.verified
    assert unbent_share(found, capabilities(found.scene)) == pytest.approx(0.5, abs=0.06)
    assert set(summarize(found)["error_estimate"].values()) == {None}
    assert any("% of the ribbon" in text for text in warnings_of(found))


def test_a_moment_that_fades_away_is_not_zero() -> None:
    """A ribbon pulled straight: m2 falls as exp(-sqrt(T) s), below any rounding."""
    scene = loads_scene("""
    name: pulled
    law: {type: variational, delta: 0.1}
    parameters: {T: 30}
    boundary:
      start: {support: clamped, position: [0, 0, 0], directors: {turns: [{y: 60*deg}]}}
      end: {support: free, force: [0, 0, T]}
    transcription: {type: collocation, degree: 8, intervals: 40}
    """)
    prepared = prepare(scene)
    found = prepared.solve()
    for T in np.geomspace(40, 1500, 12):
        found = prepared.solve(with_value(scene, "parameters.T", T), guess=found, fallback=False)
    assert found.verified
    m2 = np.abs(found.sample(np.linspace(0.02, 0.4, 5), "m2"))
    np.testing.assert_allclose(np.diff(np.log(m2)), -np.sqrt(1500) * 0.095, rtol=0.03)
    assert np.abs(found.sample(0.95, "m2")) < 1e-13 * 1500  # counts as zero elsewhere
    assert not lacks_linearisation(found)
    assert summarize(found)["error_estimate"]["n0"] is not None


@pytest.mark.parametrize("law", HOMOGENEOUS)
def test_a_straight_ribbon_of_any_direction(law: str) -> None:
    turned = TIP.format(law=law, x=0).replace(
        "identity", "{turns: [{x: 0.7}, {z: 1.9}, {y: -0.4}]}"
    )
    turned = turned.replace("force: {x: 0, y: P, z: 0}", "force: {d1: 0, d2: P, d3: 0}")
    found = solve(loads_scene(turned + "guess: {force: [0, 1, 0], moment: [-1, 0, 0]}\n"))
    assert found.verified
    assert np.abs(found.at_stages["u"]).max() < 1e-12
    assert lacks_linearisation(found)


def followed(text: str) -> tuple[Continuation, list[Any]]:
    continuation = Continuation(loads_scene(text))
    return continuation, list(continuation)


@pytest.mark.parametrize(
    ("law", "load"), [*zip(HOMOGENEOUS, [6.729347255, 6.7257477, 6.7343797], strict=True)]
)
def test_a_branch_of_straight_ribbons(law: str, load: float) -> None:
    continuation, points = followed(TIP.format(law=law, x=0) + FOLLOWED)
    assert continuation.ending.reached
    assert not [point for point in points if point.kind == BRANCH_POINT]
    (buckling,) = [point for point in points if point.kind == BUCKLING]
    assert value_of(buckling.row) == pytest.approx(load, abs=1e-7)
    straight = [point.row for point in points if point.branch == 0 and point.kind == POINT]
    assert {(row["error"], row["negative"]) for row in straight} == {(None, None)}
    assert all("no linearisation" in row["note"] for row in straight)
    assert {row["side"] for row in straight} == {0.0}
    # The buckled ribbons: to tolerance, mirror images, and beginning where the load says.
    sides = []
    for branch in (1, 2):
        rows = [point.row for point in points if point.branch == branch]
        # Next to the crossing rounding is magnified, and the row says so.
        assert all(row["error"] <= 1e-9 and row["note"] == "" for row in rows[1:])
        assert rows[0]["error"] <= 1e-9 or "above the tolerance" in rows[0]["note"]
        assert rows[0]["error"] <= 1e-8
        assert value_of(rows[-1]) == 8
        assert load < value_of(rows[0]) < load + 0.01
        loads, sides_of = (np.array([row[k] for row in rows[:4]]) for k in ("parameters.P", "side"))
        # A pitchfork: the load is even in the deflection.
        even = np.polynomial.Polynomial.fit(sides_of**2, loads, len(loads) - 1)
        assert even(0.0) == pytest.approx(load, abs=1e-6)
        sides.append(rows[-1]["side"])
    assert sides[0] == pytest.approx(-sides[1], rel=1e-7)
    if "variational" in law:
        assert {point.row["negative"] for point in points if point.branch} == {0}


@pytest.mark.parametrize("states", ["reduced", "planar"])
@pytest.mark.parametrize("law", ["kirchhoff", *HOMOGENEOUS])
def test_columns(law: str, states: str) -> None:
    _, points = followed(COLUMN.format(law=law) + f"states: {states}\n")
    kind = BRANCH_POINT if law == "kirchhoff" else BUCKLING
    found = [value_of(point.row) for point in points if point.kind != POINT]
    stiffness = 1.001 if "regularized" in law else 1.0
    assert found == pytest.approx([stiffness * np.pi**2 / 4], abs=1e-8)
    assert [point.kind for point in points if point.kind != POINT] == [kind]
    buckled = [point.row for point in points if point.branch]
    assert {value_of(row) for row in buckled} >= {3.0}
    assert max(row["error"] for row in buckled if "above" not in row["note"]) <= 1e-9
    assert max(row["error"] for row in buckled) <= 1e-8


def test_without_special_points_nothing_is_sought() -> None:
    text = TIP.format(law="sadowsky", x=0) + FOLLOWED.replace("switch: true", "special: false")
    _, points = followed(text)
    assert {point.kind for point in points} == {POINT}


def test_a_branch_goes_on_after_a_break(tmp_path: Path) -> None:
    scene = loads_scene(TIP.format(law="sadowsky", x=0) + FOLLOWED)
    whole = BranchFolder(tmp_path / "whole", scene, resume=False)
    list(whole.follow(Continuation(scene)))
    expected = (tmp_path / "whole" / "branch.jsonl").read_text().splitlines(keepends=True)
    for count in (4, 9, 12):  # before and after the buckling point, and on the buckled ribbon
        folder = tmp_path / str(count)
        folder.mkdir()
        (folder / "branch.jsonl").write_text("".join(expected[:count]))
        (folder / "scene.yaml").write_text((tmp_path / "whole" / "scene.yaml").read_text())
        again = BranchFolder(folder, scene, resume=True)
        list(again.follow(Continuation(scene)))
        rows, same = again.rows, whole.rows
        assert [(r["number"], r["kind"]) for r in rows] == [(r["number"], r["kind"]) for r in same]
        values = [[value_of(r) for r in part] for part in (rows, same)]
        np.testing.assert_allclose(*values, rtol=1e-8)


def test_a_guess_on_the_buckled_side_is_followed_as_ever(solved: Any) -> None:
    """Where m2 and m3 do not vanish all is known as before."""
    found: Solution = solved("moebius_variational")
    assert not lacks_linearisation(found)
