"""Hostile environments: what a shell, a queue or a folder may do to a command that is in order.

Each case is a real process of its own, of a launcher that stands elsewhere, as `ribbonopt` is
installed: with `-c` or `-m` Python itself would import from the working folder.
"""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

from attack_runs import GOOD, Run, hidden

LAUNCHER = "import sys\nfrom ribbonopt.cli import run\nrun()\n"
SCENE = """\
name: arch
law: {type: variational, delta: 0.1}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0.05, 0.8], directors: identity}
transcription: {type: collocation, degree: 4, intervals: 6}
continuation: {parameter: boundary.end.position.2, to: 0.75, first: 0.02, special: false}
"""
STUDY = """\
name: study
scene: scene.yaml
sweep: {grid: {boundary.end.position.2: {from: 0.7, to: 0.74, count: 3}}}
time_limit: 60
"""
VERBS = {
    "solve": ["solve", "scene.yaml", "--out", "out"],
    "draw": ["solve", "scene.yaml", "--plot"],
    "check": ["check", "scene.yaml", "--json"],
    "continue": ["continue", "scene.yaml", "--quiet"],
    "batch": ["batch", "study.yaml", "--jobs", "2"],
}
READER_GONE = 141
SHADOWED = ("struct", "yaml", "json", "numpy", "casadi", "ribbonopt", "subprocess", "site")
SECONDS = 120.0


@dataclass(frozen=True)
class Environment:
    """Variables, files in the working folder, and what is done in the process before it begins."""

    label: str
    variables: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    before: Callable[[], None] | None = None
    allowed: tuple[int, ...] = GOOD
    needed: tuple[int, ...] = GOOD  # statuses that it must have one of: (0,) where nothing is amiss


