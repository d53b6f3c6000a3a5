"""`ribbonopt continue`: what a stage may ask for: where it ends, which ways, how deep.

Truths: the fold of `configs/snap.yaml`; Euler's load 4 pi^2; symmetry.
"""

import json
import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from branches import COLUMN, FOLD, SNAP, points, written

from ribbonopt.studies.continuation.recorded import value_of

Run = Callable[..., Any]
Row = dict[str, Any]

EULER = 4 * math.pi**2


def column(stage: str) -> str:
    return COLUMN + f"continuation: {stage}\n"


def followed(run: Run, tmp_path: Path, text: str) -> tuple[list[Row], dict[int, str]]:
    """Return the rows of a scene, and how the branches of its first stage ended."""
    status, out, err = run("continue", written(tmp_path, text), "--out", "o", "--json")
    assert (status, err) == (0, "")
    endings = {e["branch"]: e["reason"] for e in json.loads(out)["endings"] if e["stage"] == 0}
    return points(tmp_path / "o"), endings


def values(rows: list[Row], branch: int) -> list[float]:
    return [value_of(row) for row in rows if (row["branch"], row["stage"]) == (branch, 0)]


# where it ends


@pytest.mark.parametrize("stop", ["fold", "1 fold"])
def test_a_stage_ends_at_its_fold(run: Run, tmp_path: Path, stop: str) -> None:
    text = SNAP.replace("largest: 5", f"largest: 5, stop: [energy > 1e9, {stop}]")
    rows, endings = followed(run, tmp_path, text)
    assert rows[-1]["kind"] == "fold"
    assert value_of(rows[-1]) == pytest.approx(FOLD, abs=1e-7)
    assert endings == {0: f"stopped, as asked: {stop}"}
    assert {row["negative"] for row in rows} == {0, None}


def test_a_stage_goes_on_from_before_the_branch_point_that_ended_one(
    run: Run, tmp_path: Path
) -> None:
    stages = """
  - {parameter: parameters.P, from: 36, to: 60, largest: 2, stop: [branch point]}
  - {parameter: parameters.turn, to: 0.02}"""
    rows, endings = followed(run, tmp_path, column(stages))
    last = [row for row in rows if row["stage"] == 0][-2:]
    assert endings == {0: "stopped, as asked: branch point"}
    assert [row["kind"] for row in last] == ["point", "branch point"]
    assert value_of(last[1]) == pytest.approx(EULER, rel=1e-8)
    begin = next(row for row in rows if row["stage"] == 1)
    assert begin["energy"] == pytest.approx(last[0]["energy"], abs=1e-12)
    assert begin["n0z"] == pytest.approx(-value_of(last[0]), rel=1e-9)


@pytest.mark.parametrize("largest", [2, 5, 15])
@pytest.mark.parametrize("level", [0.001, 0.05])
def test_a_condition_is_met_exactly_beyond_a_fold(
    run: Run, tmp_path: Path, level: float, largest: float
) -> None:
    text = SNAP.replace("largest: 5", f"largest: {largest}, stop: [middle < {level}]")
    rows, endings = followed(run, tmp_path, text)
    *before, last = (row["middle"] for row in rows)
    assert 0 < level - last < 1e-9
    assert min(before) > level
    assert endings == {0: f"stopped, as asked: middle < {level}"}


def test_the_point_that_is_landed_on_does_not_depend_on_the_steps(run: Run, tmp_path: Path) -> None:
    found = []
    for largest in (3, 7.7):
        text = SNAP.replace("largest: 5", f"largest: {largest}, stop: [middle < 0.03]")
        (tmp_path / str(largest)).mkdir()
        scene = written(tmp_path / str(largest), text)
        assert run("continue", scene, "--out", f"o{largest}", "--quiet").status == 0
        found.append(points(tmp_path / f"o{largest}")[-1])
    for name in ("parameters.angle", "energy", "n0x", "n0z", "m0y"):
        assert found[0][name] == pytest.approx(found[1][name], rel=1e-8, abs=1e-8)


# which ways


