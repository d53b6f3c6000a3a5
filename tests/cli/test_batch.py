"""Batches: the same rows for any number of workers, what is written, and bad studies."""

import io
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from batches import STUDY, without_times, written
from half_studies import SCENE

from ribbonopt.cli.batch import why_failed
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.sweep import load_study

Run = Callable[..., Any]


def test_rows_do_not_depend_on_the_number_of_workers(study: Path) -> None:
    one, two, four = (
        without_times(list(run_batch(load_study([study]), jobs=jobs))) for jobs in (1, 2, 4)
    )
    assert one == two == four
    assert [row["number"] for row in one] == list(range(1, 31))
    assert all(row["verified"] and row["error"] <= 1e-7 for row in one)
    assert sum(row["start"] != "own" for row in one) == 25  # five chunks of six


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="the system pins no processes")
def test_only_cores_that_were_given_count() -> None:
    one = (
        "import os; from ribbonopt.studies.machine import cores; "
        "os.sched_setaffinity(0, list(os.sched_getaffinity(0))[:1]); print(cores())"
    )
    done = subprocess.run([sys.executable, "-c", one], capture_output=True, text=True, check=True)
    assert done.stdout == "1\n"


def test_rows_do_not_depend_on_the_order_in_which_they_are_listed(study: Path) -> None:
    epsilons = [0.1 * 0.8**i for i in (4, 0, 7, 2, 5, 1, 3, 6)]
    found = []
    for listed in (epsilons, sorted(epsilons)):
        sweep = {"list": [{"law.epsilon": epsilon} for epsilon in listed]}
        study.write_text(json.dumps({"scene": "scene.yaml", "sweep": sweep}))
        rows = without_times(list(run_batch(load_study([study]), jobs=1)))
        by_epsilon = sorted(rows, key=lambda row: row["law.epsilon"])
        numbers = ("number", "start")  # the latter names the number of another
        found.append([{k: v for k, v in r.items() if k not in numbers} for r in by_epsilon])
    assert found[0] == found[1]


def test_rows_are_those_of_single_solves(study: Path) -> None:
    rows = without_times(list(run_batch(load_study([study]), jobs=1)))
    for row in (rows[0], rows[17], rows[-1]):
        scene = study.parent / "scene.yaml"
        alone = solve(load_scene(scene, [f"law.epsilon={row['law.epsilon']}", "tolerance=1e-11"]))
        assert [row["n0y"], row["n0z"]] == pytest.approx(alone.n0[1:].tolist(), rel=1e-7)
        assert row["energy"] == pytest.approx(alone.energy, rel=1e-7)


@pytest.mark.parametrize(
    ("message", "said"),
    [("unreachable: too far", "unreachable: too far"), ("too far", "unreachable: too far")],
)
def test_a_failure_is_said_once(message: str, said: str) -> None:
    assert why_failed({"status": "unreachable", "message": message}) == said


def test_a_bad_scene_spoils_its_own_row(run: Run, study: Path, tmp_path: Path) -> None:
    study.write_text(
        STUDY.replace(
            "grid: {law.epsilon: {from: 0.1, to: 0.01, count: 30, scale: log}}",
            "list: [{law.epsilon: 0.1}, {law.epsilon: -1}, {law.epsilon: 0.05}]",
        )
    )
    status, _, err = run("batch", study, "--out", tmp_path / "out", "--jobs", "1")
    assert status == 3
    assert "1 of 3 ribbons failed; the first is number 2: bad_input" in err
    assert [row["status"] for row in written(tmp_path / "out")] == [
        "converged",
        "bad_input",
        "converged",
    ]
    kept = {path.name for path in (tmp_path / "out").iterdir()}
    assert kept == {"report.html", "rows.jsonl", "study.json", "table.csv"}


def test_full_solutions_are_kept_where_wanted(run: Run, study: Path, tmp_path: Path) -> None:
    study.write_text(STUDY.replace("count: 30", "count: 2") + "save: all\n")
    assert run("batch", study, "--out", tmp_path / "out", "--quiet").status == 0
    assert run("plot", tmp_path / "out" / "solutions" / "2", "--out", tmp_path / "p").status == 0


def test_folders_and_patterns_of_scenes(run: Run, study: Path, tmp_path: Path) -> None:
    (tmp_path / "scenes").mkdir()
    for name, epsilon in (("a", 0.1), ("b", 0.05)):
        (tmp_path / "scenes" / f"{name}.yaml").write_text(SCENE.replace("0.1}", f"{epsilon}}}"))
    for path in (tmp_path / "scenes", tmp_path / "scenes" / "*.yaml"):
        out = tmp_path / f"out{len(str(path))}"
        assert run("batch", path, "--out", out, "--json").status == 0
        first, second = written(out)
        # Scenes that differ in numbers only share what is built, and one leads to the other.
        assert {first["start"], second["start"]} == {"own", f"ribbon {first['number']}"} or {
            first["start"],
            second["start"],
        } == {"own", f"ribbon {second['number']}"}


