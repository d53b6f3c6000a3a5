"""`ribbonopt continue`: what it writes and says, goes on after any break, and refuses."""

import csv
import json
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from disks import Full

from ribbonopt.studies import branch_files

Run = Callable[..., Any]

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
WAIT = 60  # seconds, for a process on a busy machine

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


def started(*arguments: object, **keywords: Any) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "ribbonopt", "continue", *map(str, arguments)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | keywords
    return subprocess.Popen(command, env=environment(), **pipes)


def finished(*arguments: object) -> tuple[int, bytes, bytes]:
    process = started(*arguments)
    out, err = process.communicate(timeout=WAIT)
    return process.returncode, out, err


def lines_appear(path: Path, count: int, process: subprocess.Popen[bytes]) -> None:
    """Wait until a file has so many lines, or the process that writes it has ended."""
    end = time.monotonic() + WAIT
    while process.poll() is None and time.monotonic() < end:
        if path.exists() and path.read_bytes().count(b"\n") >= count:
            return
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


@pytest.fixture(scope="session")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Whole]:
    """Return the cached maker of uninterrupted branches, each by a process of its own."""

    @cache
    def made(name: str) -> Whole:
        text, expected, meshes = LONG[name]
        folder = tmp_path_factory.mktemp("whole")
        scene = written(folder, text)
        status, out, err = finished(scene, "--out", folder / "branch", "--quiet")
        assert (status, out) == (expected, b"")
        assert (err == b"") == (expected == 0)
        result = Whole(scene, folder / "branch")
        rows = points(result.folder)
        assert len({row["intervals"] for row in rows}) >= meshes
        return result

    return made


# what is written and said


def test_branch_is_written(whole: Callable[[str], Whole]) -> None:
    folder = whole("branches and stages").folder
    assert names(folder) == FILES
    rows = points(folder)
    assert [row["number"] for row in rows] == list(range(len(rows)))
    places = [(row["stage"], row["branch"]) for row in rows]
    assert places == sorted(places)
    assert list(dict.fromkeys(places)) == [(0, 0), (0, 1), (0, 2), (1, 0)]
    crossing = [row for row in rows if row["kind"] != "point"]
    assert [row["kind"] for row in crossing] == ["branch point"]
    assert crossing[0]["value"] == pytest.approx(4 * math.pi**2, abs=1e-6)
    values = [row["value"] for row in rows if row["stage"] == 1]
    for asked in (0, 0.02, 0.05):
        assert asked in values


def test_report_says_what_was_found(run: Run, tmp_path: Path) -> None:
    status, out, err = run("continue", written(tmp_path, COLUMN + STAGES), "--out", "o")
    assert (status, err) == (0, "")
    assert names(tmp_path) == ["o", "scene_.yaml"]
    rows = points(tmp_path / "o")
    for words in (
        f"column: {len(rows)} points\n",
        "  stage 1: 4 points, parameters.P = 36 to 40.5, relative error at most ",
        "reached parameters.P = 40.5",
        "    branch point at parameters.P = 39.478417",
        "    0 negative directions at ",
        "  stage 1, branch 1: ",
        "  stage 1, branch 2: ",
        "    stable\n",
        "  stage 2: ",
        "parameters.turn = 0 to 0.05",
        "  written: o: branch.csv, branch.jsonl, scene.yaml\n",
    ):
        assert words in out


