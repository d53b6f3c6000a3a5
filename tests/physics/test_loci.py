"""Loci of folds and branch points in two parameters: where they are, what is beside, how they end.

Truth: strips between clamps at distance 1 - d (`map_truth`: shooting), and of turns in the same
sense a closed form: the pitchfork is at the largest slope of the arch itself.
"""

from dataclasses import replace

import pytest
from map_truth import MIRROR, ONE_CLAMP, same_sense

from ribbonopt.scene import ContinuationStage, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, FOLD

ANGLE, SHORTENING = "parameters.angle", "parameters.d"
DIGITS = 5e-12  # of the truth


def strip(start: str, end: str, continuation: str, more: str = "d: 0.1") -> Continuation:
    """Return a strip whose clamps are turned by formulas of an angle."""
    return Continuation(
        loads_scene(
            f"""
            name: strip
            law: {{type: kirchhoff, B2: 1, B3: 2}}
            parameters: {{angle: 0, {more}}}
            boundary:
              start: {{support: clamped, position: [0, 0, 0], directors: {{turns: [{start}]}}}}
              end: {{support: clamped, position: [0, 0, 1 - d], directors: {{turns: [{end}]}}}}
            guess: {{force: [0, 0, -42], moment: [0, 4, 0]}}
            states: planar
            tolerance: 1e-9
            continuation: {{{continuation}}}
            """
        )
    )


def locus(kind: str, between: str, where: str) -> str:
    """Return the stage of a locus in the angle and the shortening."""
    return f"parameter: [{ANGLE}, {SHORTENING}], of: {kind}, between: {between}, {where}"


def checked(branch: Branch, truth: dict[float, float]) -> None:
    """Check the points of a locus at the shortenings of the truth, and their bars."""
    rows = {row[SHORTENING]: row for row in branch.rows if row["of"] and row["kind"] == "point"}
    for shortening, angle in truth.items():
        off, bar = abs(rows[shortening][ANGLE] / angle - 1), rows[shortening]["error"]
        assert off <= bar + DIGITS, shortening
        assert bar <= 1e-9, shortening


def test_folds_of_one_clamp() -> None:
    stage = locus(FOLD, "[0, 80]", "values: [0.15, 0.25]")
    branch = Branch.of(strip("{y: 0}", "{y: angle*deg}", stage))
    assert branch.reached
    checked(branch, {d: ONE_CLAMP[d] for d in (0.1, 0.15, 0.25)})
    found = [row for row in branch.rows if row["of"]]
    assert [row["of"] for row in branch.rows].count(None) == len(branch) - len(found)
    # Below each the branch is stable, beyond it is not; it is as it was where it began.
    assert {row["negative"] for row in found} == {0}
    assert found[0][ANGLE] == pytest.approx(branch.special[0][ANGLE], rel=1e-10)


def test_a_point_of_a_locus_is_a_solution() -> None:
    branch = Branch.of(strip("{y: 0}", "{y: angle*deg}", locus(FOLD, "[0, 80]", "to: 0.12")))
    last = branch[-1]
    assert isinstance(last, Solution)
    assert last.scene.parameters["d"] == branch.rows[-1][SHORTENING]
    assert last.scene.parameters["angle"] == branch.rows[-1][ANGLE]
    position = last.sample(1.0, "dot(r, ez)")
    assert position == pytest.approx(0.88, abs=1e-9)


def test_branch_points_of_mirror_turns() -> None:
    stage = locus(BRANCH_POINT, "[0, 90]", "values: [0.15, 0.2]")
    branch = Branch.of(strip("{y: -angle*deg}", "{y: angle*deg}", stage))
    checked(branch, {d: MIRROR[d][0] for d in (0.1, 0.15, 0.2)})
    assert {row["negative"] for row in branch.rows if row["of"]} == {0}


def test_pitchforks_of_turns_in_the_same_sense() -> None:
    stage = locus(BRANCH_POINT, "[0, 90]", "values: [0.15]")
    branch = Branch.of(strip("{y: angle*deg}", "{y: angle*deg}", stage))
    checked(branch, {d: same_sense(d)[0] for d in (0.1, 0.15)})


def test_a_branch_point_dissolves_where_its_symmetry_is_broken() -> None:
    stage = f"parameter: [{ANGLE}, parameters.more], of: branch point, between: [0, 60], to: 5"
    found = strip("{y: -angle*deg}", "{y: (angle + more)*deg}", stage, "more: 0, d: 0.1")
    points = [point for point in found if point.row["of"]]
    assert not found.ending.reached
    assert "dissolves" in found.ending.reason
    assert [point.row["parameters.more"] for point in points] == [0]


def test_a_locus_ends_where_the_first_parameter_leaves_its_range() -> None:
    stage = locus(FOLD, "[0, 40]", "to: 0.4")
    branch = Branch.of(strip("{y: 0}", "{y: angle*deg}", stage))
    assert branch.rows[-1][ANGLE] == pytest.approx(40, rel=1e-8)
    assert "has left the range 0 to 40" in branch.endings[1, 0].reason
    lower, upper = ONE_CLAMP[0.15], ONE_CLAMP[0.2]
    assert lower < 40 < upper
    assert 0.15 < branch.rows[-1][SHORTENING] < 0.2


def test_which_of_several_and_from_a_stage_before() -> None:
    # Along the symmetric branch the branch point is before the fold.
    stage = locus(FOLD, "[0, 90]", "values: [0.11]")
    branch = Branch.of(strip("{y: -angle*deg}", "{y: angle*deg}", stage))
    first = next(row for row in branch.rows if row["of"])
    assert first[ANGLE] == pytest.approx(MIRROR[0.1][1], rel=1e-9)
    assert first["negative"] == 1


def test_the_locus_is_the_same_whichever_parameter_its_branches_move() -> None:
    angle = ONE_CLAMP[0.05]
    scene = strip(
        "{y: 0}", "{y: angle*deg}", "parameter: parameters.angle, to: 31, stability: false"
    ).scene
    to_fold = ContinuationStage(SHORTENING, to=0.02, stop=("fold",), stability=False)
    there = ContinuationStage((SHORTENING, ANGLE), of="fold", between=(0.01, 0.2), values=(angle,))
    assert isinstance(scene.continuation, ContinuationStage)
    stages = scene.continuation, to_fold, there
    branch = Branch.of(Continuation(replace(scene, continuation=stages)))
    last = branch.rows[-1]
    assert (last["stage"], last[ANGLE]) == (2, angle)
    # The angle is as the root of the shortening, or nearly.
    assert abs(last[SHORTENING] / 0.05 - 1) <= last["error"] + 2 * DIGITS
