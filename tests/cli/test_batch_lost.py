"""Batches: workers that die or hang, runs that are killed or interrupted, disks that are full."""

import csv
import errno
import json
import os
import random
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from batches import COMMAND, STUDY, lost, on_purpose, without_times, written
from disks import Full

from ribbonopt.output import staging
from ribbonopt.output.exports import Fields
from ribbonopt.scene.document import Document
from ribbonopt.studies.batch import files as batch_files
from ribbonopt.studies.batch import worker
from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.chunks import chunks_of
from ribbonopt.studies.batch.processes import message
from ribbonopt.studies.batch.sweep import load_study

Run = Callable[..., Any]

WAIT = 600  # seconds until a process is taken to hang


def rows_there(folder: Path) -> int:
    rows = folder / "rows.jsonl"
    return rows.read_bytes().count(b"\n") if rows.exists() else 0


def until(true: Callable[[], bool], process: subprocess.Popen[Any] | None = None) -> None:
    end = time.monotonic() + WAIT
    while not true():
        assert process is None or process.poll() is None
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.005)


def test_a_worker_that_dies_takes_one_ribbon_with_it(study: Path) -> None:
    rows = lost(study, "crash", "--jobs", "2")
    assert [row["status"] for row in rows] == [*["converged"] * 3, "crashed", *["converged"] * 2]
    assert "its process died (exit status 9)" in rows[3]["message"]
    assert rows[3]["name"] == "crash"


@pytest.mark.slow
def test_a_ribbon_that_hangs_is_given_up_and_not_tried_again(study: Path) -> None:
    rows = lost(study, "hang", "--jobs", "2", time_limit=15)
    assert [row["status"] for row in rows] == [*["converged"] * 3, "timed_out", *["converged"] * 2]
    assert "took more than 15 s" in rows[3]["message"]
    # The rows after it in its chunk are lost, and to be made again.
    file = study.parent / "out" / "rows.jsonl"
    lines = file.read_text().splitlines(keepends=True)
    file.write_text("".join(line for line in lines if json.loads(line)["number"] < 5))
    assert lost(study, "hang", "--jobs", "1", "--resume", time_limit=15) == rows
    assert (study.parent / "hanging").read_text().count("\n") == 1


def test_workers_end_with_a_batch_that_is_killed(study: Path) -> None:
    environment = on_purpose(study, "hang")
    out = str(study.parent / "out")
    command = [*COMMAND, str(study), "--jobs", "1", "--out", out]
    process = subprocess.Popen(command, env=environment, cwd=study.parent)
    hanging = study.parent / "hanging"
    until(lambda: hanging.exists() and bool(hanging.read_text()), process)
    process.kill()
    process.wait()
    orphan = int(hanging.read_text())

    def gone() -> bool:
        try:
            os.kill(orphan, 0)
        except ProcessLookupError:
            return True
        # Where nobody collects the ended, they stay as zombies.
        status = Path(f"/proc/{orphan}/status")
        return status.exists() and "State:\tZ" in status.read_text()

    until(gone)


def test_a_folder_is_written_by_one_batch_at_a_time(run: Run, study: Path) -> None:
    environment, out = on_purpose(study, "hang"), study.parent / "out"
    command = [*COMMAND, str(study), "--jobs", "1", "--out", str(out)]
    process = subprocess.Popen(command, env=environment, cwd=study.parent)
    until(lambda: (study.parent / "hanging").exists() and rows_there(out) == 3, process)
    before = (out / "rows.jsonl").read_bytes()
    status, _, err = run("batch", study, "--out", out, "--resume")
    assert (status, "is being written by another process" in err) == (2, True)
    assert (out / "rows.jsonl").read_bytes() == before
    process.kill()
    process.wait()


@pytest.mark.slow
def test_killed_at_random_again_and_again(run: Run, study: Path, tmp_path: Path) -> None:
    whole, out = tmp_path / "whole", tmp_path / "out"
    environment = on_purpose(study, "hang", count=300)  # so that none ends before it is killed
    assert run("batch", study, "--out", whole, "--quiet").status == 0
    rng = random.Random(1)
    for kills, jobs in enumerate("21321321"):
        command = [*COMMAND, str(study), "--jobs", jobs, "--out", str(out), "--quiet"]
        if out.exists():
            command.append("--resume")
        process = subprocess.Popen(command, env=environment, cwd=study.parent)
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(rng.uniform(0.2, 0.9) + 0.1 * kills)
        process.kill()
        process.wait()
    arguments = ["--resume"] if out.exists() else []
    assert run("batch", study, "--out", out, "--quiet", *arguments).status == 0
    assert written(out) == written(whole)