def _limit(kind: int, value: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(kind, (value, value))


def _closed(*numbers: int) -> Callable[[], None]:
    def close() -> None:
        for number in numbers:
            os.close(number)

    return close


def _onto(path: str, *numbers: int) -> Callable[[], None]:
    def point() -> None:
        file = os.open(path, os.O_WRONLY)
        for number in numbers:
            os.dup2(file, number)

    return point


def _reader_gone() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    os.dup2(writing, 1)


def _umask() -> None:
    os.umask(0o777)


def _folder_gone() -> None:
    folder = Path.cwd() / "gone"
    folder.mkdir()
    os.chdir(folder)
    folder.rmdir()


def environments() -> Iterator[Environment]:
    """Yield all environments; those that ask for what only root may not have are left out."""
    fine = (0,)
    for module in SHADOWED:
        text = f"raise RuntimeError('{module} of the working folder')\n"
        yield Environment(f"shadowed {module}", files={f"{module}.py": text}, needed=fine)
        endless = "import time\ntime.sleep(1000)\n"
        yield Environment(f"endless {module}", files={f"{module}.py": endless}, needed=fine)
    for name, value in {
        "PYTHONIOENCODING": "ascii",
        "LC_ALL": "C",
        "PYTHONUTF8": "0",
        "HOME": "/nonexistent",
        "MPLCONFIGDIR": "/dev/null",
        "XDG_CACHE_HOME": "/dev/null",
        "COLUMNS": "0",
        "TERM": "\x1b[31m",
        "PATH": "",
        "TZ": "Nowhere/Nothing",
        "PYTHONOPTIMIZE": "2",
        "PYTHONHASHSEED": "7",
        "OPENBLAS_NUM_THREADS": "many",
        "PYTHONWARNINGS": "default",
    }.items():
        yield Environment(f"{name}={value!r}", {name: value}, needed=fine)
    yield Environment("cp1252", {"PYTHONIOENCODING": "cp1252"}, needed=fine)
    yield Environment("utf-16", {"PYTHONIOENCODING": "utf-16"}, needed=fine)
    yield Environment("COLUMNS=-5", {"COLUMNS": "-5"}, needed=fine)
    yield Environment("COLUMNS=word", {"COLUMNS": "word"}, needed=fine)
    yield Environment("no backend", {"MPLBACKEND": "nonsense"})
    yield Environment("no TMPDIR", {"TMPDIR": "/nonexistent"}, needed=fine)
    for closed in ((0,), (1,), (2,), (1, 2), (0, 1, 2)):
        words = " and ".join(("stdin", "stdout", "stderr")[n] for n in closed)
        yield Environment(f"{words} closed", before=_closed(*closed))
    yield Environment("stdout full", before=_onto("/dev/full", 1))
    yield Environment("stderr full", before=_onto("/dev/full", 2), needed=fine)
    yield Environment("both full", before=_onto("/dev/full", 1, 2))
    yield Environment("reader gone", before=_reader_gone, allowed=(*GOOD, READER_GONE))
    yield Environment("folder gone", before=_folder_gone)
    yield Environment("umask 777", before=_umask)
    yield Environment("12 files", before=_limit(resource.RLIMIT_NOFILE, 12))
    yield Environment("30 files", before=_limit(resource.RLIMIT_NOFILE, 30))
    yield Environment("no file over 2 kB", before=_limit(resource.RLIMIT_FSIZE, 2_000))
    yield Environment("no file over 0 B", before=_limit(resource.RLIMIT_FSIZE, 0))
    for megabytes in (250, 300, 400, 700):  # with less, no numpy can be imported
        limit = _limit(resource.RLIMIT_AS, megabytes << 20)
        yield Environment(f"{megabytes} MB", before=limit)
    if os.geteuid():  # root may have as many as it likes
        yield Environment("no more processes", before=_limit(resource.RLIMIT_NPROC, 1))


def runs(
    folder: Path, seed: int, count: int, first: int, jobs: int
) -> Iterator[tuple[str, str, int | None, str]]:
    """Yield label, verb, exit status and fault of at most `count` runs, every `jobs`-th of them."""
    every = [(environment, verb) for environment in environments() for verb in VERBS]
    Random(seed).shuffle(every)
    folder.mkdir()
    launcher = folder / "ribbonopt-launcher"
    launcher.write_text(LAUNCHER, encoding="utf-8")
    for index, (environment, verb) in enumerate(every[:count]):
        if index % jobs == first:
            place = folder / str(index)
            run = run_in(environment, verb, place, launcher)
            yield environment.label, verb, run.status, fault_of(environment, run, place)


def run_in(environment: Environment, verb: str, folder: Path, launcher: Path) -> Run:
    """Run a verb in an environment, in a new folder."""
    folder.mkdir()
    texts = {"scene.yaml": SCENE, "study.yaml": STUDY, **environment.files}
    for name, text in texts.items():
        (folder / name).write_text(text)
    words = folder.with_name(f"{folder.name}.out"), folder.with_name(f"{folder.name}.err")
    started = time.perf_counter()
    with open(words[0], "wb") as out, open(words[1], "wb") as err:
        child = subprocess.Popen(
            [sys.executable, str(launcher), *VERBS[verb]],
            cwd=folder,
            env=os.environ | environment.variables,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            preexec_fn=environment.before,
            start_new_session=True,
        )
        status: int | None = None
        with suppress(subprocess.TimeoutExpired):
            try:
                status = child.wait(SECONDS)
            finally:
                if status is None:
                    os.killpg(child.pid, signal.SIGKILL)
                    child.wait()
    encoding = "utf-16" if environment.label == "utf-16" else "utf-8"
    said = [path.read_bytes().decode(encoding, errors="replace") for path in words]
    return Run(status, *said, time.perf_counter() - started)


def fault_of(environment: Environment, run: Run, folder: Path) -> str:
    """Return what was wrong with a run in an environment; "" if nothing."""
    silent = any(word in environment.label for word in ("stderr", "both"))
    fault = run.fault
    if fault.endswith("without a word") and silent:
        fault = ""
    if fault.startswith("exit status") and run.status in environment.allowed:
        fault = ""
    if not fault and run.status not in (*environment.needed, *environment.allowed[len(GOOD) :]):
        fault = f"exit status {run.status}, expected {environment.needed}: {run.err[-300:]}"
    left = [] if fault or not folder.is_dir() else hidden(folder)
    return f"left behind: {', '.join(left[:3])}" if left else fault