BAD = {
    "unknown key": (
        "grid: {law.epsilom: [0.1]}",
        ("study.yaml, line 2, sweep.grid.law.epsilom", "did you mean 'epsilon'"),
    ),
    "unequal": (
        "zip: {law.epsilon: [1, 2], tolerance: [1e-6]}",
        ("unequal length", "law.epsilon: 2"),
    ),
    "empty": ("grid: {law.epsilon: []}", ("empty",)),
    "no kind": ("gird: {law.epsilon: [1]}", ("grid, zip, list, random, csv",)),
    "twice": ("grid: {law.epsilon: [1]}, zip: {law.epsilon: [1]}", ("swept by grid already",)),
    "no distribution": ("random: {count: 2, over: {law.epsilon: {gauss: [0, 1]}}}", ("uniform",)),
    "no file": ("csv: none.csv", ("none.csv", "no such file")),
    "huge": (
        "random: {count: 200000, over: {law.epsilon: {uniform: [0, 1]}}}",
        ("study: 200,000 ribbons", "--yes"),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_studies_are_refused(run: Run, study: Path, tmp_path: Path, case: str) -> None:
    sweep, words = BAD[case]
    study.write_text(f"scene: scene.yaml\nsweep: {{{sweep}}}\n")
    status, _, err = run("batch", study, "--out", tmp_path / "out")
    assert status == 2
    assert all(word in err for word in words), err
    assert not (tmp_path / "out").exists()


def test_other_bad_input_is_refused(run: Run, study: Path, tmp_path: Path) -> None:
    study.write_text(STUDY.replace("count: 30", "count: 2"))
    assert run("batch", study, "--out", tmp_path / "b", "--quiet").status == 0
    study.write_text(STUDY.replace("count: 30", "count: 3"))
    status, _, err = run("batch", study, "--out", tmp_path / "b", "--resume")
    assert status == 2 and "another study" in err
    (tmp_path / "c").mkdir()
    (tmp_path / "c" / "notes.txt").write_text("mine")
    status, _, err = run("batch", study, "--out", tmp_path / "c")
    assert status == 2 and "notes.txt" in err


def test_studies_none_of_whose_scenes_is_sound_are_refused(
    run: Run, study: Path, tmp_path: Path
) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE.replace("boundary", "bondary"))
    status, _, err = run("batch", study, "--out", tmp_path / "out")
    assert status == 2
    assert "scene.yaml, line 4, bondary" in err or "bondary" in err
    assert not (tmp_path / "out").exists()


def test_what_the_scene_records_is_a_column(run: Run, study: Path, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE + "record: {deflection: 'dot(r, ex) at 0.5'}\n")
    study.write_text(STUDY.replace("count: 30", "count: 3"))
    assert run("batch", study, "--out", tmp_path / "out", "--quiet").status == 0
    for row in written(tmp_path / "out"):
        scene = load_scene(tmp_path / "scene.yaml", [f"law.epsilon={row['law.epsilon']}"])
        assert row["deflection"] == pytest.approx(float(solve(scene).sample(0.5, "r")[0]), rel=1e-6)


@pytest.mark.parametrize("name", ["status", "seconds", "equilibria"])
def test_what_a_scene_records_never_hides_a_column(
    run: Run, study: Path, tmp_path: Path, name: str
) -> None:
    bad = SCENE + f"starts: 2\nrecord: {{{name}: 'dot(r, ex) at 0.5'}}\n"
    (tmp_path / "scene.yaml").write_text(bad)
    status, _, err = run("batch", study, "--out", tmp_path / "out", "--quiet")
    assert (status, (tmp_path / "out").exists()) == (2, False)
    assert f"record.{name}: every row has that already" in err
    # Beside a good scene it spoils its own row only.
    (tmp_path / "good.yaml").write_text(SCENE)
    scenes = (tmp_path / "good.yaml", tmp_path / "scene.yaml")
    assert run("batch", *scenes, "--out", tmp_path / "both", "--quiet").status == 3
    rows = {row["number"]: row for row in written(tmp_path / "both")}
    assert rows[1]["verified"]
    assert f"record.{name}: every row has that already" in rows[2]["message"]


def test_report_and_figures(run: Run, study: Path, tmp_path: Path) -> None:
    study.write_text(STUDY.replace("count: 30", "count: 4"))
    out = tmp_path / "out"
    status, text, _ = run("batch", study, "--out", out, "--plot", "law.epsilon:energy")
    assert status == 0
    assert "report.html" in text
    assert (out / "scatter.png").read_bytes().startswith(b"\x89PNG")
    shutil.rmtree(tmp_path / "out" / "solutions", ignore_errors=True)
    again = run("plot", out / "table.csv", "--out", tmp_path / "again", "--plot", "epsilon:u2")
    assert again.status == 0  # any file of it will do, and of a column the last part
    assert {"report.html", "scatter.png"} <= {p.name for p in (tmp_path / "again").iterdir()}
    status, _, err = run("plot", out, "--plot", "law.epsilom:u2")
    assert (status, "did you mean 'law.epsilon'" in err) == (2, True)
    assert err.count("\n") == 1
    for word in ("--plot", "found 'law.epsilom'", "expected a column", "energy", "iterations"):
        assert word in err
    status, _, err = run("batch", study, "--out", tmp_path / "b", "--plot", "epsilom:u2")
    assert (status, "did you mean 'epsilon'" in err) == (2, True)
    status, _, err = run("batch", study, "--out", tmp_path / "b", "--plot", "energy")
    assert (status, "expected X:Y" in err) == (2, True)
    assert not (tmp_path / "b").exists()


def test_a_batch_that_hangs_together(study: Path) -> None:
    """The README's way from Python."""
    rows = run_batch(load_study([study]), jobs=1)
    first = next(rows)
    rows.close()  # ends the workers
    assert first["verified"]
    assert json.dumps(first)


def test_progress_is_shown_on_terminals_only(
    run: Run, study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study.write_text(STUDY.replace("count: 30", "count: 8"))
    assert run("batch", study, "--out", tmp_path / "a").err == ""
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    assert run("batch", study, "--out", tmp_path / "b").status == 0
    shown = terminal.getvalue().split("\r")
    assert any(part.startswith("8/8 done, 0 failed, ") and "left" in part for part in shown)
    assert shown[-1] == ""  # taken away
    assert shown[-2].strip() == ""


class Terminal(io.StringIO):
    """Where progress is shown."""

    def isatty(self) -> bool:
        return True
