"""`ribbonopt continue`: goals that are not reached."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from branches import COLUMN, FOLD, SHORT, SNAP, TABLE, Whole, points, written

from ribbonopt.studies.continuation.recorded import value_of

Run = Callable[..., Any]


def short_of(outcome: Any, folder: Path) -> tuple[str, list[dict[str, Any]]]:
    """Check that a goal was not reached; return why, and the points that are kept."""
    status, out, err = outcome
    assert (status, out) == (3, "")
    assert err.count("\n") == 1
    rows = points(folder)
    assert (folder / TABLE).read_text().count("\n") == len(rows) + 1
    assert f"{len(rows)} points kept in {folder}" in err
    assert "the goal was not reached" in err
    return str(err), rows


def test_goal_beyond_a_fold(whole: Callable[[str], Whole]) -> None:
    reference = whole("fold")
    rows = points(reference.folder)
    folds = [row for row in rows if row["kind"] == "fold"]
    assert [value_of(row) for row in folds] == [pytest.approx(FOLD, abs=1e-7)]
    ending = json.loads(reference.lines[-1])["ending"]
    assert (ending["stage"], ending["branch"], ending["reached"]) == (0, 0, False)
    for word in ("turned back", "fold", "parameters.angle = 32.363354"):
        assert word in ending["reason"]
    # stable up to the fold, unstable beyond
    turn = rows.index(folds[0])
    assert {row["negative"] for row in rows[:turn]} == {0}
    assert rows[turn + 1]["negative"] == 1


def test_goal_beyond_a_fold_is_told(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "o", reference.data)
    told = run("continue", reference.scene, "--out", folder, "--resume", "--quiet")
    message, rows = short_of(told, folder)
    assert "fold" in message
    assert "32.363354" in message
    assert len(rows) > 10
    _, out, _ = run("continue", reference.scene, "--out", folder, "--resume", "--json")
    found = json.loads(out)
    assert (found["status"], found["reached"]) == ("target_not_reached", False)
    assert "fold" in found["message"]


def test_points_used_up(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT.replace("largest", "points: 3, largest"))
    told = run("continue", scene, "--out", tmp_path / "o", "--quiet")
    message, rows = short_of(told, tmp_path / "o")
    assert "there are 3 points, as many as allowed" in message
    assert len(rows) == 3


NO_START = "solver={type: newton, max_iterations: 1}"


def test_start_that_cannot_be_solved(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, SNAP)
    status, out, err = run("continue", scene, "--out", "o", "--set", NO_START)
    assert (status, out) == (3, "")
    assert err.count("ribbonopt: ") == 1
    assert "no solution to begin with, at parameters.angle = 0" in err
    # there is nothing to be kept, so the folder is as free as before
    again = run("continue", scene, "--out", "o", "--quiet", "--set", "continuation.points=1")
    assert again.status == 3, again.err
    assert len(points(tmp_path / "o")) == 1


def test_start_that_cannot_be_solved_in_json(run: Run, tmp_path: Path) -> None:
    out = run("continue", written(tmp_path, SNAP), "--out", "o", "--json", "--set", NO_START).out
    found = json.loads(out)
    assert found["verified"] is False
    assert "no solution to begin with" in found["message"]


def test_numbers_that_do_not_exist(run: Run, tmp_path: Path) -> None:
    # a record without a value here and there is no reason to lose the rest
    text = COLUMN.replace("1 - dot(r, ez)", "log(-dot(r, ez))") + SHORT
    status, out, err = run("continue", written(tmp_path, text), "--out", "o", "--json")
    assert (status, err) == (0, "")
    assert json.loads(out)["points"][0]["shortening"] is None
