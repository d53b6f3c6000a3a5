"""Branches, whole and broken, for the tests of `ribbonopt continue`."""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import pytest

COLUMN = """\
name: column
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {P: 30, turn: 0, idle: 1}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {position: {x: 0}, force: {y: 0, z: -P}, d3: {x: 0}, d1: {y: turn}, moment: {d1: 0}}
guess: {force: [0, 0, -30], moment: [0, 0, 0]}
tolerance: 1e-9
transcription: {type: collocation, degree: 6, intervals: 6}
record: {shortening: "1 - dot(r, ez)", deflection: "dot(r, ex) at 0.5"}
"""
SHORT = "continuation: {parameter: parameters.P, from: 30, to: 38, largest: 4}\n"
STAGES = """\
continuation:
  - {parameter: parameters.P, from: 36, to: 40.5, switch: true, largest: 3}
  - {parameter: parameters.turn, values: [0, 0.02, 0.05], largest: 0.01}
"""
SNAP = """\
name: snap
law: {type: variational, delta: 0.1}
parameters: {angle: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 0.9], directors: {turns: [{y: angle*deg}]}}
guess: {force: [0, 0, -42], moment: [0, 4, 0]}
tolerance: 1e-9
transcription: {type: collocation, degree: 6, intervals: 12}
record: {middle: "dot(r, ex) at 0.5"}
continuation: {parameter: parameters.angle, from: 0, to: 120, largest: 5}
"""
MOEBIUS = """\
name: moebius
law: {type: regularized, epsilon: 0.1}
interval: [0, 1]
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}}
  end:
    position: {y: 0, z: 0}
    directors: {d1: [-1, 0, 0], d2: [0, -1, 0], d3: [0, 0, 1]}
guess: {force: [0, 43, 43], moment: [0, 2.1, -8.6]}
tolerance: 1e-8
transcription: {type: collocation, scheme: gauss, degree: 8, intervals: 24}
continuation: {parameter: law.epsilon, to: 1e-3, scale: log}
"""
#: scene, exit status of the whole branch, and least number of meshes on it
LONG = {
    "phases and meshes": (MOEBIUS, 0, 3),
    "fold": (SNAP, 3, 1),
    "branches and stages": (COLUMN + STAGES, 0, 2),
}
FOLD = 32.36335394  # of the snap, in degrees
BRANCH, TABLE, SCENE = "branch.jsonl", "branch.csv", "scene.yaml"
FILES = [TABLE, BRANCH, SCENE]
WAIT = 600  # seconds until a process is taken to hang
#: a process that follows a branch up to some point, and there waits for a signal
WAITING = """\
import sys, time
from ribbonopt.studies.continuation.continuation import Continuation
resume, count = Continuation.resume, int(sys.argv.pop(1))
def waiting(self, history):
    for number, point in enumerate(resume(self, history), start=1):
        yield point
        if number == count:
            time.sleep(WAIT)
Continuation.resume = waiting
from ribbonopt.cli import run
sys.exit(run())
""".replace("WAIT", str(WAIT))

each_long = pytest.mark.parametrize("name", LONG)


class Whole(NamedTuple):
    """A branch that was never interrupted."""

    scene: Path
    folder: Path

    @property
    def data(self) -> bytes:
        return (self.folder / BRANCH).read_bytes()

    @property
    def lines(self) -> list[bytes]:
        return self.data.splitlines(keepends=True)

    def cut(self, folder: Path, data: bytes) -> Path:
        """Return a folder as a process leaves it that dies when `data` is written."""
        folder.mkdir()
        shutil.copy(self.folder / SCENE, folder)
        (folder / BRANCH).write_bytes(data)
        return folder


def environment() -> dict[str, str]:
    """Return the environment in which this very package is found from any folder."""
    root = str(Path(__file__).parents[2])
    known = os.environ.get("PYTHONPATH")
    return {**os.environ, "PYTHONPATH": os.pathsep.join([root, known] if known else [root])}


def started(
    *arguments: object, waits: int | None = None, **keywords: Any
) -> subprocess.Popen[bytes]:
    """Start a process, which waits after so many points (by itself it ends when it is done)."""
    program = ["-m", "ribbonopt"] if waits is None else ["-c", WAITING, str(waits)]
    command = [sys.executable, *program, "continue", *map(str, arguments)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | keywords
    return subprocess.Popen(command, env=environment(), **pipes)


def finished(*arguments: object) -> tuple[int, bytes, bytes]:
    process = started(*arguments)
    out, err = process.communicate(timeout=WAIT)
    return process.returncode, out, err


def lines_appear(path: Path, count: int, process: subprocess.Popen[bytes]) -> None:
    """Wait until a file has so many lines, or the process that writes it has ended."""
    end = time.monotonic() + WAIT
    while process.poll() is None:
        if path.exists() and path.read_bytes().count(b"\n") >= count:
            return
        assert time.monotonic() < end, f"no {count} lines in {path}"
        time.sleep(0.001)


def points(folder: Path) -> list[dict[str, Any]]:
    """Return the rows of the points of a branch file."""
    found = [json.loads(line) for line in (folder / BRANCH).read_text().splitlines()]
    return [line["row"] for line in found if "row" in line]


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "scene_.yaml"
    path.write_text(text, encoding="utf-8")
    return path
