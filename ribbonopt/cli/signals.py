"""Signals that end a command: all of them as Ctrl-C does, so that nothing is left half-written.

Clusters end their jobs by SIGTERM or SIGXCPU, a terminal that closes by SIGHUP. Only the command
line listens: who imports ribbonopt keeps their own handlers.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from types import FrameType
from typing import TYPE_CHECKING

from ribbonopt.signals import endings

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

AGAIN = 1.0  # seconds from which on another Ctrl-C is meant: many wrappers pass on the same twice
SOON = 0.01  # seconds until a signal that came at a bad moment is told once more
WRITES = "ribbonopt.output"  # the room that is not interrupted: what it does is short
COMMAND = "ribbonopt.cli.command"  # what is interrupted


class Signals:
    """What this process was told by signals."""

    def __init__(self) -> None:
        """Listen from now on; what is ignored, as by `nohup`, stays so."""
        self._told, self._at, self._heard = 0, 0.0, False
        sys.unraisablehook = self._unraisable
        for number in endings():
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
                signal.signal(number, self._tell)

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
        if self._heard:
            return  # what was begun is being put away
        at = set(_rooms(frame))
        if COMMAND not in at:
            os._exit(128 + number)  # nothing is begun yet, or all is done
        if any(room.startswith(WRITES) for room in at):
            self._tell_soon()
            return
        self._heard = True
        raise KeyboardInterrupt

    def _tell_soon(self) -> None:
        timer = threading.Timer(SOON, _send, (self._told,))
        timer.daemon = True
        timer.start()

    def _unraisable(self, what: UnraisableHookArgs) -> None:
        """Tell it once more where it came when Python lets nothing pass, as in a destructor."""
        if what.exc_type is KeyboardInterrupt and self._told:
            self._heard = False
            self._tell_soon()
        else:
            sys.__unraisablehook__(what)


def _send(number: int) -> None:
    """Send a signal to the main thread, even where it waits for something."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        signal.raise_signal(number)


def _rooms(frame: FrameType | None) -> Iterator[str]:
    """Yield the names of the modules that are at work."""
    while frame is not None:
        yield str(frame.f_globals.get("__name__", ""))
        frame = frame.f_back
