"""Signals that end a command, at any time: as Ctrl-C does."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from batches import COMMAND, STUDY
from branches import WAIT, environment

SCRIPTS = Path(__file__).parents[2] / "scripts"
ENDING = [signal.SIGTERM, signal.SIGHUP, signal.SIGXCPU, signal.SIGINT]
#: a command that is told signals where its test says so
BEGIN = """\
import os, signal, sys, time
import ribbonopt.cli as cli
from ribbonopt.cli import command

def tell(number=signal.SIGTERM):
    signal.raise_signal(number)

def run(name, verb):
    command._verb = lambda _: verb
    sys.argv[1:] = ["schema"]
    cli.run()
"""
TOLD = "ribbonopt: interrupted; nothing half-written is left\n"
#: moments, and what comes of them
MOMENTS = {
    "in the middle": (
        """
def verb(options):
    tell()
    time.sleep(60)
""",
        143,
        TOLD,
    ),
    "twice, and while it is put away": (
        """
def verb(options):
    try:
        tell(signal.SIGHUP)
        time.sleep(60)
    finally:
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            tell(number)
        print("put away", file=sys.stderr)
""",
        129,
        "put away\n" + TOLD,
    ),
    "in a destructor": (
        """
class Last:
    def __del__(self):
        tell()

def verb(options):
    Last()
    time.sleep(60)
""",
        143,
        TOLD,
    ),
    "where a library takes all for an error and goes on": (
        """
def verb(options):
    try:
        tell()
    except:
        pass
    time.sleep(60)
""",
        143,
        TOLD,
    ),
    "while it takes long to put away": (
        """
from contextlib import closing

def rows():
    try:
        yield 1
    finally:
        time.sleep(1.2)  # is told again meanwhile
        print("put away", file=sys.stderr)

def verb(options):
    with closing(rows()) as found:
        next(found)
        tell()
        time.sleep(60)
""",
        143,
        "put away\n" + TOLD,
    ),
    "while a result is written": (
        """
def verb(options):
    namespace = {"__name__": "ribbonopt.output.other", "tell": tell, "sys": sys, "time": time}
    exec("def write():\\n tell()\\n time.sleep(0.1)\\n print('whole', file=sys.stderr)", namespace)
    namespace["write"]()
    time.sleep(60)
""",
        143,
        "whole\n" + TOLD,
    ),
    "made an error of its own by a library": (
        """
from ribbonopt.errors import OutputError

def verb(options):
    try:
        tell()
        time.sleep(60)
    except KeyboardInterrupt:
        raise OutputError("no font")
""",
        143,
        "ribbonopt: no font\n",
    ),
    "too late": (
        """
def verb(options):
    return 0
whole = cli.flushed
def flushed(status):
    tell()
    return whole(status)
cli.flushed = flushed
""",
        143,
        "",
    ),
}


def python(code: str, folder: Path) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=WAIT,
        check=False,
    )


@pytest.mark.parametrize("moment", MOMENTS)
def test_told_at_any_moment(tmp_path: Path, moment: str) -> None:
    code, status, said = MOMENTS[moment]
    done = python(BEGIN + code + "\nrun('verb', verb)\n", tmp_path)
    assert (done.returncode, done.stderr) == (status, said)


def test_what_is_ignored_stays_ignored(tmp_path: Path) -> None:
    code = """
def verb(options):
    tell(signal.SIGHUP)
    return 0
signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
run('verb', verb)
"""
    assert python(BEGIN + code, tmp_path).returncode == 0


def test_who_imports_it_keeps_their_own_handlers(tmp_path: Path) -> None:
    code = """\
import signal, sys
numbers = [n for n in signal.valid_signals()]
before = [signal.getsignal(n) for n in numbers], sys.unraisablehook
import ribbonopt.cli, ribbonopt.cli.batch, ribbonopt.studies.batch.worker
ribbonopt.cli.main(["check", "none.yaml"])
assert before == ([signal.getsignal(n) for n in numbers], sys.unraisablehook)
"""
    done = python(code, tmp_path)
    assert (done.returncode, done.stderr.count("\n")) == (0, 1), done.stderr


def lines(path: Path) -> int:
    return path.read_bytes().count(b"\n") if path.exists() else 0


def children(process: int) -> list[int]:
    files = Path(f"/proc/{process}/task").glob("*/children")  # each thread has its own
    return [int(word) for file in files for word in file.read_text().split()]


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="the system lists no children")
@pytest.mark.parametrize("number", ENDING)
def test_all_processes_of_a_batch_are_told(
    study: Path, tmp_path: Path, number: signal.Signals
) -> None:
    """As clusters do: no ribbon is taken for crashed."""
    study.write_text(STUDY.replace("count: 30", "count: 3000"))
    out = tmp_path / "out"
    process = subprocess.Popen(
        [*COMMAND, str(study), "--jobs", "2", "--out", str(out)], stderr=subprocess.PIPE, text=True
    )
    rows = out / "rows.jsonl"
    while process.poll() is None and lines(rows) <= 5:
        pass
    workers = children(process.pid)
    for one in workers:
        os.kill(one, number)
    there = lines(rows)
    while process.poll() is None and lines(rows) < there + 5:
        pass  # what they were told changes nothing
    process.send_signal(number)
    _, err = process.communicate(timeout=WAIT)
    assert workers
    text = rows.read_text()
    assert process.returncode == 128 + number
    assert f"interrupted; {text.count(chr(10))} of 3000 rows kept in {out}, --resume goes on" in err
    assert "crashed" not in text
    assert sorted(os.listdir(out)) == ["rows.jsonl", "study.json", "table.csv"]
    for one in workers:  # they are waited for
        with pytest.raises(ProcessLookupError):
            os.kill(one, 0)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["solve", "continue", "batch"])
def test_killed_at_random(tmp_path: Path, kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(SCRIPTS)
    from attack_kills import attack

    report = attack(tmp_path, kills=2, seed=sum(map(ord, kind)), kinds=(kind,))
    assert report.faults == []
    assert sum(report.endings.values()) == 2
