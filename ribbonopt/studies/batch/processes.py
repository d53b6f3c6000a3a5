"""One worker process and what may happen to it: it dies, it hangs, it is no longer wanted.

Each ribbon that is asked for gets one row, whatever the process does. One that is lost before it
can solve anything is an error: the next would be lost too.
"""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Collection, Generator, Iterator, Mapping, Sequence
from typing import Any

from ribbonopt.errors import WorkerError
from ribbonopt.plain import Row

from .child import Answer, Child, search_path
from .chunks import Chunk
from .kept import LOST, SOLUTIONS
from .study import StudyRibbon

STARTING = 120.0  # seconds that a new process may take until it can solve
TRIES = 3  # to begin another one, after one that could
FEWER = "free processes and memory for it, or use fewer by --jobs"


class WorkerProcess:
    """Runs chunks in a process of its own, begun again when it is lost."""

    def __init__(self, save: str = "none", folder: str = "", time_limit: float = 300.0) -> None:
        """Begin without a process."""
        self.save, self.folder, self.time_limit = save, folder, time_limit
        self._path = search_path()
        self._child: Child | None = None
        self._lock, self._ended, self._could = threading.Lock(), False, False

    def begin(self) -> None:
        """Begin a process, if there is none, and wait until it can solve.

        Raises
        ------
        WorkerError
            If it cannot be begun, is lost before that or takes too long; after processes that
            could solve, if that happens again and again.
        """
        for left in range(TRIES if self._could else 1, 0, -1):
            try:
                self._begin()
                return
            except WorkerError:
                if left == 1:
                    raise

    def _begin(self) -> None:
        if self._child is not None or self._ended:
            return
        child = self._begun()
        if child is None:
            return
        try:
            answer = child.answer(STARTING)
        except TimeoutError:
            self._lose()
            said = _quoted(child.said)
            raise WorkerError(
                f"a worker process did not start within {STARTING:g} s{said}; {FEWER}"
            ) from None
        if self._ended or answer == {"ready": True}:
            self._could = True
            return
        how = _how(self._lose())
        raise WorkerError(
            f"a worker process ended before it could solve anything ({how}){_quoted(child.said)}; "
            f"see whether {sys.executable} can import ribbonopt, and has the memory that it needs"
        )

    def rows(self, chunk: Chunk, known: Mapping[int, str]) -> Iterator[Row]:
        """Yield the rows of a chunk; lost ribbons get a row that says so.

        Ribbons whose status is known are solved for their neighbours only, lost ones not again.

        Raises
        ------
        WorkerError
            If no process can be begun.
        """
        wanted = {r.number: r for r in chunk.ribbons if r.number not in known}
        skip = [r.number for r in chunk.ribbons if known.get(r.number) in LOST]
        spared = False
        while wanted:
            count = len(wanted)
            self.begin()
            at, status, why = yield from self._asked(_needed(chunk, wanted), skip, wanted)
            if self._ended or not wanted:
                return
            if at is None:
                # Lost between two ribbons, perhaps by no fault of the next one: once more.
                spared = not spared or len(wanted) < count
                if spared:
                    continue
                at = next(iter(wanted))
            skip.append(at)
            spared = False
            if at in wanted:
                yield lost_row(wanted.pop(at), status, why)

    def close(self) -> None:
        """End the process for good, whoever waits for its answers."""
        with self._lock:
            self._ended = True
        self._lose()

    def _asked(
        self, ribbons: Sequence[StudyRibbon], skip: Collection[int], wanted: dict[int, StudyRibbon]
    ) -> Generator[Row, None, tuple[int | None, str, str]]:
        """Yield the rows of ribbons, taken from those wanted, until all are there or it is lost.

        Return the number of the ribbon that it was at when it was lost, status and reason.
        """
        child, at = self._child, None
        if child is None:
            return None, "", ""
        known = [ribbon.number for ribbon in ribbons if ribbon.number not in wanted]
        child.tell(message(ribbons, skip, known, self.save, self.folder))
        asked = {ribbon.number for ribbon in ribbons}.difference(skip)
        while wanted:
            try:
                answer = child.answer(self.time_limit)
            except TimeoutError:
                self._lose()
                limit = f"{self.time_limit:g} s"
                why = f"took more than {limit}: raise time_limit, or start from an easier ribbon"
                return at, "timed_out", why
            match answer:
                case {"at": int(number)} if number in asked and at not in wanted:
                    at = number
                    asked.discard(at)
                case {"row": {"number": number, "status": str(), "verified": bool()} as row} if (
                    number == at and at in wanted
                ):
                    del wanted[at]
                    at = None
                    yield row
                case None:
                    why = f"its process died ({_how(self._lose())}){_quoted(child.said)}"
                    return at, "crashed", f"{why}: run it alone by ribbonopt solve to see why"
                case _:
                    self._lose()
                    return at, "crashed", f"its process answered what was not asked{_shown(answer)}"
        return None, "", ""

    def _begun(self) -> Child | None:
        """Begin a process; None once the worker has ended."""
        with self._lock:
            if self._ended:
                return None
            try:
                self._child = Child(self._path)
            except (OSError, RuntimeError) as error:
                reason = getattr(error, "strerror", None) or error
                raise WorkerError(
                    f"a worker process could not be started ({sys.executable}: {reason}); {FEWER}"
                ) from None
            return self._child

    def _lose(self) -> int:
        """End the process and return its exit status; the next chunk begins another."""
        with self._lock:
            child, self._child = self._child, None
        return child.end() if child is not None else 0


def message(
    ribbons: Sequence[StudyRibbon],
    skip: Collection[int],
    known: Collection[int],
    save: str,
    folder: str,
) -> Answer:
    """Return what a worker is told of ribbons that follow one another, as plain data."""
    told = [
        {
            "number": ribbon.number,
            "source": ribbon.source.name,
            "text": ribbon.source.text,
            "set": ribbon.overrides,
            "inputs": ribbon.inputs,
            "followed": ribbon.followed,
            "place": ribbon.place or f"{SOLUTIONS}/{ribbon.number}",
            "task": ribbon.task,
        }
        for ribbon in ribbons
    ]
    return {
        "ribbons": told,
        "skip": list(skip),
        "known": list(known),
        "save": save,
        "folder": folder,
    }


def lost_row(ribbon: StudyRibbon, status: str, message: str) -> Row:
    """Return the row of a ribbon that no worker could finish."""
    row = {"number": ribbon.number, "scene": ribbon.source.name, **ribbon.inputs}
    return row | {"status": status, "verified": False, "message": message}


def _needed(chunk: Chunk, wanted: Collection[int]) -> list[StudyRibbon]:
    """Return the ribbons up to the last one wanted: what follows leads nowhere."""
    last = max(i for i, ribbon in enumerate(chunk.ribbons) if ribbon.number in wanted)
    return list(chunk.ribbons[: last + 1])


def _how(code: int) -> str:
    if code == -getattr(signal, "SIGKILL", 9):
        return f"signal {-code}, as systems kill where memory is short"
    return f"signal {-code}" if code < 0 else f"exit status {code}"


def _quoted(said: str) -> str:
    return f"; it said: {said}" if said else ""


def _shown(answer: Any) -> str:
    text = repr(answer)
    return f" ({text[:80]}{'...' if len(text) > 80 else ''})"
