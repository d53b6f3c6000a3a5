"""Worker processes that misbehave: one row for each ribbon, or one error, whatever they do."""

import errno
import json
import os
import random
import subprocess
import sys
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from half_studies import swept

from ribbonopt.errors import WorkerError
from ribbonopt.plain import Row
from ribbonopt.studies.batch import child, processes
from ribbonopt.studies.batch.chunks import chunks_of
from ribbonopt.studies.batch.processes import WorkerProcess, lost_row

# What stands in for the solving process: `act` says what it does at a ribbon, and how often.
FAKE = """\
import json, os, sys, time
def say(answer):
    sys.stdout.write("\\n" + json.dumps(answer) + "\\n"); sys.stdout.flush()
def row(number, **more):
    say({"row": {"number": number, "status": "converged", "verified": True} | more})
def once(name):
    done = os.path.exists(name)
    open(name, "w").close()
    return not done
def act(number): pass
{before}
say({"ready": True})
for line in sys.stdin:
    chunk = json.loads(line)
    for ribbon in chunk["ribbons"]:
        number = ribbon["number"]
        if number in chunk["skip"]:
            continue
        if act(number) == "done": continue
        say({"at": number})
        if act(-number) == "done": continue
        if number not in chunk["known"]:
            row(number)
"""

Begun = Callable[..., WorkerProcess]


@pytest.fixture
def begun(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Begun]:
    """Return the maker of workers whose process runs the fake, with some lines before it starts."""
    workers = []
    monkeypatch.chdir(tmp_path)

    def made(before: str = "", *, time_limit: float = 60.0) -> WorkerProcess:
        script = tmp_path / "fake.py"
        script.write_text(FAKE.replace("{before}", before))
        monkeypatch.setattr(child, "BEGIN", script)
        workers.append(WorkerProcess(time_limit=time_limit))
        return workers[-1]

    yield made
    for worker in workers:
        worker.close()


def rows_of(worker: WorkerProcess, known: dict[int, str] | None = None) -> dict[int, Row]:
    """Return the rows of a study of nine by number, each of which came once."""
    (*chunks,) = chunks_of(swept(grid={"a": list(range(9))}))
    assert len(chunks) == 3
    found = [row for chunk in chunks for row in worker.rows(chunk, known or {})]
    assert max(Counter(row["number"] for row in found).values(), default=1) == 1
    return {row["number"]: row for row in found}


def test_rows_of_a_good_process(begun: Begun) -> None:
    found = rows_of(begun())
    assert sorted(found) == list(range(1, 10))
    assert {row["status"] for row in found.values()} == {"converged"}
    assert sorted(rows_of(begun(), dict.fromkeys((1, 5, 9), "converged"))) == [2, 3, 4, 6, 7, 8]


DYING = {
    "says why": ("print('no licence today', file=sys.stderr); sys.exit(3)", "exit status 3", True),
    "raises": ("raise RuntimeError('no licence today')", "exit status 1", True),
    "is killed": ("os.kill(os.getpid(), 9)", "signal 9", False),
    "prints only": ("print('no licence today'); sys.exit(0)", "exit status 0", True),
    "says very much": (
        "print('x' * 10**6 + ' no licence today', file=sys.stderr); sys.exit(1)",
        "exit status 1",
        True,
    ),
    "speaks otherwise": ("say({'steady': True}); time.sleep(600)", "signal 9", False),
    "row first": ("row(1); time.sleep(600)", "signal 9", False),
}


@pytest.mark.parametrize("case", DYING)
def test_lost_before_its_first_answer_is_one_error(begun: Begun, case: str) -> None:
    before, how, quoted = DYING[case]
    with pytest.raises(WorkerError) as caught:
        rows_of(begun(before))
    text = str(caught.value)
    assert "ended before it could solve anything" in text
    assert how in text
    assert ("no licence today" in text) == quoted
    assert len(text) < 1000 and "\n" not in text


