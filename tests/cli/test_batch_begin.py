"""Batches: workers that cannot start, folders that hide modules, ribbons that are tried again."""

import io
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from batches import COMMAND, STUDY, lost, on_purpose, written

import ribbonopt
from ribbonopt.cli import batch
from ribbonopt.studies.batch.files import load_batch

Run = Callable[..., Any]
ROOT = Path(ribbonopt.__file__).parents[1]
HIDING = ("struct", "yaml", "json", "numpy", "casadi", "numbers", "threading", "ribbonopt")
# What pip makes of an entry point: Python puts the folder of the script first, no other.
SCRIPT = "from ribbonopt.cli import run\nif __name__ == '__main__':\n    run()\n"
# Loaded by every process before anything else; only workers are told apart.
IN_WORKERS = """\
import os, sys, time
if any(word.endswith("begin.py") for word in sys.orig_argv):
    {act}
"""
CALLER = """\
import sys
{first}
from ribbonopt import load_study, run_batch
sys.path[:0] = {path!r}
rows = run_batch(load_study(["study.yaml"]), jobs=2)
print(sorted((row["number"], row["status"]) for row in rows))
"""


@pytest.fixture
def small(study: Path) -> Path:
    """Return a study of two ribbons."""
    study.write_text(STUDY.replace("count: 30", "count: 2"))
    return study


def hide(folder: Path) -> None:
    """Lay files beside the user's own that would stand before modules."""
    for name in HIDING:
        (folder / f"{name}.py").write_text(f"raise SystemExit('{name}.py was imported')\n")


def finished(command: list[str], folder: Path, **more: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(ROOT)} | more
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )


def test_files_of_the_working_folder_hide_no_module(small: Path, tmp_path: Path) -> None:
    hide(tmp_path)
    (tmp_path / "bin").mkdir()
    script = tmp_path / "bin" / "ribbonopt"
    script.write_text(SCRIPT)
    done = finished([sys.executable, str(script), "batch", "study.yaml", "--jobs", "2"], tmp_path)
    assert done.returncode == 0, done.stderr
    assert [row["status"] for row in written(tmp_path / "results" / "study")] == ["converged"] * 2


@pytest.mark.parametrize("path", [[""], ["."], ["HERE"], []], ids=["empty", "dot", "whole", "none"])
def test_callers_of_their_own_path(small: Path, tmp_path: Path, path: list[str]) -> None:
    """The package is found by what the caller adds, and its folder is looked through last."""
    hide(tmp_path)
    (tmp_path / "there").mkdir()
    path = [str(tmp_path) if folder == "HERE" else folder for folder in path]
    script = tmp_path / "there" / "run.py"
    script.write_text(CALLER.format(first=f"sys.path.append({str(ROOT)!r})", path=path))
    done = finished([sys.executable, str(script)], tmp_path, PYTHONPATH="")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "[(1, 'converged'), (2, 'converged')]\n"


