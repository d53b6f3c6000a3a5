"""Signals that end a process: which they are, and how a worker leaves them to who began it."""

from __future__ import annotations

import signal

#: of the keyboard, of clusters, of a terminal that closes, of a limit on time
NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGXCPU")


def endings() -> list[int]:
    """Return the numbers of those that this system has."""
    return [getattr(signal, name) for name in NAMES if hasattr(signal, name)]


def ignore_endings() -> None:
    """Leave them to the process that has begun this one, and ends it.

    A cluster that ends a job tells all its processes: a ribbon in work is not lost by that.
    """
    for number in endings():
        signal.signal(number, signal.SIG_IGN)
