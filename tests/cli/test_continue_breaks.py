"""`ribbonopt continue` goes on after any break: the same branch, to the byte."""

import json
import random
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from branches import (
    BRANCH,
    COLUMN,
    FILES,
    LONG,
    SHORT,
    TABLE,
    WAIT,
    Whole,
    each_long,
    finished,
    lines_appear,
    points,
    started,
    written,
)
from disks import Full

from ribbonopt.studies.continuation import files as branch_files

Run = Callable[..., Any]


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

    monkeypatch.setattr("ribbonopt.solvers.newton.NewtonSolver.solve", never)
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
    process = started(reference.scene, "--out", folder, "--json", waits=3)
    lines_appear(folder / BRANCH, 3, process)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=WAIT)
    kept = points(folder)
    assert (process.returncode, out) == (130, b"")
    told = f"ribbonopt: interrupted; {len(kept)} points kept in {folder}, --resume goes on"
    assert err.decode().startswith(told)
    assert len(kept) == 3 < len(points(reference.folder))
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
