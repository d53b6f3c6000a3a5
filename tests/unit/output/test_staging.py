"""Places of results: checked before anything is spent, locked, and put right after a kill."""

import os
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from ribbonopt.errors import OutputError
from ribbonopt.output import locks, placing
from ribbonopt.output.claims import claimed, pictures_in, put_all_right
from ribbonopt.output.staging import recovered, replaced, replacing, staged_result

FILE = "summary.json"
#: takes a place as `staged_result` does, says so, and waits to be killed
HOLDER = """\
import sys, time
from ribbonopt.output.staging import staged_result
with staged_result(sys.argv[1]) as stage:
    (stage.folder / "summary.json").write_text("half")
    print("there", flush=True)
    time.sleep(600)
"""


def store(place: Path, text: str, failure: str = "") -> Path:
    with staged_result(place) as stage:
        (stage.folder / FILE).write_text(text)
        return stage.commit(failure)


def names(folder: Path) -> list[str]:
    return sorted(os.listdir(folder))


def held(place: Path) -> "subprocess.Popen[str]":
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(place)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "there\n"
    return process


def ended(process: "subprocess.Popen[str]") -> None:
    process.kill()
    process.communicate()


# two processes, and dead ones


def test_a_place_is_of_one_process_until_it_is_killed(tmp_path: Path) -> None:
    place = tmp_path / "result"
    process = held(place)
    try:
        with pytest.raises(OutputError, match=f"another process \\({process.pid} on "):
            store(place, "mine")
        with pytest.raises(OutputError, match="is being written by another process"):
            claimed(place, ()).__enter__()
    finally:
        ended(process)
    assert names(tmp_path) == [".result.lock", ".result.new"]
    store(place, "mine")
    assert names(tmp_path) == ["result"]
    assert names(place) == [FILE]


def test_who_waits_comes_next(tmp_path: Path) -> None:
    process = held(tmp_path / "result")
    process.kill()
    with staged_result(tmp_path / "result", wait=60):  # until the system knows that it is dead
        pass
    process.communicate()


def test_a_claimed_folder_is_not_replaced_either(tmp_path: Path) -> None:
    place = tmp_path / "result"
    with claimed(place, (FILE,)):
        for refused in (lambda: claimed(place, ()).__enter__(), lambda: store(place, "mine")):
            with pytest.raises(OutputError, match="is being written by another process"):
                refused()
    assert names(tmp_path) == []


def test_without_locks_the_file_says_who_holds_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(locks, "_locked", lambda _: None)
    path = tmp_path / "lock"
    lock = locks.take(path, tmp_path)
    with pytest.raises(OutputError, match=f"{os.getpid()} on .*if there is none, remove {path}"):
        locks.take(path, tmp_path)
    lock.release()
    assert names(tmp_path) == []
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    host = socket.gethostname()
    path.write_text(f"{dead.pid} {host}\n")
    locks.take(path, tmp_path).release()
    for other in (f"{dead.pid} {host}-other", f"{os.getpid()} {host}", "", "\x00\xff" * 200):
        path.write_text(other)
        with pytest.raises(OutputError, match="another process"):
            locks.take(path, tmp_path)
    path.unlink()


@pytest.mark.parametrize("make", [Path.mkdir, os.mkfifo, lambda p: p.symlink_to("elsewhere")])
def test_a_lock_that_is_no_file_is_refused(tmp_path: Path, make: Callable[[Path], None]) -> None:
    make(tmp_path / ".result.lock")
    with pytest.raises(OutputError, match="cannot be written"):
        store(tmp_path / "result", "mine")
    assert names(tmp_path) == [".result.lock"]


MOMENTS = {
    "while writing": ([("result", "old"), (".result.new", "half")], "old"),
    "with the old one aside": ([(".result.old", "old"), (".result.new", "new")], "new"),
    "with both in place": ([("result", "new"), (".result.old", "old")], "new"),
    "with nothing new": ([(".result.old", "old")], "old"),
}


