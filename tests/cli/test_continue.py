"""`ribbonopt continue`: what it writes, and says, on a terminal too."""

import csv
import json
import math
import os
import re
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from branches import (
    BRANCH,
    COLUMN,
    FILES,
    SCENE,
    SHORT,
    SNAP,
    STAGES,
    TABLE,
    WAIT,
    Whole,
    lines_appear,
    names,
    points,
    started,
    written,
)

from ribbonopt.cli.progress import ProgressLine
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.walk.steps import JUMPED
from ribbonopt.views.style import Drawn

Run = Callable[..., Any]


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
    assert value_of(crossing[0]) == pytest.approx(4 * math.pi**2, abs=1e-6)
    values = [value_of(row) for row in rows if row["stage"] == 1]
    for asked in (0, 0.02, 0.05):
        assert asked in values


def test_report_says_what_was_found(run: Run, tmp_path: Path) -> None:
    status, out, err = run("continue", written(tmp_path, COLUMN + STAGES), "--out", "o")
    assert (status, err) == (0, "")
    assert names(tmp_path) == ["o", "scene_.yaml"]
    rows = points(tmp_path / "o")
    for words in (
        f"column: {len(rows)} points, all verified\n",
        "  stage 1: 4 points, parameters.P = 36 to 40.5, relative error at most ",
        "reached parameters.P = 40.5",
        "    branch point at parameters.P = 39.478417",
        "    stable at parameters.P = 36 to ",
        "    unstable, 1 direction, at parameters.P = ",
        "  stage 1, branch 1: ",
        "  stage 1, branch 2: ",
        "    stable\n",
        "  stage 2: ",
        "parameters.turn = 0 to 0.05",
        "  written: o: branch.csv, branch.jsonl, scene.yaml\n",
    ):
        assert words in out
    (told,) = re.findall(r"    branch point at parameters\.P = (\S+) \+- ([^:\s]+)", out)
    value, bar = map(float, told)
    # In the rows it is relative to the value; what is written is no smaller, and has one digit.
    (row,) = [row for row in rows if row["kind"] == "branch point"]
    assert 0.999 <= bar / (row["error"] * value_of(row)) <= 2
    assert abs(value - 4 * math.pi**2) <= bar + 0.5 * 10.0 ** -len(told[0].partition(".")[2])
    assert "iterations" not in out and "skipped" not in out


def test_table_has_the_rows_of_the_branch(whole: Callable[[str], Whole]) -> None:
    folder = whole("branches and stages").folder
    rows = points(folder)
    with open(folder / TABLE, newline="", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert len(table) == len(rows)
    for cells, row in zip(table, rows, strict=True):
        assert list(cells) == list(row)
        for name in (
            "parameters.P",
            "parameters.turn",
            "error",
            "energy",
            "deflection",
            "n0z",
            "u2",
        ):
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
    assert names(tmp_path / "results") == ["column-branch"]
    assert names(tmp_path / "results" / "column-branch") == FILES
    before = points(tmp_path / "results" / "column-branch")
    # beside the solution of the same scene, whichever comes first
    assert run("solve", scene, "--plot", "--quiet").status == 0
    assert names(tmp_path / "results") == ["column", "column-branch"]
    assert run("continue", scene, "--resume", "--quiet").status == 0
    assert points(tmp_path / "results" / "column-branch") == before
    assert run("plot", "results/column-branch").status == 0
    assert run("solve", scene, "--plot", "--quiet").status == 0


def test_values_are_met_exactly(run: Run, tmp_path: Path) -> None:
    values = "continuation={parameter: parameters.P, values: [30, 31.7, 33.3], largest: 5}"
    scene = written(tmp_path, COLUMN + SHORT)
    assert run("continue", scene, "--out", "o", "--quiet", "--set", values).status == 0
    found = [value_of(row) for row in points(tmp_path / "o")]
    assert found == sorted(found)
    assert (found[0], found[-1]) == (30, 33.3)
    assert 31.7 in found


@pytest.mark.parametrize(
    ("condition", "beyond"),
    [
        *(("value > 33", 33), ("n0z < -35.5", 35.5), ("value + 0*energy > 32", 32)),
        *(("parameters.P > 33", 33), ("P > 3.3e1", 33), ("2 * parameters.P > 33 + P", 33)),
    ],
)
def test_conditions_stop_the_branch(
    run: Run, tmp_path: Path, condition: str, beyond: float
) -> None:
    stage = SHORT.replace("largest", f"stop: ['{condition}'], largest")
    status, out, err = run("continue", written(tmp_path, COLUMN + stage), "--out", "o")
    assert (status, err) == (0, "")
    assert f"stopped, as asked: {condition}" in out
    *before, last = (value_of(row) for row in points(tmp_path / "o"))
    # exactly where the condition begins to be met
    assert beyond < last < beyond + 1e-8
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
        (["P:H0", "u2:parameters.P"], [("parameters.P", "H0"), ("u2", "parameters.P")]),
        ([], [("parameters.P", name) for name in ("shortening", "deflection", "H0")]),
    ],
    ids=["pairs", "names", "usual"],
)
def test_what_is_drawn(
    run: Run,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    asked: list[str],
    drawn: list[tuple[str, str]],
) -> None:
    calls: list[tuple[Any, ...]] = []

    def note(*arguments: Any, **_: Any) -> Drawn:
        calls.append(arguments)
        return Drawn([], [])

    monkeypatch.setattr("ribbonopt.views.branch.save_branch_figures", note)
    scene = written(tmp_path, COLUMN + SHORT)
    assert run("continue", scene, "--out", "o", "--quiet", "--plot", *asked).status == 0
    ((figure, ribbons, *_),) = calls
    rows = points(tmp_path / "o")
    assert list(figure.pairs) == drawn
    assert (figure.rows, figure.title, figure.si) == (rows, "column", False)
    assert list(ribbons) == [row["number"] for row in figure.pictured]
    assert {0, len(rows) - 1} <= ribbons.keys()
    for row in rows:
        if row["number"] in ribbons:
            assert ribbons[row["number"]].energy == pytest.approx(row["energy"], abs=1e-12)


