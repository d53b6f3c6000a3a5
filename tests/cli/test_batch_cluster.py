"""Batches on a real Dask cluster: the same rows, the same care for what is lost."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from batches import COMMAND, STUDY, lost, on_purpose, without_times, written

from ribbonopt.output.results import load_solution
from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.sweep import load_study

Run = Callable[..., Any]
CLUSTER = """\
import sys
from distributed import LocalCluster
if __name__ == '__main__':
    with LocalCluster(n_workers=2, threads_per_worker=2, dashboard_address=None) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""

pytestmark = pytest.mark.slow


@contextmanager
def cluster(folder: Path, environment: dict[str, str] | None = None) -> Iterator[tuple[str, Any]]:
    """Start two Dask workers of two threads; give the scheduler's address, and its process."""
    script = folder / "cluster.py"
    script.write_text(CLUSTER)
    process = subprocess.Popen(
        [sys.executable, str(script)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        cwd=folder,
        env=environment,
    )
    with process:
        assert process.stdout is not None
        yield process.stdout.readline().strip(), process
        if process.poll() is None:
            process.communicate("")


def test_rows_and_solutions_are_the_same(run: Run, study: Path, tmp_path: Path) -> None:
    study.write_text(STUDY + "save: all\n")
    here = without_times(list(run_batch(load_study([study]), jobs=1)))
    with cluster(tmp_path) as (address, _):
        out = tmp_path / "out"
        command = [*COMMAND, str(study), "--quiet", "--scheduler", address, "--out", str(out)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert written(out) == here
    assert {path.name for path in (out / "solutions").iterdir()} == {str(i) for i in range(1, 31)}
    for row in here[::7]:
        solution = load_solution(out / "solutions" / str(row["number"]))
        assert solution.energy == row["energy"]


def test_a_ribbon_that_crashes_costs_one_row(study: Path, tmp_path: Path) -> None:
    environment = on_purpose(study, "crash")
    with cluster(tmp_path, environment) as (address, _):
        rows = lost(study, "crash", "--scheduler", address)
    assert [row["status"] for row in rows] == [*["converged"] * 3, "crashed", *["converged"] * 2]


def test_a_cluster_that_is_lost_keeps_the_rows(run: Run, study: Path, tmp_path: Path) -> None:
    study.write_text(STUDY.replace("count: 30", "count: 400"))
    out = tmp_path / "out"
    with cluster(tmp_path) as (address, process):
        command = [*COMMAND, str(study), "--scheduler", address, "--out", str(out), "--json"]
        batch = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        rows = out / "rows.jsonl"
        while not rows.exists() or not rows.stat().st_size:
            assert batch.poll() is None
        process.kill()
        text, err = batch.communicate()
    assert batch.returncode == 3, err
    assert json.loads(text)["status"] == "cluster_lost"
    assert "--resume goes on" in err
    assert 0 < len(written(out)) < 400
    assert run("batch", study, "--out", out, "--resume", "--quiet").status == 0
    assert written(out) == without_times(list(run_batch(load_study([study]))))


def test_workers_without_ribbonopt_are_refused(run: Run, study: Path, tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(
        "import sys\nsys.modules['ribbonopt'] = None  # cannot be imported\n"
    )
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    with cluster(tmp_path, environment) as (address, _):
        found = run("batch", study, "--scheduler", address, "--out", tmp_path / "out")
    assert found.status == 2
    assert "its workers cannot run ribbonopt" in found.err
    assert not (tmp_path / "out").exists()


def test_a_scheduler_that_is_not_there_is_refused(run: Run, study: Path, tmp_path: Path) -> None:
    for address, said in (("tcp://127.0.0.1:1", "cannot be reached"), ("nonsense", "")):
        found = run("batch", study, "--scheduler", address, "--out", tmp_path / "out")
        assert found.status == 2
        assert f"--scheduler {address}" in found.err
        assert said in found.err
        assert found.err.count("\n") == 1
        assert not (tmp_path / "out").exists()