def test_table_has_the_rows_of_the_branch(whole: Callable[[str], Whole]) -> None:
    folder = whole("branches and stages").folder
    rows = points(folder)
    with open(folder / TABLE, newline="", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert len(table) == len(rows)
    for cells, row in zip(table, rows, strict=True):
        assert list(cells) == list(row)
        for name in ("value", "error", "energy", "deflection", "n0z", "u2"):
            assert cells[name] == ("" if row[name] is None else repr(row[name]))
        assert (cells["kind"], cells["parameter"]) == (row["kind"], row["parameter"])


def test_switched_branches_are_mirror_images(whole: Callable[[str], Whole]) -> None:
    rows = points(whole("branches and stages").folder)
    one, other = ([row for row in rows if row["branch"] == branch] for branch in (1, 2))
    assert abs(one[-1]["deflection"]) > 0.1
    assert one[-1]["deflection"] == pytest.approx(-other[-1]["deflection"], abs=1e-8)
    assert one[-1]["shortening"] == pytest.approx(other[-1]["shortening"], abs=1e-8)
    assert [row["negative"] for row in (one[-1], other[-1])] == [0, 0]


def test_quiet(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    assert run("continue", scene, "--out", "o", "--quiet") == (0, "", "")
    assert names(tmp_path / "o") == FILES


def test_json_is_one_object(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    status, out, err = run("continue", scene, "--out", "o", "--json")
    assert (status, err, out.count("\n")) == (0, "", 1)
    found = json.loads(out)
    assert (found["name"], found["status"], found["reached"]) == ("column", "converged", True)
    assert found["points"] == points(tmp_path / "o")
    assert found["folder"] == "o"
    reason = "reached parameters.P = 38"
    ending = {"stage": 0, "branch": 0, "reached": True, "reason": reason}
    assert (found["message"], found["endings"]) == (reason, [ending])


def test_folder_is_named_after_the_scene(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    assert run("continue", scene, "--quiet").status == 0
    assert names(tmp_path / "results") == ["column"]
    assert names(tmp_path / "results" / "column") == FILES


def test_values_are_met_exactly(run: Run, tmp_path: Path) -> None:
    values = "continuation={parameter: parameters.P, values: [30, 31.7, 33.3], largest: 5}"
    scene = written(tmp_path, COLUMN + SHORT)
    assert run("continue", scene, "--out", "o", "--quiet", "--set", values).status == 0
    found = [row["value"] for row in points(tmp_path / "o")]
    assert found == sorted(found)
    assert (found[0], found[-1]) == (30, 33.3)
    assert 31.7 in found


@pytest.mark.parametrize(
    ("condition", "beyond"),
    [("value > 33", 33), ("n0z < -35.5", 35.5), ("value + 0*energy > 29", 29)],
)
def test_conditions_stop_the_branch(
    run: Run, tmp_path: Path, condition: str, beyond: float
) -> None:
    stage = SHORT.replace("largest", f"stop: ['{condition}'], largest")
    status, out, err = run("continue", written(tmp_path, COLUMN + stage), "--out", "o")
    assert (status, err) == (0, "")
    assert f"stopped, as asked: {condition}" in out
    *before, last = (row["value"] for row in points(tmp_path / "o"))
    assert last > beyond
    assert max(before, default=0) <= beyond


@pytest.mark.parametrize("condition", ["number > 0.5", "negative > 0.5", "intervals > 7"])
def test_counts_may_stop_the_branch(run: Run, tmp_path: Path, condition: str) -> None:
    stage = SHORT.replace("to: 38", f"to: 45, stop: ['{condition}']")
    status, _, err = run("continue", written(tmp_path, COLUMN + stage), "--out", "o")
    assert (status, err) == (0, "")


def test_figures_are_drawn_and_drawn_again(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    pairs = ["value:deflection", "shortening:energy"]
    status, out, err = run("continue", scene, "--out", "o", "--plot", *pairs)
    assert (status, err) == (0, "")
    assert names(tmp_path / "o") == [TABLE, BRANCH, "branch.png", "ribbons.png", SCENE]
    assert "branch.png" in out
    assert "ribbons.png" in out
    first = (tmp_path / "o" / "branch.png").read_bytes()
    assert first.startswith(b"\x89PNG")
    before = (tmp_path / "o" / BRANCH).read_bytes()
    assert run("plot", "o", "--out", "p").status == 0
    assert names(tmp_path / "p") == ["branch.png", "ribbons.png"]
    assert (tmp_path / "p" / "branch.png").read_bytes() != first
    # figures are no foreign files
    assert run("continue", scene, "--out", "o", "--resume", "--quiet").status == 0
    assert (tmp_path / "o" / BRANCH).read_bytes() == before


@pytest.mark.parametrize(
    ("asked", "drawn"),
    [
        (["u2:H0", "value:negative"], [("u2", "H0"), ("value", "negative")]),
        ([], [("value", name) for name in ("shortening", "deflection", "u2", "energy")]),
    ],
    ids=["pairs", "usual"],
)
def test_what_is_drawn(
    run: Run,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    asked: list[str],
    drawn: list[tuple[str, str]],
) -> None:
    calls: list[tuple[Any, ...]] = []

    def note(*arguments: Any, **_: Any) -> list[Path]:
        calls.append(arguments)
        return []

    monkeypatch.setattr("ribbonopt.views.branch.save_branch_figures", note)
    scene = written(tmp_path, COLUMN + SHORT)
    assert run("continue", scene, "--out", "o", "--quiet", "--plot", *asked).status == 0
    ((rows, ribbons, captions, _, pairs),) = calls
    assert list(pairs) == drawn
    assert rows == points(tmp_path / "o")
    assert captions[0] == "parameters.P = 30"
    assert captions[-1] == "parameters.P = 38"
    assert len(ribbons) == len(captions) == min(5, len(rows))


# a terminal


class Terminal(NamedTuple):
    """What a process says whose stderr is a terminal."""

    status: int
    out: bytes
    err: str


def on_terminal(*arguments: object, interrupt: Path | None = None) -> Terminal:
    """Run a process, and interrupt it when there are a few lines in the branch of a folder."""
    master, slave = os.openpty()
    process = started(*arguments, stderr=slave)
    os.close(slave)
    if interrupt is not None:
        lines_appear(interrupt / BRANCH, 4, process)
        process.send_signal(signal.SIGINT)
    said = b""
    while True:
        try:
            part = os.read(master, 4096)
        except OSError:  # how Linux tells that the other end is closed
            break
        if not part:
            break
        said += part
    os.close(master)
    out, _ = process.communicate(timeout=WAIT)
    return Terminal(process.returncode, out, said.decode())


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="no pseudo terminals")
def test_progress_on_a_terminal(tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    status, out, err = on_terminal(scene, "--out", tmp_path / "o", "--json")
    assert status == 0
    assert out.count(b"\n") == 1
    assert json.loads(out)["status"] == "converged"
    bars = [line.rstrip() for line in err.split("\r") if line.startswith("[")]
    rows = points(tmp_path / "o")
    assert len(bars) == len(rows)
    for bar, row in zip(bars, rows, strict=True):
        assert f"] parameters.P = {row['value']:.6g}  step " in bar
        assert bar.endswith(f"  error {row['error']:.0e}")
    filled = [bar.count("#") for bar in bars]
    assert filled == sorted(filled)
    assert (filled[0], filled[-1]) == (0, 24)
    # one line, that is gone in the end
    assert "\n" not in err
    *_, cleared, end = err.split("\r")
    assert (cleared.strip(), end) == ("", "")
    assert len(cleared) >= len(bars[-1])


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="no pseudo terminals")
def test_messages_do_not_stand_beside_the_bar(tmp_path: Path) -> None:
    scene = written(tmp_path, SNAP)
    said = on_terminal(scene, "--out", tmp_path / "o", interrupt=tmp_path / "o")
    assert said.status == 130
    last = said.err.replace("\r\n", "\n").rstrip().replace("\n", "\r").split("\r")[-1]
    assert last.startswith("ribbonopt: interrupted; ")


# breaks


@each_long
def test_killed_and_resumed_is_the_same(
    whole: Callable[[str], Whole], tmp_path: Path, name: str
) -> None:
    reference, status = whole(name), LONG[name][1]
    folder = tmp_path / "branch"
    seed = random.SystemRandom().randrange(10**6)
    count = random.Random(seed).randrange(1, len(reference.lines))
    process = started(reference.scene, "--out", folder, "--quiet")
    lines_appear(folder / BRANCH, count, process)
    process.kill()
    process.communicate(timeout=WAIT)
    kept = (folder / BRANCH).read_bytes()
    told = f"seed {seed}, killed after {count} lines, {kept.count(bytes([10]))} kept"
    assert process.returncode in (-signal.SIGKILL, status), told
    assert kept.count(b"\n") >= count, told
    assert reference.data.startswith(kept), told
    again, out, err = finished(reference.scene, "--out", folder, "--quiet", "--resume")
    assert (again, out) == (status, b""), f"{told}: {err.decode()}"
    for file in FILES:
        assert (folder / file).read_bytes() == (reference.folder / file).read_bytes(), told


@each_long
def test_cut_in_the_middle_of_a_line(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, name: str
) -> None:
    reference, status = whole(name), LONG[name][1]
    seed = random.SystemRandom().randrange(10**6)
    chance = random.Random(seed)
    count = chance.randrange(len(reference.lines) // 2, len(reference.lines))
    line = reference.lines[count]
    part = line[: chance.randrange(1, len(line) - 1)]
    told = f"seed {seed}, {count} lines and {len(part)} of {len(line)} bytes"
    folder = reference.cut(tmp_path / "branch", b"".join([*reference.lines[:count], part]))
    assert run("continue", reference.scene, "--out", folder, "--resume").status == status, told
    for file in FILES:
        assert (folder / file).read_bytes() == (reference.folder / file).read_bytes(), told


def cuts(lines: list[bytes]) -> Iterator[tuple[str, int]]:
    """Where a break is most likely to go wrong, besides the begin."""
    rows = [json.loads(line).get("row") for line in lines]
    for i in range(1, len(rows)):
        here, before = rows[i], rows[i - 1]
        if before is None:
            yield "after an ending", i
        elif here is None:
            yield "before an ending", i
        elif before["kind"] != "point":
            yield "after a special point", i
        elif here["intervals"] != before["intervals"]:
            yield "before another mesh", i


@each_long
def test_cut_where_it_matters(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, name: str
) -> None:
    reference, status = whole(name), LONG[name][1]
    # the last place of each kind, which is the quickest to go on from
    places = dict(cuts(reference.lines))
    assert len(places) >= 2
    for what, place in places.items():
        folder = reference.cut(tmp_path / what, b"".join(reference.lines[:place]))
        assert run("continue", reference.scene, "--out", folder, "--resume").status == status
        for file in FILES:
            same = (folder / file).read_bytes() == (reference.folder / file).read_bytes()
            assert same, (what, file)


@each_long
def test_resuming_a_finished_branch_adds_nothing(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, name: str, monkeypatch: Any
) -> None:
    def never(*_: object) -> None:
        raise AssertionError("solved")

    monkeypatch.setattr("ribbonopt.solvers.newton.Newton.solve", never)
    reference, status = whole(name), LONG[name][1]
    folder = reference.cut(tmp_path / "branch", reference.data)
    found = run("continue", reference.scene, "--out", folder, "--resume")
    assert found.status == status
    assert ("the goal was not reached" in found.err) == (status == 3)
    assert f"{len(points(folder))} points" in found.out
    for file in FILES:
        assert (folder / file).read_bytes() == (reference.folder / file).read_bytes()


def test_resuming_nothing_is_beginning(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    assert run("continue", scene, "--out", "o", "--quiet", "--resume").status == 0
    assert run("continue", scene, "--out", "p", "--quiet").status == 0
    assert (tmp_path / "o" / BRANCH).read_bytes() == (tmp_path / "p" / BRANCH).read_bytes()


def test_interrupted_and_resumed_is_the_same(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path
) -> None:
    reference = whole("fold")
    folder = tmp_path / "branch"
    process = started(reference.scene, "--out", folder, "--json")
    lines_appear(folder / BRANCH, 3, process)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=WAIT)
    kept = points(folder)
    assert (process.returncode, out) == (130, b"")
    told = f"ribbonopt: interrupted; {len(kept)} points kept in {folder}, --resume goes on"
    assert err.decode().startswith(told)
    assert 3 <= len(kept) < len(points(reference.folder))
    assert reference.data.startswith((folder / BRANCH).read_bytes())
    assert (folder / TABLE).read_text().count("\n") == len(kept) + 1
    assert run("continue", reference.scene, "--out", folder, "--resume").status == 3
    for file in FILES:
        assert (folder / file).read_bytes() == (reference.folder / file).read_bytes()


def test_killed_while_the_folder_is_opened(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "branch", reference.data)
    # what is beside the branch file for a moment
    (folder / f".{BRANCH}.new").write_bytes(reference.data[:1000])
    found = run("continue", reference.scene, "--out", folder, "--resume")
    assert found.status == 3, found.err
    assert (folder / BRANCH).read_bytes() == reference.data


# a full disk


@pytest.mark.parametrize("table", [True, False], ids=["all files", "branch alone"])
def test_full_disk(
    run: Run,
    whole: Callable[[str], Whole],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    table: bool,
) -> None:
    reference, folder = whole("fold"), tmp_path / "branch"

    def opened(path: Path, mode: str = "r", **keywords: Any) -> Any:
        file = open(path, mode, **keywords)
        room = {BRANCH: 4, TABLE: 0 if table else 1000}.get(Path(path).name)
        return file if room is None or "r" in mode else Full(file, room)

    with monkeypatch.context() as patch:
        patch.setattr(branch_files, "open", opened, raising=False)
        status, out, err = run("continue", reference.scene, "--out", folder)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert err.startswith("ribbonopt: ")
    assert "No space left on device" in err
    kept = (folder / BRANCH).read_bytes()
    assert kept.startswith(b"".join(reference.lines[:4]))
    assert run("continue", reference.scene, "--out", folder, "--resume").status == 3
    for file in FILES:
        assert (folder / file).read_bytes() == (reference.folder / file).read_bytes()


# bad input


STAGE = "parameter: parameters.P, from: 30, to: 38"
#: what the user did: the stage, and what the message must say
BAD: dict[str, tuple[str, tuple[str, ...]]] = {
    "unknown parameter": (
        "parameter: parameters.Q, to: 38",
        ("line 11", "continuation.parameter", "parameters.Q", "did you mean parameters.P?"),
    ),
    "misspelt law": (
        "parameter: law.b2, to: 38",
        ("line 11", "continuation.parameter", "law.b2", "did you mean law.B2?"),
    ),
    "no number": ("parameter: law.type, to: 38", ("line 11", "continuation.parameter")),
    "idle parameter": (
        "parameter: parameters.idle, to: 38",
        ("line 11", "continuation.parameter", "parameters.idle"),
    ),
    "from is to": ("parameter: parameters.P, from: 31, to: 31", ("line 11", "31", "another value")),
    "to is the scene's": ("parameter: parameters.P, to: 30", ("line 11", "continuation.to", "30")),
    "no end": ("parameter: parameters.P", ("line 11", "continuation", "to: 0.1")),
    "first above largest": (
        f"{STAGE}, first: 3, largest: 2",
        ("line 11", "continuation.first", "reversed", "first 3 > largest 2"),
    ),
    "smallest above first": (
        f"{STAGE}, smallest: 3, first: 2",
        ("line 11", "continuation.smallest", "reversed", "smallest 3 > first 2"),
    ),
    "step of nothing": (f"{STAGE}, largest: 0", ("line 11", "continuation.largest", "0")),
    "values and to": (f"{STAGE}, values: [1, 2]", ("line 11", "continuation.to", "values")),
    "values that turn": ("parameter: parameters.P, values: [30, 32, 31]", ("line 11", "values")),
    "logarithm of nothing": (
        "parameter: parameters.turn, from: 0, to: 1, scale: log",
        ("line 11", "continuation.from", "> 0"),
    ),
    "unknown scale": (f"{STAGE}, scale: logg", ("line 11", "continuation.scale", "logg")),
    "no points": (f"{STAGE}, points: 0", ("line 11", "continuation.points", "0")),
    "misspelt key": (f"{STAGE}, stopp: [value > 3]", ("line 11", "stopp", "did you mean 'stop'")),
    "no condition": (f"{STAGE}, stop: [value]", ("line 11", "continuation.stop.0", "value")),
    "two conditions": (f"{STAGE}, stop: ['1 < value < 2']", ("line 11", "continuation.stop.0")),
    "unknown quantity": (
        f"{STAGE}, stop: [shortning > 3]",
        ("line 11", "continuation.stop", "shortning", "shortening"),
    ),
    "quantity that is not recorded": (
        f"{STAGE}, stop: [n3 > 3]",
        ("line 11", "continuation.stop", "n3", "record"),
    ),
    "call in a condition": (
        f"{STAGE}, stop: ['__import__(\"os\") > 3']",
        ("line 11", "continuation.stop", "__import__"),
    ),
    "impossible end": ("parameter: law.B2, to: -1", ("line 11", "continuation.to", "law.B2")),
}


def never(*_: object, **__: object) -> None:
    raise AssertionError("solved")


@pytest.fixture
def unsolved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let nothing be solved."""
    for solver in ("newton.Newton", "ipopt.Ipopt"):
        monkeypatch.setattr(f"ribbonopt.solvers.{solver}.solve", never)


def refused(outcome: Any, tmp_path: Path, *kept: str) -> str:
    """Check that input was refused and nothing written; return the message."""
    status, out, err = outcome
    assert (status, out) == (2, "")
    assert err.startswith("ribbonopt: ")
    assert err.count("ribbonopt: ") == 1
    assert names(tmp_path) == sorted(["scene_.yaml", *kept])
    return str(err)


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("case", BAD)
def test_bad_stages_are_refused(run: Run, tmp_path: Path, case: str) -> None:
    stage, words = BAD[case]
    scene = written(tmp_path, COLUMN + f"continuation: {{{stage}}}\n")
    message = refused(run("continue", scene, "--out", "o"), tmp_path)
    for word in ("scene_.yaml", *words):
        assert word in message


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize(
    ("formula", "words"),
    [
        ("dot(r, ex at 0.5", ("line 10", "record.deflection", "cannot be read")),
        ("dot(q, ex) at 0.5", ("line 10", "record.deflection", "unknown name 'q'")),
        ("r at 0.5", ("line 10", "record.deflection", "vector", "dot(r, ex)")),
        ("dot(r, ex) at 1.5", ("line 10", "record.deflection", "from 0 to 1")),
    ],
)
def test_bad_records_are_refused(
    run: Run, tmp_path: Path, formula: str, words: tuple[str, ...]
) -> None:
    scene = written(tmp_path, COLUMN.replace("dot(r, ex) at 0.5", formula) + SHORT)
    message = refused(run("continue", scene, "--out", "o"), tmp_path)
    for word in ("scene_.yaml", *words):
        assert word in message


#: of every row; a record of this name would take its place
TAKEN = ("value", "stage", "branch", "number", "kind", "parameter", "negative", "error", "switches")


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("name", [*TAKEN, "energy", "u2", "n0x", "H0", "intervals", "iterations"])
def test_records_do_not_replace_what_every_row_has(run: Run, tmp_path: Path, name: str) -> None:
    scene = written(tmp_path, COLUMN.replace("deflection:", f"{name}:") + SHORT)
    message = refused(run("continue", scene, "--out", "o"), tmp_path)
    assert f"record.{name}" in message
    assert "line 10" in message


@pytest.mark.usefixtures("unsolved")
def test_scene_without_continuation(run: Run, tmp_path: Path) -> None:
    message = refused(run("continue", written(tmp_path, COLUMN), "--out", "o"), tmp_path)
    for word in ("scene_.yaml", "continuation", "the scene has none", "law.epsilon"):
        assert word in message


@pytest.mark.usefixtures("unsolved")
def test_energy_formulation_is_refused(run: Run, tmp_path: Path) -> None:
    text = COLUMN.replace("tolerance: 1e-9\n", "formulation: energy\n") + SHORT
    message = refused(run("continue", written(tmp_path, text), "--out", "o"), tmp_path)
    for word in ("scene_.yaml", "line 8", "formulation", "energy", "inverted"):
        assert word in message


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize(
    ("pair", "word"),
    [
        ("nonsense", "expected X:Y"),
        (":energy", "expected X:Y"),
        ("value:", "expected X:Y"),
        ("value:nothing", "'nothing'"),
        ("nothing:value", "'nothing'"),
        ("kind:energy", "'kind'"),
        ("value:switches", "'switches'"),
        ("value:energy:u2", "energy:u2"),
    ],
)
def test_figures_of_nonsense_are_refused_before_solving(
    run: Run, tmp_path: Path, pair: str, word: str
) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    message = refused(run("continue", scene, "--out", "o", "--plot", pair), tmp_path)
    assert "--plot" in message
    assert word in message


def test_bad_input_in_json_is_one_object(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT.replace("38", "30"))
    status, out, err = run("continue", scene, "--out", "o", "--json")
    found = json.loads(out)
    assert (status, found["status"], found["verified"]) == (2, "bad_input", False)
    assert found["message"] in err
    assert names(tmp_path) == ["scene_.yaml"]


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("resume", [[], ["--resume"]], ids=["new", "resume"])
def test_folder_with_foreign_files_is_left_alone(
    run: Run, tmp_path: Path, resume: list[str]
) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    message = refused(run("continue", scene, "--out", "mine", *resume), tmp_path, "mine")
    assert names(tmp_path / "mine") == ["notes.txt"]
    for word in ("mine", "notes.txt", "an empty folder"):
        assert word in message


@pytest.mark.usefixtures("unsolved")
def test_file_for_a_folder(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    message = refused(run("continue", scene, "--out", scene), tmp_path)
    assert "scene_.yaml" in message
    assert scene.read_text() == COLUMN + SHORT


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("cut", [3, None], ids=["unfinished", "finished"])
def test_branches_are_not_overwritten(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, cut: int | None
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "o", b"".join(reference.lines[:cut]))
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    written(tmp_path, SNAP)
    message = refused(run("continue", reference.scene, "--out", "o"), tmp_path, "o")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    for word in ("o: holds a branch already", "--resume"):
        assert word in message


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize(
    "change", [("to: 120", "to: 100"), ("delta: 0.1", "delta: 0.2"), ("name: snap", "name: other")]
)
def test_only_the_same_scene_is_resumed(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, change: tuple[str, str]
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "o", b"".join(reference.lines[:3]))
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    scene = written(tmp_path, SNAP.replace(*change))
    message = refused(run("continue", scene, "--out", "o", "--resume"), tmp_path, "o")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    for word in ("o: holds a branch of another scene", "resume with the scene"):
        assert word in message


def test_the_same_scene_may_be_written_otherwise(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "o", reference.data)
    scene = written(tmp_path, "# the same\n" + SNAP.replace("0.9]", "9.0e-1]"))
    assert run("continue", scene, "--out", folder, "--resume", "--quiet").status == 3
    assert (folder / BRANCH).read_bytes() == reference.data


@pytest.mark.parametrize("line", [b"3\n", b"{}\n", b'{"row": {}}\n', b"[]\n"])
def test_files_that_are_damaged_are_no_accident(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, line: bytes
) -> None:
    # JSON, but nothing that a branch file holds
    reference = whole("fold")
    data = b"".join([*reference.lines[:2], line, *reference.lines[2:]])
    folder = reference.cut(tmp_path / "o", data)
    status, _, err = run("continue", reference.scene, "--out", folder, "--resume")
    assert err.startswith("ribbonopt: ")
    assert status in (2, 3)


# goals that are not reached


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
    assert [row["value"] for row in folds] == [pytest.approx(FOLD, abs=1e-7)]
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


def test_step_below_the_smallest(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, SNAP.replace("largest: 5", "first: 25, smallest: 20, largest: 30"))
    told = run("continue", scene, "--out", tmp_path / "o", "--quiet")
    message, rows = short_of(told, tmp_path / "o")
    assert "the step fell below 20 beyond parameters.angle = 25" in message
    assert [row["value"] for row in rows] == [0, 25]


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