@pytest.mark.parametrize("moment", MOMENTS)
def test_killed_at_any_moment(tmp_path: Path, moment: str) -> None:
    there, kept = MOMENTS[moment]
    for name, text in there:
        (tmp_path / name).mkdir()
        (tmp_path / name / FILE).write_text(text)
    (tmp_path / ".result.lock").write_text("1 nowhere")
    place = tmp_path / "result"
    if not place.exists():  # who reads finds it too
        assert (recovered(place) / FILE).read_text() == kept
    with staged_result(place) as stage:
        assert (place / FILE).read_text() == kept
        assert names(stage.folder) == []
    assert names(tmp_path) == ["result"]
    assert (place / FILE).read_text() == kept


def test_failed_solves_and_folders_of_many_are_put_right_too(tmp_path: Path) -> None:
    for name in (".result.not-converged.old", ".result.not-converged.new"):
        (tmp_path / name).mkdir()
        (tmp_path / name / FILE).write_text(name[-3:])
    store(tmp_path / "result", "mine")
    assert names(tmp_path) == ["result", "result.not-converged"]
    assert (tmp_path / "result.not-converged" / FILE).read_text() == "new"
    for name in (".7.new", ".8.old"):
        (tmp_path / name).mkdir()
    (tmp_path / ".9.lock").write_text("")
    (tmp_path / ".lock").write_text("of the folder itself")
    process = held(tmp_path / "10")
    put_all_right(tmp_path)
    here = [".10.lock", ".10.new", ".lock", "8", "result", "result.not-converged"]
    assert names(tmp_path) == here
    ended(process)


def test_interrupted_between_two_moves_is_complete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place, move = tmp_path / "result", Path.replace
    store(place, "old")

    def interrupted(source: Path, target: Path) -> Path:
        if target == place and source.name == ".result.new" and not told:
            told.append(True)
            raise KeyboardInterrupt
        return move(source, target)

    told: list[bool] = []
    monkeypatch.setattr(Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        store(place, "new")
    assert (place / FILE).read_text() == "new"
    assert names(tmp_path) == ["result"]


def test_what_cannot_take_its_place_is_kept_beside(tmp_path: Path) -> None:
    place = tmp_path / "result"
    store(place, "old")
    for number in ("", "1"):
        with staged_result(place) as stage:
            (stage.folder / FILE).write_text("new")
            (place / "letters.txt").write_text("dear")  # while it was solved
            kept = f"letters.txt.*; the result is kept in {place}.kept{number}$"
            with pytest.raises(OutputError, match=kept):
                stage.commit()
        (place / "letters.txt").unlink()
        assert (tmp_path / f"result.kept{number}" / FILE).read_text() == "new"
    assert names(tmp_path) == ["result", "result.kept", "result.kept1"]
    assert (place / FILE).read_text() == "old"


# places that are refused


def refused(place: Path | str, words: str) -> None:
    with pytest.raises(OutputError, match=words), staged_result(place):
        raise AssertionError("solved")


def test_the_working_folder_is_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a").mkdir()
    monkeypatch.chdir(tmp_path / "a")
    for place in (".", "", "../a", tmp_path / "a", "..", "b/../../a"):
        refused(place, "the working folder is in it|holds files")
    refused("/", "root of the file system|holds files")
    (tmp_path / "a" / "equilibria").mkdir()
    monkeypatch.chdir(tmp_path / "a" / "equilibria")
    refused("..", "the working folder is in it")
    assert names(tmp_path) == ["a"]


@pytest.mark.parametrize("to", ["there", "nowhere", "link"])
def test_links_are_not_followed(tmp_path: Path, to: str) -> None:
    (tmp_path / "there").mkdir()
    link = tmp_path / "link"
    link.symlink_to(to)
    refused(link, "is a link to .*, name the place itself")
    with pytest.raises(OutputError, match="is a link to"):
        claimed(link, ()).__enter__()
    if to != "there":
        refused(link / "result", "is a link to .*, which is not there")
    assert names(tmp_path) == ["link", "there"]
    assert names(tmp_path / "there") == []


def test_names_that_no_file_system_takes(tmp_path: Path) -> None:
    refused(tmp_path / "a\0b", "null character")
    refused(tmp_path / ("a" * 300), "cannot be|too long")
    refused(tmp_path / ("é" * 120), "too long")
    refused(tmp_path / ("a" * 300) / "b", "too long")
    assert names(tmp_path) == []


def test_a_file_on_the_way_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    refused(tmp_path / "file", "is a file")
    refused(tmp_path / "file" / "a" / "b", "cannot be written")
    with pytest.raises(OutputError, match=r"is a file|cannot be written"):
        claimed(tmp_path / "file", ()).__enter__()
    assert (tmp_path / "file").read_text() == "mine"


def test_disks_are_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "disk").mkdir()
    monkeypatch.setattr(os.path, "ismount", lambda path: Path(path).name == "disk")
    refused(tmp_path / "disk", "a file system is mounted there")