def test_a_jump_that_is_noted_is_drawn_as_one(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[tuple[Any, ...]] = []

    def note(*arguments: Any, **_: Any) -> Drawn:
        calls.append(arguments)
        return Drawn([], [])

    monkeypatch.setattr("ribbonopt.views.branch.save_branch_figures", note)
    reference = whole("fold")
    lines = [json.loads(line) for line in reference.lines]
    for number, text in ((2, JUMPED), (4, "phases: m2 > 0"), (5, f"phases: m2 > 0; {JUMPED}")):
        lines[number]["row"]["note"] = text
    data = "".join(json.dumps(line) + "\n" for line in lines).encode()
    assert run("plot", reference.cut(tmp_path / "o", data)).status == 0
    ((figure, *_),) = calls
    assert list(figure.jumps) == [2, 5]


@pytest.mark.parametrize("there", [True, False])
def test_a_folder_that_is_not_there(run: Run, tmp_path: Path, there: bool) -> None:
    if there:
        (tmp_path / "results" / "snap-branch").mkdir(parents=True)
    status, out, err = run("plot", "results/snap")
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert "results/snap: no such folder; expected one written by" in err
    assert ("did you mean results/snap-branch?" in err) == there


# a terminal


class Terminal(NamedTuple):
    """What a process says whose stderr is a terminal."""

    status: int
    out: bytes
    err: str


def on_terminal(*arguments: object, interrupt: Path | None = None) -> Terminal:
    """Run a process, and interrupt it after a few points of the branch in a folder."""
    master, slave = os.openpty()
    process = started(*arguments, stderr=slave, waits=None if interrupt is None else 4)
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
def test_progress_on_a_terminal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    scene = written(tmp_path, COLUMN + SHORT)
    status, out, err = on_terminal(scene, "--out", tmp_path / "o", "--json")
    assert status == 0
    assert out.count(b"\n") == 1
    assert json.loads(out)["status"] == "converged"
    bars = [line.rstrip() for line in err.split("\r") if line.startswith("[")]
    rows = {f"] parameters.P = {value_of(row):.6g}, step ": row for row in points(tmp_path / "o")}
    assert 1 <= len(bars) <= len(rows)  # not more often than it can be read
    for bar in bars:
        (row,) = (row for text, row in rows.items() if text in bar)
        assert f", error {row['error']:.0e}, {row['negative']} negative, " in bar
        assert re.search(r", [0-9.]+/s$", bar)
    filled = [bar.count("#") for bar in bars]
    assert filled == sorted(filled)
    assert filled[0] == 0
    # one line, that is gone in the end
    assert "\n" not in err
    *_, cleared, end = err.split("\r")
    assert (cleared.strip(), end) == ("", "")
    assert len(cleared) >= len(bars[-1])


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="no pseudo terminals")
def test_quiet_is_quiet_on_a_terminal_too(tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    assert on_terminal(scene, "--out", tmp_path / "o", "--quiet") == (0, b"", "")


def test_the_line_of_progress_ends_with_the_terminal(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "10")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    line = ProgressLine(quiet=False)
    line.show("0123456789abc")
    line.show("01")
    line.close()
    line.close()
    assert capsys.readouterr().err == "\r012345678\r01       \r  \r"


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="no pseudo terminals")
def test_messages_do_not_stand_beside_the_bar(tmp_path: Path) -> None:
    scene = written(tmp_path, SNAP)
    said = on_terminal(scene, "--out", tmp_path / "o", interrupt=tmp_path / "o")
    assert said.status == 130
    last = said.err.replace("\r\n", "\n").rstrip().replace("\n", "\r").split("\r")[-1]
    assert last.startswith("ribbonopt: interrupted; ")


def test_a_buckling_point_is_told_with_the_way_on(run: Run, tmp_path: Path) -> None:
    scene = tmp_path / "lateral.yaml"
    scene.write_text(
        """\
name: lateral
law: {type: sadowsky}
parameters: {P: 1}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free, force: {x: 0, y: P, z: 0}}
continuation: {parameter: parameters.P, from: 5, to: 8, largest: 1}
"""
    )
    status, out, _ = run("continue", scene, "--out", tmp_path / "branch")
    assert status == 0
    assert "errors not known" in out
    assert out.count("m2 = m3 = 0 along the ribbon") == 1
    assert (
        "buckling point at parameters.P = 6.729347255 +- not known (`switch: true` follows" in out
    )