BROKEN = {
    "says why": ("print('no licence', file=sys.stderr); os._exit(7)", "exit status 7"),
    "is killed": ("print('no licence', file=sys.stderr, flush=True); os.kill(os.getpid(), 9)", "9"),
    "no module": ("sys.modules['casadi'] = None", "casadi"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_workers_that_cannot_start_are_one_error(small: Path, tmp_path: Path, case: str) -> None:
    act, word = BROKEN[case]
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(IN_WORKERS.format(act=act))
    path = os.pathsep.join([str(tmp_path / "site"), str(ROOT)])
    out = tmp_path / "out"
    command = [*COMMAND, "study.yaml", "--jobs", "2", "--out", str(out), "--json"]
    done = finished(command, tmp_path, PYTHONPATH=path)
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("\n") == 1
    assert "ended before it could solve anything" in done.stderr
    assert word in done.stderr
    assert ("no licence" in done.stderr) == ("licence" in act)
    assert json.loads(done.stdout)["status"] == "bad_input"
    assert not out.exists()  # nothing that keeps a later run from beginning anew
    done = finished([*COMMAND, "study.yaml", "--out", str(out), "--quiet"], tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert len(written(out)) == 2


def test_processes_lost_on_the_way_keep_the_rows(study: Path, tmp_path: Path) -> None:
    """The fourth ribbon crashes; no other process starts after the first."""
    on_purpose(study, "crash")
    own = (tmp_path / "sitecustomize.py").read_text()
    once = "open('begun', 'x') if not os.path.exists('begun') else os._exit(8)"
    (tmp_path / "sitecustomize.py").write_text(IN_WORKERS.format(act=once) + own)
    path = os.pathsep.join([str(tmp_path), str(ROOT)])
    command = [*COMMAND, "study.yaml", "--jobs", "1", "--out", "out"]
    done = finished(command, tmp_path, PYTHONPATH=path)
    assert done.returncode == 3
    assert "exit status 8" in done.stderr and "--resume goes on" in done.stderr
    rows = written(tmp_path / "out")
    assert [row["number"] for row in rows] == [1, 2, 3, 4]
    assert rows[3]["status"] == "crashed"


def test_lost_ribbons_are_tried_again_on_request(run: Run, study: Path) -> None:
    rows, out = lost(study, "crash", "--jobs", "2"), study.parent / "out"
    assert [row["status"] for row in rows] == [*["converged"] * 3, "crashed", *["converged"] * 2]
    # Here the name does no harm.
    assert run("batch", study, "--out", out, "--resume", "--quiet").status == 3
    assert written(out) == rows
    status, text, _ = run("batch", study, "--out", out, "--resume", "--retry", "--json")
    assert (status, json.loads(text)["statuses"]) == (0, {"converged": 6})
    again = written(out)
    assert [row for row in again if row["number"] != 4] == [r for r in rows if r["number"] != 4]
    assert again[3]["status"] == "converged"
    assert (out / "table.csv").read_text().count("crashed") == 0
    assert "crashed" not in (out / "report.html").read_text()
    before = (out / "rows.jsonl").read_bytes()
    assert run("batch", study, "--out", out, "--resume", "--retry", "--quiet").status == 0
    assert (out / "rows.jsonl").read_bytes() == before


def test_what_is_lost_again_stays_one_row(study: Path) -> None:
    rows = lost(study, "crash", "--jobs", "1")
    assert lost(study, "crash", "--jobs", "1", "--resume", "--retry") == rows


def test_retry_alone_is_refused(run: Run, study: Path, tmp_path: Path) -> None:
    status, _, err = run("batch", study, "--out", tmp_path / "out", "--retry")
    assert (status, err.count("\n"), "give --resume too" in err) == (2, 1, True)
    assert not (tmp_path / "out").exists()


def test_rows_that_are_there_twice_count_once(run: Run, small: Path, tmp_path: Path) -> None:
    """As older versions wrote them: what is verified stays, else the last one counts."""
    out = tmp_path / "out"
    assert run("batch", small, "--out", out, "--quiet").status == 0
    file = out / "rows.jsonl"
    first, second = sorted(
        map(json.loads, file.read_text().splitlines()), key=lambda r: r["number"]
    )
    lost = {"number": 2, "scene": "half", "status": "crashed", "verified": False, "message": "x"}
    later = lost | {"status": "timed_out"}
    for rows, status in (
        ([lost, second, first, lost], "converged"),
        ([lost, first, second], "converged"),
        ([first, lost, later], "timed_out"),
        ([later, lost] * 50 + [first], "crashed"),
    ):
        file.write_text("".join(json.dumps(row) + "\n" for row in rows))
        assert {r["number"]: r["status"] for r in load_batch(out)[1]} == {1: "converged", 2: status}
        code = run("batch", small, "--out", out, "--resume", "--quiet").status
        assert code == (0 if status == "converged" else 3)
        assert [row["status"] for row in written(out)] == ["converged", status]
        assert len((out / "table.csv").read_text().splitlines()) == 3


def test_many_ribbons_are_said_to_be_ordered(
    run: Run, small: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    terminal = Terminal()
    with monkeypatch.context() as patch:
        patch.setattr(batch, "MANY", 1)
        patch.setattr(sys, "stderr", terminal)
        assert run("batch", small, "--out", tmp_path / "out", "--quiet").status == 0
        assert terminal.getvalue() == ""
        assert run("batch", small, "--out", tmp_path / "b").status == 0
    first, *_ = terminal.getvalue().split("\r")[1:]
    assert first.strip() == "ordering 2 ribbons"


class Terminal(io.StringIO):
    """Where progress is shown."""

    def isatty(self) -> bool:
        return True