def test_a_start_that_hangs_has_a_limit_of_its_own(
    begun: Begun, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(processes, "STARTING", 0.5)
    told = "open('pid', 'w').write(str(os.getpid())); time.sleep(600)"
    with pytest.raises(WorkerError, match=r"did not start within 0\.5 s"):
        rows_of(begun(told, time_limit=1e9))


@pytest.mark.parametrize("number", [errno.EAGAIN, errno.ENOMEM, errno.ENOENT, errno.EACCES])
def test_processes_that_the_system_refuses(
    begun: Begun, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    worker = begun()

    def refuse(*_: object, **__: object) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(subprocess, "Popen", refuse)
    with pytest.raises(WorkerError) as caught:
        rows_of(worker)
    assert os.strerror(number) in str(caught.value)
    assert "--jobs" in str(caught.value)


def test_threads_that_the_system_refuses(begun: Begun, monkeypatch: pytest.MonkeyPatch) -> None:
    worker = begun()

    def refuse(_: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", refuse)
        with pytest.raises(WorkerError, match="can't start new thread"):
            rows_of(worker)
    assert len(rows_of(worker)) == 9


@pytest.mark.parametrize("program", ["", "/no/such/python", None])
def test_no_interpreter(begun: Begun, monkeypatch: pytest.MonkeyPatch, program: str | None) -> None:
    worker = begun()
    monkeypatch.setattr(sys, "executable", program)
    with pytest.raises(WorkerError, match="could not be started"):
        rows_of(worker)


# What a process does at the fifth ribbon, before it says so (5) or after (-5), and who pays.
MISBEHAVING = {
    "dies at it": ("if number == -5: os._exit(9)", {5: "crashed"}),
    "dies at it, in a line": (
        'if number == -5: sys.stdout.write(\'{"row": {"num\'); sys.stdout.flush(); os._exit(9)',
        {5: "crashed"},
    ),
    "dies between, once": ("if number == 5 and once('gone'): os._exit(9)", {}),
    "dies between, always": ("if number == 5: os._exit(9)", {5: "crashed"}),
    "dies between, killed": ("if number == 5: os.kill(os.getpid(), 9)", {5: "crashed"}),
    "prints": ("print('hello'); sys.stdout.write('{}[' * 99 + chr(10)); print('[' * 10**5)", {}),
    "prints bytes": ("os.write(1, bytes(range(256)) + b'\\n')", {}),
    "speaks of another": ("if number == -5: row(6); time.sleep(600)", {5: "crashed"}),
    "begins another": ("if number == -5: say({'at': 77}); time.sleep(600)", {5: "crashed"}),
    "begins it twice": ("if number == -5: say({'at': 5})", {5: "crashed"}),
    "begins no number": ("if number == -5: say({'at': 'five'}); time.sleep(600)", {5: "crashed"}),
    "speaks out of turn": ("if number == 5: row(5); return 'done'", {5: "crashed"}),
    "speaks twice": ("if number == -5: row(5)", {5: "converged"}),
    "row of nothing": ("if number == -5: say({'row': None}); time.sleep(600)", {5: "crashed"}),
    "row without status": ("if number == -5: say({'row': {'number': 5}})", {5: "crashed"}),
    "is ready again": ("if number == -5: say({'ready': True})", {5: "crashed"}),
    "says much": ("sys.stderr.write('x' * 10**6)", {}),
}


@pytest.mark.parametrize("case", MISBEHAVING)
def test_whatever_it_does_each_ribbon_has_one_row(begun: Begun, case: str) -> None:
    act, lost = MISBEHAVING[case]
    found = rows_of(begun(f"def act(number):\n    {act}"))
    expected = dict.fromkeys(range(1, 10), "converged") | lost
    assert {number: row["status"] for number, row in sorted(found.items())} == expected


def test_what_it_said_last_is_quoted(begun: Begun) -> None:
    act = """\
def act(number):
    print("about", number, file=sys.stderr, flush=True)
    if number == -5: os._exit(9)
"""
    row = rows_of(begun(act))[5]
    assert "its process died (exit status 9); it said: " in row["message"]
    assert "about -5" in row["message"]


@pytest.mark.parametrize(
    "act", ["if number == -5: time.sleep(600)", "if number == 5: time.sleep(600)"]
)
def test_what_hangs_is_given_up(begun: Begun, act: str) -> None:
    found = rows_of(begun(f"def act(number):\n    {act}", time_limit=1.0))
    assert sorted(found) == list(range(1, 10))
    assert found[5]["status"] == "timed_out"
    assert "took more than 1 s" in found[5]["message"]


def test_lost_ribbons_are_not_tried_again(begun: Begun) -> None:
    worker = begun("def act(number):\n    if number == -5: open('tried', 'a').write('x')")
    known = {5: "crashed", 2: "converged"}
    assert sorted(rows_of(worker, known)) == [1, 3, 4, 6, 7, 8, 9]
    assert not Path("tried").exists()


def test_what_nobody_asked_for_is_not_solved(begun: Begun) -> None:
    """Neighbours before it are; those after it are not."""
    worker = begun("def act(number):\n    open('tried', 'a').write(f'{number} ')")
    (chunk, *_) = chunks_of(swept(grid={"a": list(range(9))}))
    first, second, third = (ribbon.number for ribbon in chunk.ribbons)
    (row,) = worker.rows(chunk, {first: "converged", third: "converged"})
    assert row["number"] == second
    assert Path("tried").read_text().split() == [str(n) for n in (first, -first, second, -second)]


ANYTHING = [
    *("os._exit(1)", "os.kill(os.getpid(), 15)", "row(number)", "row(abs(number) + 1)"),
    *(
        "print('{')",
        "say({})",
        "say({'at': 3})",
        "os.write(1, b'{\"row\"')",
        "row(abs(number), verified=1)",
    ),
    *(
        "print('x' * 10**5)",
        "raise KeyError(number)",
        "os.close(0)",
        "pass",
        "pass",
        "pass",
    ),
]


@pytest.mark.parametrize("seed", range(6))
def test_one_row_each_whatever_it_does_at_random(begun: Begun, seed: int) -> None:
    rng = random.Random(seed)
    acts = {number * sign: rng.choice(ANYTHING) for number in range(1, 10) for sign in (1, -1)}
    lines = [f"    if number == {number} and once('{number}'): {a}" for number, a in acts.items()]
    found = rows_of(begun("\n".join(["def act(number):", *lines])))
    assert sorted(found) == list(range(1, 10))
    assert {row["status"] for row in found.values()} <= {"converged", "crashed"}


@pytest.mark.parametrize("times", [1, 2])
def test_another_start_is_tried_again(begun: Begun, times: int) -> None:
    """After a process that could solve: the system may have been short of something."""
    before = f"""\
open("starts", "a").write("x")
if 1 <= len(open("starts").read()) - 1 <= {times}: os._exit(4)
def act(number):
    if number == -5 and once("five"): os._exit(9)
"""
    found = rows_of(begun(before))
    assert [n for n, row in sorted(found.items()) if row["status"] == "crashed"] == [5]
    assert len(found) == 9


def test_starts_that_fail_for_ever_are_an_error(begun: Begun) -> None:
    worker = begun("if not once('first'): os._exit(4)\ndef act(n):\n    if n == -5: os._exit(9)")
    found: list[Row] = []
    with pytest.raises(WorkerError, match="exit status 4"):
        for chunk in chunks_of(swept(grid={"a": list(range(9))})):
            found.extend(worker.rows(chunk, {}))
    assert all(row["status"] == "converged" for row in found if row["number"] != 5)


def test_closed_while_it_hangs(begun: Begun) -> None:
    worker = begun(
        "def act(number):\n    if number == -5: open('at5', 'w').close(); time.sleep(600)"
    )
    found: list[Row] = []
    (*chunks,) = chunks_of(swept(grid={"a": list(range(9))}))

    def serve() -> None:
        for chunk in chunks:
            found.extend(worker.rows(chunk, {}))

    thread = threading.Thread(target=serve)
    thread.start()
    while thread.is_alive() and not Path("at5").exists():
        thread.join(0.01)
    worker.close()
    thread.join()
    assert all(row["status"] == "converged" for row in found)
    assert 5 not in {row["number"] for row in found}


def test_answers_say_what_the_study_asked(tmp_path: Path) -> None:
    (chunk, *_) = chunks_of(swept(grid={"a": [1]}))
    row = lost_row(chunk.ribbons[0], "crashed", "why")
    assert json.loads(json.dumps(row)) == {
        "number": 1,
        "scene": "scene.yaml",
        "a": 1,
        "status": "crashed",
        "verified": False,
        "message": "why",
    }


def path_of(monkeypatch: pytest.MonkeyPatch, main: Any, *path: Any) -> list[str]:
    monkeypatch.setattr(sys, "path", list(path))
    monkeypatch.setitem(sys.modules, "__main__", main)
    return child.search_path()


class Main:
    """What `__main__` knows of how it was started."""

    __spec__ = None

    def __init__(self, file: str | None) -> None:
        if file:
            self.__file__ = file


def test_the_callers_folders_are_looked_through_last(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    there.mkdir()
    (tmp_path / "link").symlink_to(here)
    monkeypatch.chdir(here)
    end = str(here)
    for first in ("", ".", end, str(tmp_path / "link"), "../here"):
        found = path_of(monkeypatch, Main(None), first, "/a", "/b")
        assert found[:2] == ["/a", "/b"] and os.path.realpath(found[2]) == end
    script = str(there / "run.py")
    assert path_of(monkeypatch, Main(script), str(there), "/a") == ["/a", str(there)]
    # Not where it comes later: somebody put it there; a module run by -m has it from Python.
    assert path_of(monkeypatch, Main(script), "/a", str(there), "/b") == ["/a", str(there), "/b"]
    assert path_of(monkeypatch, Main(None), "lib", "/a", "/a", Path("/c"), "/x\0y") == [
        str(here / "lib"),
        "/a",
    ]


def test_a_working_folder_that_is_gone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert path_of(monkeypatch, Main(None), "", "/a") == ["/a"]
