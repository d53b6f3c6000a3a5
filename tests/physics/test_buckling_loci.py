"""Buckling loads of straight ribbons as loci: in two numbers of a scene, wherever the locus turns.

Truth: table 2d of linearised equations integrated by shooting of order 8, and closed forms.
"""

import itertools

import numpy as np
import pytest

from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import loads_scene
from ribbonopt.studies.buckling.buckling import buckling_loads
from ribbonopt.studies.buckling.plane import LoadsInPlane
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.studies.continuation.continuation import Continuation

STRIP = """
name: strip
law: {type: variational, delta: 1.0}
parameters: {P: 3}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free, force: [0, P, 0]}
tolerance: 1e-9
continuation:
  {parameter: [parameters.P, law.delta], of: buckling point, between: [3, 8], scale: log,
   values: [0.1, 0.01, 0.001], largest: 1}
"""
#: load of the strip by delta: shooting
LOADS = {
    1.0: 4.012599343579,
    0.1: 6.555578944016,
    0.01: 6.725747726639,
    0.001: 6.729292787981,
}
SADOWSKY = 6.729347254560

#: a column whose load is a + 3 b^2, that buckles at pi^2 / 4
COLUMN = """
name: column
law: {law}
parameters: {{a: 1.9, b: -0.6}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: [0, 0, -(a + 3*b*b)]}}
tolerance: 1e-9
{more}
"""
TURNING = """
continuation:
  {parameter: [parameters.b, parameters.a], of: buckling point, between: [-0.6, 0.6], to: 3,
   first: 0.2}
"""


def loads(branch: Branch, l1: str, l2: str) -> list[tuple[float, float, float, str]]:
    """Places of a locus with their error and kind."""
    rows = [row for row in branch.rows if row["of"] == "buckling point" and row[l2] is not None]
    return [(row[l1], row[l2], row["error"], row["kind"]) for row in rows if row["stage"] == 1]


def test_a_strip_on_edge_from_a_rod_to_a_ribbon() -> None:
    scene = loads_scene(STRIP.replace("values: [0.1", "values: [1.0, 0.1"))
    branch = Branch.of(Continuation(scene))
    found = {l2: (l1, bar) for l1, l2, bar, _ in loads(branch, "parameters.P", "law.delta")}
    assert branch.reached
    for delta, truth in LOADS.items():
        load, bar = found[delta]
        assert load == pytest.approx(truth, abs=1e-10)
        assert abs(load - truth) <= max(bar * load, 2e-11)  # the table has twelve decimals
    assert all(a < b for a, b in itertools.pairwise(load for load, _ in found.values()))
    text = STRIP.replace("variational, delta: 1.0", "sadowsky").split("continuation")[0]
    (limit,) = buckling_loads(loads_scene(text), "parameters.P", 3, 8)
    assert limit.value == pytest.approx(SADOWSKY, abs=1e-10)


def test_a_locus_that_turns_in_both_numbers() -> None:
    """a + 3 b^2 = pi^2 / 4: a turns at b = 0, where the locus goes on along b."""
    scene = loads_scene(COLUMN.format(law="{type: sadowsky}", more=TURNING))
    branch = Branch.of(Continuation(scene))
    places = loads(branch, "parameters.b", "parameters.a")
    (turn,) = [place for place in places if place[-1] == "turn"]
    assert turn[:2] == pytest.approx((0, np.pi**2 / 4), abs=1e-7)
    assert turn[1] == pytest.approx(np.pi**2 / 4, abs=1e-10)
    for b, a, _, _ in places:
        assert a + 3 * b * b == pytest.approx(np.pi**2 / 4, abs=1e-10)
    assert max(place[0] for place in places) > 0.2
    assert "turned back" in branch.endings[1, 0].reason


@pytest.mark.parametrize("more", ["", "states: planar"])
def test_a_rod_in_the_plane_of_two_numbers(more: str) -> None:
    """A linear law has the same curve; its tangent is that of the parabola."""
    law = "{type: kirchhoff, B2: 1, B3: 2}"
    scene = loads_scene(COLUMN.format(law=law, more=more))
    prepared = prepare(scene)
    paths = "parameters.b", "parameters.a"
    plane = LoadsInPlane(prepared, prepared.solve(), paths, np.array([2.0, 3.0]))
    (one,) = plane.found(np.array([[-1.0, 1.0], [-0.2, 1.0]]))
    for _ in range(4):
        b, a = one.place
        assert a + 3 * b * b == pytest.approx(np.pi**2 / 4, abs=1e-10)
        tangent = plane.tangent(one)
        assert tangent[1] / tangent[0] == pytest.approx(-6 * b, abs=1e-7)
        ahead = 0.2 * tangent * np.sign(tangent[0])
        across = np.array([-tangent[1] * 2 / 3, tangent[0] * 3 / 2])
        following = plane.crossed(one.mode, plane.across(one.place + ahead, across))
        assert following is not None
        one = following
