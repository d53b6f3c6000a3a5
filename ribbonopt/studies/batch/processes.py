"""One worker process and what may happen to it: it dies, it hangs, it is no longer wanted."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

from ribbonopt.plain import Row

from .chunks import Chunk
from .study import StudyRibbon

LOST = ("crashed", "timed_out")  # statuses of ribbons that took their worker with them
STARTING = 60.0  # seconds that a new process may take before its first ribbon is counted
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}


class WorkerProcess:
    """Runs chunks in a process of its own, begun again when it is lost."""

    def __init__(self, save: str = "none", folder: str = "", time_limit: float = 300.0) -> None:
        """Begin without a process."""
        self.save, self.folder, self.time_limit = save, folder, time_limit
        self._process: subprocess.Popen[str] | None = None
        self._lock, self._ended, self._code = threading.Lock(), False, 0
        self._answers: queue.Queue[str] = queue.Queue()

    def rows(self, chunk: Chunk, known: Mapping[int, str]) -> Iterator[Row]:
        """Yield the rows of a chunk; lost ribbons get a row that says so.

        Ribbons whose status is known are solved for their neighbours only, lost ones not again.
        """
        skip = [r.number for r in chunk.ribbons if known.get(r.number) in LOST]
        done = set(known)
        while True:
            fresh = self._process is None
            self._send(chunk, skip, done)
            lost, at = "", chunk.ribbons[0].number
            while True:
                answer = self._answer(STARTING * fresh + self.time_limit)
                fresh = False
                if isinstance(answer, str):
                    lost = answer
                    break
                if "at" in answer:
                    at = answer["at"]
                    continue
                if "row" not in answer:
                    return
                done.add(answer["row"]["number"])
                yield answer["row"]
            if self._ended:
                return
            culprit = next(ribbon for ribbon in chunk.ribbons if ribbon.number == at)
            skip.append(at)
            if at not in done:
                yield lost_row(culprit, lost, self._reason(lost))
            if all(r.number in done or r.number in skip for r in chunk.ribbons):
                return

    def close(self) -> None:
        """End the process for good, whoever waits for its answers."""
        with self._lock:
            self._ended = True
        self._lose()

    def _lose(self) -> None:
        """End the process; the next chunk begins another."""
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            self._code = process.wait()
            for stream in (process.stdin, process.stdout):
                if stream is not None:
                    with suppress(OSError):  # what it was told and never read
                        stream.close()

    def _reason(self, lost: str) -> str:
        if lost == "timed_out":
            limit = f"{self.time_limit:g} s"
            return f"took more than {limit}: raise time_limit, or start from an easier ribbon"
        how = f"signal {-self._code}" if self._code < 0 else f"exit status {self._code}"
        return f"its process died ({how}): run it alone by ribbonopt solve to see why"

    def _send(self, chunk: Chunk, skip: list[int], known: set[int]) -> None:
        text = json.dumps(message(chunk, skip, sorted(known), self.save, self.folder))
        for _ in range(2):
            process = self._process or self._begin()
            if process is None or process.stdin is None:
                return
            try:
                process.stdin.write(text + "\n")
                process.stdin.flush()
                return
            except (OSError, ValueError):  # it died while it had nothing to do, or was ended
                self._lose()

    def _begin(self) -> subprocess.Popen[str] | None:
        """Begin a process; None once the worker has ended."""
        command = [sys.executable, "-m", "ribbonopt.studies.batch.worker"]
        with self._lock:
            if self._ended:
                return None
            process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                env=os.environ | ONE_THREAD,
                start_new_session=True,  # what interrupts the batch is told to it alone
            )
            self._process, self._answers = process, queue.Queue()
        threading.Thread(target=_read, args=(process, self._answers), daemon=True).start()
        return process

    def _answer(self, seconds: float) -> dict[str, Any] | str:
        """Return the next answer, or how the process was lost."""
        if self._process is None:  # ended, or it could not be told anything twice
            return "crashed"
        try:
            line = self._answers.get(timeout=seconds)
        except queue.Empty:
            self._lose()
            return "timed_out"
        if not line:
            self._lose()
            return "crashed"
        answer: dict[str, Any] = json.loads(line)
        return answer


def message(
    chunk: Chunk, skip: list[int], known: Sequence[int], save: str, folder: str
) -> dict[str, Any]:
    """Return what a worker is told of a chunk, as plain data."""
    ribbons = [
        {
            "number": ribbon.number,
            "source": ribbon.source.name,
            "text": ribbon.source.text,
            "set": ribbon.overrides,
            "inputs": ribbon.inputs,
        }
        for ribbon in chunk.ribbons
    ]
    return {"ribbons": ribbons, "skip": skip, "known": known, "save": save, "folder": folder}


def lost_row(ribbon: StudyRibbon, status: str, message: str) -> Row:
    """Return the row of a ribbon that no worker could finish."""
    row = {"number": ribbon.number, "scene": ribbon.source.name, **ribbon.inputs}
    return row | {"status": status, "verified": False, "message": message}


def _read(process: subprocess.Popen[str], answers: queue.Queue[str]) -> None:
    assert process.stdout is not None
    with suppress(OSError, ValueError):  # closed meanwhile
        for line in process.stdout:
            answers.put(line)
    answers.put("")