def test_both_ways_from_a_start(run: Run, tmp_path: Path) -> None:
    stages = """
  - {parameter: parameters.P, from: 45, to: [35, 50], largest: 4}
  - {parameter: parameters.P, to: 52, largest: 4}"""
    rows, endings = followed(run, tmp_path, column(stages))
    assert endings == {0: "reached parameters.P = 35", 1: "reached parameters.P = 50"}
    down, up = values(rows, 0), values(rows, 1)
    assert (down[0], down[-1], up[-1]) == (45, 35, 50)
    assert all(a > b for a, b in pairwise(down))
    assert all(a < b for a, b in pairwise([45, *up]))
    assert {row["origin"] for row in rows if row["branch"] == 0} == {None}
    assert {row["origin"] for row in rows if row["branch"] == 1} == {rows[0]["number"]}
    # the next stage begins at the end that is named last
    assert next(value_of(row) for row in rows if row["stage"] == 1) == 50


def test_both_ways_are_as_each_way_alone(run: Run, tmp_path: Path) -> None:
    text = column("{parameter: parameters.P, from: 45, to: %s, largest: 2.5}")
    rows, _ = followed(run, tmp_path, text % "[35, 50]")
    for branch, end in ((0, 35), (1, 50)):
        scene = written(tmp_path, text % end)
        assert run("continue", scene, "--out", f"o{end}", "--quiet").status == 0
        alone = points(tmp_path / f"o{end}")
        last = [row for row in rows if row["branch"] == branch][-1]
        for name in ("parameters.P", "energy", "n0z", "shortening"):
            assert last[name] == pytest.approx(alone[-1][name], rel=1e-9, abs=1e-9)


# how deep


def test_branches_of_branches(run: Run, tmp_path: Path) -> None:
    stage = "{parameter: parameters.P, from: 38.5, to: 42, largest: 1, switch: 2}"
    rows, endings = followed(run, tmp_path, column(stage))
    special = [(row["branch"], row["kind"]) for row in rows if row["kind"] != "point"]
    assert special == [(0, "branch point"), (1, "branch point"), (2, "branch point")]
    second = [value_of(row) for row in rows if row["kind"] != "point"][1:]
    assert second[0] == pytest.approx(second[1], rel=1e-9)
    assert sorted(endings) == list(range(7))
    number = {row["number"]: row for row in rows}
    for branch, left in ((1, 0), (2, 0), (3, 1), (4, 1), (5, 2), (6, 2)):
        own = [row for row in rows if row["branch"] == branch]
        (origin,) = {row["origin"] for row in own}
        assert (number[origin]["kind"], number[origin]["branch"]) == ("branch point", left)
    # exact from the first point on
    assert all(row["error"] <= 1e-9 for row in rows if row["kind"] == "point")


@pytest.mark.slow
def test_a_branch_that_closes_is_followed_once(run: Run, tmp_path: Path) -> None:
    """The branch that leaves the bent column comes back to where it leaves, from the other side."""
    stage = "{parameter: parameters.P, from: 45, to: [-40, 60], switch: 2, stability: false}"
    rows, endings = followed(run, tmp_path, column(stage))
    closed, again = endings[4], endings[5]
    assert closed.startswith("closed: it has come back to where it began, the branch point at")
    assert again == "is branch 4 already"
    loop = [row for row in rows if row["branch"] == 4]
    # it is symmetric about its middle
    assert loop[0]["energy"] == pytest.approx(loop[-1]["energy"], rel=0.2)
    # its mirror image
    assert endings[6].partition(" (point")[0] == closed.partition(" (point")[0]
    assert endings[7] == "is branch 6 already"


# out of reach


def test_goals_out_of_reach_are_refused_before_anything_is_solved(run: Run, tmp_path: Path) -> None:
    text = SNAP.replace("0.9]", "reach]").replace("angle: 0}", "angle: 0, reach: 0.9}")
    stage = text[text.index("continuation") :]
    scene = written(
        tmp_path, text.replace(stage, "continuation: {parameter: parameters.reach, to: 1.2}\n")
    )
    for verb in (("continue", scene, "--out", "o"), ("check", scene)):
        status, out, err = run(*verb)
        assert (status, out) == (2, "")
        assert (
            "scene_.yaml, line 11: continuation.to: found 1.2, where the ends are 1.2 apart" in err
        )
        assert "it can go up to parameters.reach = 1, where it is straight" in err
    assert not (tmp_path / "o").exists()