def test_folders_of_others_are_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in /tmp: all may write there, and move what is their own only."""
    (tmp_path / "sticky" / "result").mkdir(parents=True)
    (tmp_path / "sticky").chmod(0o1777)
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    refused(tmp_path / "sticky" / "result", "belongs to another user")
    monkeypatch.setattr(os, "access", lambda *_: False)
    refused(tmp_path / "sticky" / "result", "read-only")


def test_folders_that_were_made_for_nothing_go_again(tmp_path: Path) -> None:
    with staged_result(tmp_path / "a" / "b" / "c"):
        assert (tmp_path / "a" / "b").is_dir()
    assert names(tmp_path) == []
    (tmp_path / "given").mkdir()
    with claimed(tmp_path / "given", ()):
        pass
    assert names(tmp_path) == ["given"]


# files


@pytest.mark.parametrize("name", ["table.csv", ".table.csv.new"])
def test_files_are_not_written_through_links(tmp_path: Path, name: str) -> None:
    (tmp_path / "mine").write_text("mine")
    (tmp_path / name).symlink_to("mine")
    with replacing(tmp_path / "table.csv") as file:
        file.write("rows")
    assert (tmp_path / "mine").read_text() == "mine"
    assert (tmp_path / "table.csv").read_text() == "rows"
    assert not (tmp_path / "table.csv").is_symlink()


def test_a_file_of_ours_that_is_a_link_is_refused(tmp_path: Path) -> None:
    (tmp_path / "rows.jsonl").symlink_to("/etc/hosts")
    with pytest.raises(OutputError, match=r"rows\.jsonl: is a link to /etc/hosts; .* remove it"):
        claimed(tmp_path, ("rows.jsonl",)).__enter__()
    assert names(tmp_path) == ["rows.jsonl"]


def test_what_a_picture_left_half_written_goes(tmp_path: Path) -> None:
    for name in (".strains.png.new", ".mine.new"):
        (tmp_path / name).write_text("half")
    with pictures_in(tmp_path) as folder:
        assert folder == tmp_path
        with pytest.raises(ValueError, match="no"), replaced(folder / "strains.png") as new:
            new.write_text("half")
            raise ValueError("no")
    assert names(tmp_path) == [".mine.new"]


def test_a_result_is_on_disk_before_it_is_in_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[str] = []
    monkeypatch.setattr(placing, "sync_all", lambda path: done.append(f"all {path.name}"))
    monkeypatch.setattr(placing, "sync", lambda path: done.append(f"list {path.name}"))
    monkeypatch.setattr(Path, "replace", lambda a, b: done.append(f"{a.name} to {b.name}"))
    placing.place(tmp_path / ".a.new", tmp_path / "a", (), True)
    assert done == ["all .a.new", ".a.new to a", f"list {tmp_path.name}"]