def test_killed_and_resumed_is_the_same(run: Run, study: Path, tmp_path: Path) -> None:
    whole, out = tmp_path / "whole", tmp_path / "out"
    environment = on_purpose(study, "hang", count=30)  # so that it is killed before it ends
    assert run("batch", study, "--out", whole, "--jobs", "2", "--quiet").status == 0
    command = [*COMMAND, str(study), "--jobs", "2", "--out", str(out), "--quiet"]
    process = subprocess.Popen(command, env=environment, cwd=study.parent)
    until(lambda: rows_there(out) >= 7, process)
    process.send_signal(signal.SIGKILL)
    process.wait()
    rows = out / "rows.jsonl"
    rows.write_bytes(rows.read_bytes()[:-20])  # cut in a line
    assert 0 < rows_there(out) < 30
    for name in ("rows.jsonl", "table.csv", "report.html"):
        (out / f".{name}.new").write_text("cut")  # killed while it was written
    status, _, err = run("batch", study, "--out", out, "--jobs", "1", "--quiet")
    assert (status, "go on by --resume" in err) == (2, True)
    assert run("batch", study, "--out", out, "--jobs", "1", "--resume", "--quiet").status == 0
    assert written(out) == written(whole)
    tables = [
        [{k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(text)]
        for text in ((folder / "table.csv").read_text().splitlines() for folder in (out, whole))
    ]
    assert tables[0] == tables[1]
    assert [row["number"] for row in tables[0]] == [str(i) for i in range(1, 31)]
    before = rows.read_bytes()
    assert run("batch", study, "--out", out, "--resume", "--quiet").status == 0
    assert rows.read_bytes() == before


def test_interrupted_rows_are_kept(study: Path, tmp_path: Path) -> None:
    out, environment = tmp_path / "out", on_purpose(study, "hang")
    process = subprocess.Popen(
        [*COMMAND, str(study), "--jobs", "1", "--out", str(out)],
        env=environment,
        cwd=study.parent,
        stderr=subprocess.PIPE,
        text=True,
    )
    until(lambda: (study.parent / "hanging").exists() and rows_there(out) == 3, process)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate()
    assert process.returncode == 130
    assert f"interrupted; 3 of 6 rows kept in {out}, --resume goes on" in err
    assert rows_there(out) == 3
    assert len((out / "table.csv").read_text().splitlines()) == 3 + 1


@pytest.mark.parametrize("room", [{"rows.jsonl": 7}, {".table.csv.new": 3}], ids=["rows", "table"])
def test_full_disk(
    run: Run, study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, room: dict[str, int]
) -> None:
    out = tmp_path / "out"

    def opened(path: Path, mode: str = "r", **keywords: Any) -> Any:
        file = open(path, mode, **keywords)
        lines = room.get(Path(path).name)
        return file if lines is None or "r" in mode else Full(file, lines)

    with monkeypatch.context() as patch:
        for module in (batch_files, staging):
            patch.setattr(module, "open", opened, raising=False)
        status, text, err = run("batch", study, "--out", out, "--jobs", "2")
    assert (status, text, err.count("\n")) == (2, "", 1)
    kept = room.get("rows.jsonl", 30)
    assert f"No space left on device); {kept} of 30 rows are kept, make room and go on" in err
    assert rows_there(out) == kept
    assert not (out / ".table.csv.new").exists()
    assert run("batch", study, "--out", out, "--jobs", "2", "--resume", "--quiet").status == 0
    assert written(out) == without_times(list(run_batch(load_study([study]), jobs=2)))


def test_full_solutions_that_find_no_room_are_told(
    study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a worker does, in this process."""

    def refuse(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Fields, "write", refuse)
    study.write_text(STUDY.replace("count: 30", "count: 2"))
    (chunk, *_) = chunks_of(load_study([study]))
    asked = message(chunk.ribbons, [], (), "all", str(tmp_path))
    rows = [answer["row"] for answer in worker.Worker().answers(asked) if "row" in answer]
    assert rows
    for row in rows:
        assert row["verified"]
        assert "full solution not kept" in row["message"]
        assert "No space left on device" in row["message"]


def test_errors_of_any_kind_spoil_their_own_row(
    study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = Document.scene

    def scene(document: Document, overrides: list[str]) -> Any:
        if any("0.05" in override for override in overrides):
            raise ZeroDivisionError("on purpose")
        return whole(document, overrides)

    monkeypatch.setattr(Document, "scene", scene)
    values = "{law.epsilon: [0.06, 0.05, 0.04]}"
    study.write_text(f"scene: scene.yaml\nsweep: {{grid: {values}}}\n")
    hand = worker.Worker()
    rows = [
        answer["row"]
        for chunk in chunks_of(load_study([study]))
        for answer in hand.answers(message(chunk.ribbons, [], (), "none", ""))
        if "row" in answer
    ]
    rows.sort(key=lambda row: int(row["number"]))
    assert [row["status"] for row in rows] == ["converged", "error", "converged"]
    assert rows[1]["message"] == "ZeroDivisionError: on purpose"
