"""Signals that end a command: all of them as Ctrl-C does, so that nothing is left half-written.

Clusters end their jobs by SIGTERM or SIGXCPU, a terminal that closes by SIGHUP. Only the command
line listens: who imports ribbonopt keeps their own handlers.
"""

from __future__ import annotations

import os
import signal
import time
from types import FrameType

from ribbonopt.signals import endings

from .common import INTERRUPTED

AGAIN = 1.0  # seconds from which on another Ctrl-C is meant: many wrappers pass on the same twice


class Signals:
    """What this process was told by signals."""

    def __init__(self) -> None:
        """Listen from now on; what is ignored, as by `nohup`, stays so."""
        self._told, self._at = 0, 0.0
        for number in endings():
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
                signal.signal(number, self._tell)

    def status(self, status: int) -> int:
        """Return the exit status: which signal has interrupted a command, as shells count them."""
        return 128 + self._told if status == INTERRUPTED and self._told else status

    def _tell(self, number: int, frame: FrameType | None) -> None:
        if not self._told:
            self._told, self._at = number, time.monotonic()
            raise KeyboardInterrupt
        # What was begun is being put away. Who cannot wait may have it end here and now: the next
        # run puts away what is left.
        if number == signal.SIGINT and time.monotonic() - self._at > AGAIN:
            os._exit(128 + number)
