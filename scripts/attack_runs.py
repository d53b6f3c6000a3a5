"""One command of ribbonopt, run as its own process with a time limit, and what is wrong with it.

The process is forked from one that has imported everything, so that thousands are affordable: it
has its own file descriptors, folder and limits, and ends as a command ends. Linux and macOS only.
"""

from __future__ import annotations

import io
import os
import re
import resource
import signal
import sys
import time
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

GOOD = (0, 2, 3)
MEMORY = 8 << 30  # bytes of address space: what wants more must say so
LONGEST = 20_000  # characters of a message that somebody would read
HEAD = 2_000  # characters of the output that a report quotes
#: what a terminal would obey: C0 but for tabs and line ends, C1, and marks of direction
OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


@dataclass(frozen=True)
class Run:
    """How a command has ended: its status (negative: signal; None: had to be killed), its words."""

    status: int | None
    out: str
    err: str
    seconds: float

    @property
    def fault(self) -> str:
        """What no command may do, in a few words; "" if it did nothing of the kind."""
        if self.status is None:
            return f"hang: killed after {self.seconds:.0f} s"
        if "Traceback" in self.err or "Traceback" in self.out:
            return f"traceback: {self.err.strip().splitlines()[-1][:200]}"
        if self.status not in GOOD:
            return f"exit status {self.status}: {self.err[-200:]}"
        if re.search(r"\w+Warning\b", self.err):
            return f"warning: {self.err[:HEAD]}"
        if self.status and not self.err.strip():
            return f"exit status {self.status} without a word"
        if len(self.err) > LONGEST:
            return f"message of {len(self.err)} characters"
        obeyed = OBEYED.search(self.err) or OBEYED.search(self.out)
        return f"control character {obeyed[0]!r} on the terminal" if obeyed else ""


def command(arguments: Sequence[str], folder: Path, seconds: float = 60.0) -> Run:
    """Run `ribbonopt ARGUMENTS` in a folder; its output comes as a file would get it."""
    words = folder.with_name(folder.name + ".out"), folder.with_name(folder.name + ".err")
    started = time.perf_counter()
    child = os.fork()
    if child == 0:
        _be(arguments, folder, words)
    status: int | None = None
    try:
        status = _awaited(child, started + seconds)
    finally:
        if status is None:
            os.killpg(child, signal.SIGKILL)
            os.waitpid(child, 0)
    out, err = (path.read_text(encoding="utf-8", errors="replace") for path in words)
    for path in words:
        path.unlink()
    return Run(status, out, err, time.perf_counter() - started)


def _be(arguments: Sequence[str], folder: Path, words: tuple[Path, Path]) -> None:
    """Become the command; does not return."""
    try:
        os.setsid()  # so that its workers are found if it has to be killed
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        os.chdir(folder)
        files = [os.open(os.devnull, os.O_RDONLY)]
        files += [os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600) for path in words]
        for number, file in enumerate(files):
            os.dup2(file, number)
        sys.stdout = io.TextIOWrapper(io.FileIO(1, "w"), encoding="utf-8", errors="strict")
        sys.stderr = io.TextIOWrapper(
            io.FileIO(2, "w"), encoding="utf-8", errors="backslashreplace", line_buffering=True
        )
        sys.argv = ["ribbonopt", *arguments]
        from ribbonopt.cli import run

        run()
    except BaseException:
        traceback.print_exc()
    finally:
        for stream in (sys.stdout, sys.stderr):
            try:
                stream.flush()
            except (OSError, ValueError):
                pass
        os._exit(1)


def _awaited(child: int, until: float) -> int | None:
    """Return the status of a child; None if it takes too long."""
    pause = 0.001
    while time.perf_counter() < until:
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            return os.waitstatus_to_exitcode(status)
        time.sleep(pause)
        pause = min(2 * pause, 0.05)
    return None


def warm() -> None:
    """Import what most commands do, so that a process forked from this one need not."""
    import ribbonopt.cli.batch
    import ribbonopt.cli.scene
    import ribbonopt.output.results
    import ribbonopt.pipeline.check
    import ribbonopt.pipeline.prepared
    import ribbonopt.studies.batch.files
    import ribbonopt.viewer.report  # noqa: F401


def hidden(folder: Path) -> list[str]:
    """Return what a command has left beside its results: hidden names, anywhere below."""
    return sorted(str(p.relative_to(folder)) for p in folder.rglob(".*"))
