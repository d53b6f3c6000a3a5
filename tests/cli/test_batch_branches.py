"""Studies that continue every ribbon: a row a branch, its special points in columns and a table.

Truth: the strip that snaps folds at an angle of 32.3633539404 degrees (planar elastica by shooting,
configs/snap.yaml): for m3 = 0 that is the same for every law.
"""

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from batches import without_times, written

from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.sweep import load_study

Run = Callable[..., Any]
FOLD = 32.3633539404
SNAP = """\
name: snap
law: {type: kirchhoff, B2: 1, B3: 1.5}
parameters: {angle: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 0.9], directors: {turns: [{y: angle*deg}]}}
guess: {force: [0, 0, -42], moment: [0, 4, 0]}
tolerance: 1e-9
record: {middle: "dot(r, ex) at 0.5"}
continuation: {parameter: parameters.angle, from: 0, to: 40, largest: 10, stop: [fold]}
"""
STUDY = """\
name: snaps
scene: snap.yaml
continue: true
sweep: {list: [{law.B3: 1.5}, {law.B3: 3, continuation.to: 20}, {law.B2: 2}]}
"""


@pytest.fixture
def snaps(tmp_path: Path) -> Path:
    (tmp_path / "snap.yaml").write_text(SNAP)
    (tmp_path / "snaps.yaml").write_text(STUDY)
    return tmp_path / "snaps.yaml"


def table(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


def test_special_points_are_columns_and_a_table(run: Run, snaps: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    status, told, _ = run("batch", snaps, "--out", out, "--jobs", "1", "--plot")
    assert status == 0
    assert "special.csv" in told
    rows = table(out / "table.csv")
    assert [row["status"] for row in rows] == ["converged"] * 3
    assert [row["special1_kind"] for row in rows] == ["fold", "", "fold"]
    for row in (rows[0], rows[2]):
        bar = float(row["special1_error"])
        assert 0 < bar <= 1e-9
        assert float(row["special1"]) == pytest.approx(FOLD, rel=bar, abs=1e-10)
    special = table(out / "special.csv")
    assert [row["number"] for row in special] == ["1", "3"]
    assert [row["kind"] for row in special] == ["fold", "fold"]
    assert special[0]["law.B3"] == "1.5"
    # The moment is as the stiffness, and the shape the same.
    assert float(special[1]["m0y"]) == pytest.approx(2 * float(special[0]["m0y"]), rel=1e-8)
    middle = [float(row["middle"]) for row in special]
    assert middle[1] == pytest.approx(middle[0], rel=1e-8)
    assert (out / "special.png").stat().st_size > 10_000
    assert "special1" in (out / "report.html").read_text()


def test_rows_are_the_same_from_any_worker_and_after_a_break(
    run: Run, snaps: Path, tmp_path: Path
) -> None:
    one, two = (without_times(list(run_batch(load_study([snaps]), jobs=jobs))) for jobs in (1, 2))
    assert one == two
    out = tmp_path / "out"
    assert run("batch", snaps, "--out", out, "--quiet").status == 0
    lines = (out / "rows.jsonl").read_text().splitlines(keepends=True)
    (out / "rows.jsonl").write_text(lines[0])
    assert run("batch", snaps, "--out", out, "--quiet", "--resume").status == 0
    assert written(out) == one
    # The same without `continue` is another study: its rows are none of these.
    snaps.write_text(STUDY.replace("continue: true\n", ""))
    status, _, err = run("batch", snaps, "--out", out, "--quiet", "--resume")
    assert status == 2
    assert "another study" in err


def test_a_branch_that_turns_back_is_a_failure_and_is_kept(
    run: Run, snaps: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    status, _, err = run("batch", snaps, "--set", "continuation.stop=[]", "--out", out)
    assert status == 3
    assert "target_not_reached" in err
    assert "turned back and left the range" in err
    rows = written(out)
    assert [row["verified"] for row in rows] == [False, True, False]
    # As `continue` writes it, to be drawn and looked at.
    assert sorted(path.name for path in (out / "solutions").iterdir()) == ["1", "3"]
    assert run("plot", out / "solutions" / "1").status == 0
    points = table(out / "solutions" / "1" / "branch.csv")
    assert [p["kind"] for p in points].count("fold") == len(rows[0]["specials"]) == 1
    assert rows[0]["points"] == len(points)


def test_a_scene_without_a_continuation_is_refused(run: Run, snaps: Path, tmp_path: Path) -> None:
    text = SNAP.split("continuation:")[0]
    (tmp_path / "snap.yaml").write_text(text)
    snaps.write_text(STUDY.replace(", continuation.to: 20", ""))
    status, _, err = run("batch", snaps, "--out", tmp_path / "out")
    assert status == 2
    assert "snap.yaml: continuation: missing, the study continues every ribbon" in err
    snaps.write_text(STUDY.replace("continue: true", "continue: yes please"))
    status, _, err = run("batch", snaps, "--out", tmp_path / "out")
    assert status == 2
    assert "line 3, continue: found 'yes please', expected true or false" in err
    assert not (tmp_path / "out").exists()


def test_a_scene_without_a_continuation_spoils_only_its_own_rows(
    run: Run, snaps: Path, tmp_path: Path
) -> None:
    text = SNAP.replace("to: 40", "to: 2")
    (tmp_path / "snap.yaml").write_text(text)
    (tmp_path / "plain.yaml").write_text(text.split("continuation:")[0])
    study = "name: two\nscene: [snap.yaml, plain.yaml]\ncontinue: true\n"
    snaps.write_text(study + "sweep: {list: [{law.B3: 1.5}]}\n")
    status, _, err = run("batch", snaps, "--out", tmp_path / "out", "--jobs", "1")
    assert status == 3
    assert "number 2: bad_input: continuation: the scene has none; add for example" in err
    first, second = table(tmp_path / "out" / "table.csv")
    assert (first["status"], second["status"]) == ("converged", "bad_input")


def test_columns_of_branches_can_be_drawn(run: Run, snaps: Path, tmp_path: Path) -> None:
    status, _, err = run("batch", snaps, "--plot", "law.B3:energy2", "--out", tmp_path / "out")
    assert status == 2
    assert "special1" in err
    assert not (tmp_path / "out").exists()
