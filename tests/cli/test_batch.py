"""Batches: the same rows for any number of workers, lost workers, resuming, and bad studies."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ribbonopt.pipeline import solve
from ribbonopt.scene import load_scene
from ribbonopt.studies.batch import run_batch
from ribbonopt.studies.sweep import load_study

Run = Callable[..., Any]
SCENE = """\
name: half
law: {type: regularized, epsilon: 0.1}
interval: [0, 0.5]
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}, moment: {d1: 0}}
  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}
guess: {force: [0, 43, 42], moment: [0, 2, -9]}
tolerance: 1e-7
"""
STUDY = """\
name: study
scene: scene.yaml
sweep:
  grid: {law.epsilon: {from: 0.1, to: 0.01, count: 30, scale: log}}
"""
# A module that every process loads first: what some scenes do to their worker.
ON_PURPOSE = """\
import os, sys, time
import ribbonopt.scene as scene
whole = scene.loads_scene
def loads_scene(text, source, overrides=()):
    if any("name" in o and "crash" in o for o in overrides):
        os._exit(9)
    if any("name" in o and "hang" in o for o in overrides):
        time.sleep(600)
    return whole(text, source, overrides)
scene.loads_scene = loads_scene
"""


@pytest.fixture
def study(tmp_path: Path) -> Path:
    (tmp_path / "scene.yaml").write_text(SCENE)
    (tmp_path / "study.yaml").write_text(STUDY)
    return tmp_path / "study.yaml"


def without_times(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    rows = [{k: v for k, v in row.items() if k != "seconds"} for row in rows]
    return sorted(rows, key=lambda row: row["number"])


def written(folder: Path) -> list[dict[str, Any]]:
    lines = (folder / "rows.jsonl").read_text().splitlines()
    return without_times([json.loads(line) for line in lines])


def test_rows_do_not_depend_on_the_number_of_workers(study: Path) -> None:
    one, two, four = (
        without_times(list(run_batch(load_study([study]), jobs=jobs))) for jobs in (1, 2, 4)
    )
    assert one == two == four
    assert [row["number"] for row in one] == list(range(1, 31))
    assert all(row["verified"] and row["error"] <= 1e-7 for row in one)
    assert sum(row["start"] != "own" for row in one) >= 28


def test_rows_are_those_of_single_solves(study: Path) -> None:
    rows = without_times(list(run_batch(load_study([study]), jobs=1)))
    for row in (rows[0], rows[17], rows[-1]):
        scene = study.parent / "scene.yaml"
        alone = solve(load_scene(scene, [f"law.epsilon={row['law.epsilon']}", "tolerance=1e-11"]))
        assert [row["n0y"], row["n0z"]] == pytest.approx(alone.n0[1:].tolist(), rel=1e-7)
        assert row["energy"] == pytest.approx(alone.energy, rel=1e-7)


@pytest.mark.slow
def test_rows_of_a_cluster_are_the_same(study: Path) -> None:
    here = without_times(list(run_batch(load_study([study]), jobs=1)))
    code = (
        "import sys\nfrom distributed import LocalCluster\n"
        "if __name__ == '__main__':\n"
        "    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as c:\n"
        "        print(c.scheduler_address, flush=True)\n"
        "        sys.stdin.read()\n"
    )
    script = study.parent / "cluster.py"
    script.write_text(code)
    command = [sys.executable, str(script)]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as cluster:
        assert cluster.stdout is not None
        address = cluster.stdout.readline().strip()
        command = [sys.executable, "-m", "ribbonopt", "batch", str(study), "--quiet"]
        command += ["--scheduler", address, "--out", str(study.parent / "out")]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        cluster.communicate("")
    assert done.returncode == 0, done.stderr
    assert written(study.parent / "out") == here


def lost(study: Path, name: str, **more: Any) -> list[dict[str, Any]]:
    names = [f"r{i}" if i != 3 else name for i in range(6)]
    data = {"scene": "scene.yaml", "sweep": {"list": [{"name": n} for n in names]}} | more
    study.write_text(json.dumps(data))
    (study.parent / "sitecustomize.py").write_text(ON_PURPOSE)
    path = os.pathsep.join([str(study.parent), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-m", "ribbonopt", "batch", str(study), "--jobs", "2", "--quiet"]
    done = subprocess.run(
        [*command, "--out", str(study.parent / "out")],
        env=os.environ | {"PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 3, done.stderr
    assert "1 of 6 ribbons failed" in done.stderr
    return written(study.parent / "out")


def test_a_worker_that_dies_takes_one_ribbon_with_it(study: Path) -> None:
    rows = lost(study, "crash")
    assert [row["status"] for row in rows] == [*["converged"] * 3, "crashed", *["converged"] * 2]
    assert "its process died" in rows[3]["message"]


@pytest.mark.slow
def test_a_ribbon_that_hangs_is_given_up(study: Path) -> None:
    rows = lost(study, "hang", time_limit=5)
    assert [row["status"] for row in rows] == [*["converged"] * 3, "timed_out", *["converged"] * 2]
    assert "took more than 5 s" in rows[3]["message"]


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
    kept = list((tmp_path / "out").iterdir())
    assert {path.name for path in kept} == {"rows.jsonl", "study.json", "table.csv"}


def test_killed_and_resumed_is_the_same(run: Run, study: Path, tmp_path: Path) -> None:
    assert run("batch", study, "--out", tmp_path / "whole", "--jobs", "2", "--quiet").status == 0
    command = [sys.executable, "-m", "ribbonopt", "batch", str(study), "--jobs", "2", "--quiet"]
    process = subprocess.Popen([*command, "--out", str(tmp_path / "out")])
    rows = tmp_path / "out" / "rows.jsonl"
    while not rows.exists() or rows.read_bytes().count(b"\n") < 7:
        assert process.poll() is None
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()
    rows.write_bytes(rows.read_bytes()[:-20])  # cut in a line
    there = rows.read_bytes().count(b"\n")
    status, _, err = run("batch", study, "--out", tmp_path / "out", "--jobs", "1", "--quiet")
    assert status == 2
    assert "go on by --resume" in err
    assert run("batch", study, "--out", tmp_path / "out", "--jobs", "1", "--resume").status == 0
    assert 0 < there < 30
    assert written(tmp_path / "out") == written(tmp_path / "whole")
    table = list(csv.DictReader((tmp_path / "out" / "table.csv").read_text().splitlines()))
    assert [row["number"] for row in table] == [str(i) for i in range(1, 31)]
    again = run("batch", study, "--out", tmp_path / "out", "--resume", "--quiet")
    assert again.status == 0


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
        assert len(written(out)) == 2


BAD = {
    "unknown key": ("grid: {law.epsilom: [0.1]}", ("law.epsilom", "did you mean 'epsilon'")),
    "unequal": (
        "zip: {law.epsilon: [1, 2], tolerance: [1e-6]}",
        ("unequal length", "law.epsilon: 2"),
    ),
    "empty": ("grid: {law.epsilon: []}", ("empty",)),
    "no kind": ("gird: {law.epsilon: [1]}", ("grid, zip, list, random, csv",)),
    "twice": ("grid: {law.epsilon: [1]}, zip: {law.epsilon: [1]}", ("swept twice",)),
    "no distribution": ("random: {count: 2, over: {law.epsilon: {gauss: [0, 1]}}}", ("uniform",)),
    "no file": ("csv: none.csv", ("none.csv", "no such file")),
    "huge": (
        "random: {count: 200000, over: {law.epsilon: {uniform: [0, 1]}}}",
        ("200000", "--yes"),
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
    status, _, err = run(
        "batch", study, "--out", tmp_path / "a", "--scheduler", "tcp://127.0.0.1:1"
    )
    assert status == 2 and "cannot be reached" in err
    study.write_text(STUDY.replace("count: 30", "count: 2"))
    assert run("batch", study, "--out", tmp_path / "b", "--quiet").status == 0
    study.write_text(STUDY.replace("count: 30", "count: 3"))
    status, _, err = run("batch", study, "--out", tmp_path / "b", "--resume")
    assert status == 2 and "another study" in err
    (tmp_path / "c").mkdir()
    (tmp_path / "c" / "notes.txt").write_text("mine")
    status, _, err = run("batch", study, "--out", tmp_path / "c")
    assert status == 2 and "notes.txt" in err


def test_draws_and_tables(study: Path, tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text("law.epsilon,tolerance\n0.1,1e-6\n0.05,1e-7\n")
    study.write_text("scene: scene.yaml\nsweep: {csv: rows.csv}\n")
    found = [ribbon.inputs for ribbon in load_study([study]).ribbons]
    assert found == [
        {"law.epsilon": 0.1, "tolerance": 1e-6},
        {"law.epsilon": 0.05, "tolerance": 1e-7},
    ]
    over = "{law.epsilon: {log_uniform: [1e-3, 0.1]}, parameters.a: {normal: [0, 1]}}"
    study.write_text(
        f"scene: scene.yaml\nsweep: {{random: {{count: 50, seed: 3, over: {over}}}}}\n"
    )
    first, again = ([r.inputs for r in load_study([study]).ribbons] for _ in range(2))
    assert first == again
    assert all(1e-3 <= row["law.epsilon"] <= 0.1 for row in first)
    assert len({row["parameters.a"] for row in first}) == 50
