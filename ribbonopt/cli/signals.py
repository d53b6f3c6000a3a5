"""Signals that end a command: all of them as Ctrl-C does, so that nothing is left half-written.

Clusters end their jobs by SIGTERM or SIGXCPU, a terminal that closes by SIGHUP. Only the command
line listens: who imports ribbonopt keeps their own handlers.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterator
from types import FrameType
from typing import TYPE_CHECKING

from ribbonopt.signals import endings

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

AGAIN = 1.0  # seconds from which on another Ctrl-C is meant: many wrappers pass on the same twice
SOON, LATER = 0.01, 0.5  # seconds until it is told once more: at a bad moment, if it was lost
WRITES = "ribbonopt.output"  # the room that is not interrupted: what it does is short
COMMAND = "ribbonopt.cli.command"  # what is interrupted


class Signals:
    """What this process was told by signals.

    Libraries may take an interruption for an error of theirs and go on (`except: pass`), and
    Python drops one in a destructor: it is told again until it is heard.
    """

    def __init__(self) -> None:
        """Listen from now on; what is ignored, as by `nohup`, stays so."""
        self._told, self._at = 0, 0.0
        sys.unraisablehook = self._unraisable
        for number in endings():
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
                signal.signal(number, self._tell)
        if hasattr(signal, "SIGALRM"):
            signal.signal(signal.SIGALRM, self._tell_again)

    def status(self, status: int) -> int:
        """Return the exit status: which signal has ended a command, as shells count them.

        What a library makes of an interruption may be any error of its own.
        """
        return 128 + self._told if status and self._told else status

    def _tell(self, number: int, frame: FrameType | None) -> None:
        if not self._told:
            self._told, self._at = number, time.monotonic()
        elif number == signal.SIGINT and time.monotonic() - self._at > AGAIN:
            # Who cannot wait has it end here and now: the next run puts away what is left.
            os._exit(128 + number)
        self._tell_again(number, frame)

    def _tell_again(self, number: int, frame: FrameType | None) -> None:
        if _is_heard():
            return _later(LATER)  # what was begun is being put away
        rooms = set(_rooms(frame))
        if COMMAND not in rooms:
            os._exit(128 + self._told)  # nothing is begun yet, or all is done
        if any(room.startswith(WRITES) for room in rooms):
            return _later(SOON)
        _later(LATER)
        raise KeyboardInterrupt

    def _unraisable(self, what: UnraisableHookArgs) -> None:
        if what.exc_type is KeyboardInterrupt and self._told:
            _later(SOON)
        else:
            sys.__unraisablehook__(what)


def _later(seconds: float) -> None:
    """Have it told once more; without threads, whose locks may be held at any moment."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, seconds)


def _is_heard() -> bool:
    """Whether an interruption is on its way up: what runs now puts things away."""
    error = sys.exc_info()[1]
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__context__
    return error is not None


def _rooms(frame: FrameType | None) -> Iterator[str]:
    """Yield the names of the modules that are at work."""
    while frame is not None:
        yield str(frame.f_globals.get("__name__", ""))
        frame = frame.f_back
