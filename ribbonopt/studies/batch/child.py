"""A process that answers in lines of JSON: how it is begun, told, listened to and ended.

Whatever it does, it is an answer, or it is lost: it ends, it hangs, it writes what is no answer.
"""

from __future__ import annotations

import errno
import json
import os
import queue
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

BEGIN = Path(__file__).resolve().with_name("begin.py")
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
LONGEST = 1 << 24  # bytes of an answer
KEPT = 1 << 12  # bytes of what it said last
QUOTED, LINES = 500, 6  # letters and lines of that in a message
PATIENCE = 1.0  # seconds for the rest of what an ended process said

Answer = dict[str, Any]


class Child:
    """A worker process with its pipes; OSError or RuntimeError where the system gives none."""

    def __init__(self, path: list[str]) -> None:
        """Begin it, its modules to be found in the folders of a path."""
        self._answers: queue.SimpleQueue[Answer | None] = queue.SimpleQueue()
        self._said, self._lock = bytearray(), threading.Lock()
        self._process = subprocess.Popen(
            [_python(), *_flags(), str(BEGIN), *path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=os.environ | ONE_THREAD,
            start_new_session=True,  # what interrupts the batch is told to it alone
        )
        listeners = (self._hear_answers, self._process.stdout), (self._hear, self._process.stderr)
        self._threads = [threading.Thread(target=t, args=(s,), daemon=True) for t, s in listeners]
        try:
            for thread in self._threads:
                thread.start()
        except RuntimeError:  # no thread to be had
            self.end()
            raise

    def tell(self, message: Answer) -> None:
        """Send a message; this does not wait until it has been read."""
        text = json.dumps(message).encode() + b"\n"
        told = self._process.stdin, text
        try:
            threading.Thread(target=_write, args=told, daemon=True).start()
        except RuntimeError:  # no thread to be had
            _write(*told)

    def answer(self, seconds: float) -> Answer | None:
        """Return the next answer; None where it has ended. TimeoutError if there is none so long.

        Parameters
        ----------
        seconds
            How long to wait.
        """
        try:
            return self._answers.get(timeout=min(seconds, threading.TIMEOUT_MAX))
        except queue.Empty:
            raise TimeoutError from None

    def end(self) -> int:
        """End it, if it has not ended; return its exit status, negative for a signal."""
        process = self._process
        process.kill()
        code = process.wait()
        for thread in self._threads:
            if thread.ident is not None:
                thread.join(PATIENCE)  # a child of its own may hold the pipes
        for stream in (process.stdin, process.stdout, process.stderr):
            if stream is not None:
                with suppress(OSError):  # what it was told and never read
                    stream.close()
        return code

    @property
    def said(self) -> str:
        """The last lines that it wrote on stderr, as one; "" if it was silent."""
        with self._lock:
            text = self._said.decode(errors="replace")
        lines = [line.strip() for line in text.splitlines() if line.strip(" \t~^")]
        return " | ".join(lines[-LINES:])[-QUOTED:]

    def _hear_answers(self, stream: IO[bytes]) -> None:
        with suppress(OSError, ValueError):  # closed meanwhile
            while line := stream.readline(LONGEST):
                try:
                    answer = json.loads(line) if line.endswith(b"\n") else None
                except (ValueError, RecursionError):
                    answer = None
                if isinstance(answer, dict):
                    self._answers.put(answer)
                elif line.strip():
                    self._keep(line)  # of a library that prints
        self._answers.put(None)

    def _hear(self, stream: IO[bytes]) -> None:
        with suppress(OSError, ValueError):
            while some := os.read(stream.fileno(), KEPT):
                self._keep(some)

    def _keep(self, some: bytes) -> None:
        with self._lock:
            self._said += some[-KEPT:]
            del self._said[:-KEPT]


def search_path() -> list[str]:
    """Return where a worker finds its modules: as this process does, the caller's folders last.

    Python puts the working folder or that of the script first, for modules of the caller, which no
    worker needs: a `struct.py` there must not stand before Python's own. They are not left out,
    since what ribbonopt needs may lie there and nowhere else.
    """
    folders = [folder for folder in sys.path if isinstance(folder, str) and "\0" not in folder]
    own = set()
    with suppress(OSError):  # the working folder is gone
        own.add(os.getcwd())
    main = sys.modules.get("__main__")
    script = getattr(main, "__file__", None)
    if folders and script and getattr(main, "__spec__", None) is None:
        own |= {folders[0]} & {os.path.dirname(script), os.path.dirname(os.path.realpath(script))}
    found = []
    for folder in folders:
        with suppress(OSError):
            found.append(os.path.abspath(folder))
    theirs = {os.path.realpath(folder) for folder in own}
    return sorted(dict.fromkeys(found), key=lambda folder: os.path.realpath(folder) in theirs)


def _python() -> str:
    """Return the program of this interpreter."""
    if not sys.executable:
        raise OSError(errno.ENOENT, "this Python was not told its own program")
    return sys.executable


def _flags() -> list[str]:
    """Options of this interpreter that say where it looks for modules at all."""
    flags = sys.flags
    options = {
        "-I": flags.isolated,
        "-E": flags.ignore_environment,
        "-s": flags.no_user_site,
        "-S": flags.no_site,
        "-B": flags.dont_write_bytecode,
    }
    return [option for option, wanted in options.items() if wanted]


def _write(stream: IO[bytes] | None, text: bytes) -> None:
    assert stream is not None
    with suppress(OSError, ValueError):  # it has ended: so say its answers
        stream.write(text)
        stream.flush()
