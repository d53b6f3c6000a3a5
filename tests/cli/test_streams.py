"""Streams that are closed, full, or read by nobody: one message, and results stay."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from branches import WAIT, environment
from half_studies import SCENE

COMMAND = f"{sys.executable} -m ribbonopt"
TOLD = "ribbonopt: the standard output cannot be written ({}); what is on disk is kept\n"
CLOSED, FULL = "Bad file descriptor", "No space left on device"
RESULT = ["scene.yaml", "solution.npz", "summary.json"]

each_way = pytest.mark.parametrize(
    "way", [(">&-", CLOSED), (">/dev/full", FULL)], ids=["closed", "full"]
)
needs_full = pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has none")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "scene.yaml").write_text(SCENE)
    return tmp_path


def shell(folder: Path, words: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        ["sh", "-c", words.replace("ribbonopt", COMMAND)],
        cwd=folder,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=WAIT,
        check=False,
    )


@needs_full
@each_way
def test_stdout_takes_nothing(folder: Path, way: tuple[str, str]) -> None:
    done = shell(folder, f"ribbonopt solve scene.yaml --out result {way[0]}")
    assert (done.returncode, done.stderr) == (2, TOLD.format(way[1]))
    assert sorted(os.listdir(folder / "result")) == RESULT


@needs_full
@each_way
@pytest.mark.parametrize("words", ["--help", "--version", "schema", "solve none.yaml --json"])
def test_nor_of_other_commands(folder: Path, way: tuple[str, str], words: str) -> None:
    done = shell(folder, f"ribbonopt {words} {way[0]}")
    assert done.returncode == 2
    assert done.stderr.endswith(TOLD.format(way[1]))
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr


@needs_full
@pytest.mark.parametrize("way", ["2>&-", "2>/dev/full", "2>&1 | :"])
def test_stderr_takes_nothing(folder: Path, way: str) -> None:
    for words, status in (("solve none.yaml", 2), ("nonsense", 2), ("check scene.yaml", 0)):
        done = shell(folder, f"(ribbonopt {words}; echo $? >status) {way}")
        assert int((folder / "status").read_text()) in ({status, 141} if "|" in way else {status})
        assert done.stderr == ""
        assert "ribbonopt:" not in done.stdout  # what is for stderr does not go there


def test_files_are_not_taken_for_closed_streams(folder: Path) -> None:
    closed = shell(folder, "ribbonopt solve scene.yaml --quiet --out result <&- >&- 2>&-")
    assert closed.returncode == 0
    assert sorted(os.listdir(folder / "result")) == RESULT
    assert (folder / "result" / "summary.json").read_text().startswith("{")


def test_all_that_has_no_stream_is_quiet(folder: Path) -> None:
    assert shell(folder, "ribbonopt check scene.yaml >&- 2>&-").returncode == 2
    assert shell(folder, "ribbonopt solve none.yaml >&- 2>&-").returncode == 2
