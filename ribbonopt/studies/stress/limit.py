"""A limit on the processor time of a piece of work, told where the system has a clock for it."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType

AGAIN = 0.2  # seconds until it is told once more: libraries may take the first for their own


class OutOfTimeError(BaseException):
    """The time is up; no `Exception`, which the code at work might take for one of its own."""


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise OutOfTimeError in what is done within, after so many seconds of the processor.

    What does not return to Python meanwhile is told when it does. Without such a clock (Windows),
    or beside the main thread, it is told in the end.
    """
    started = time.process_time()
    if not hasattr(signal, "setitimer") or current_thread() is not main_thread():
        yield
        if time.process_time() - started > seconds:
            raise OutOfTimeError
        return
    told = False

    def tell(number: int, frame: FrameType | None) -> None:
        nonlocal told
        told = True
        raise OutOfTimeError

    before = signal.signal(signal.SIGPROF, tell)
    signal.setitimer(signal.ITIMER_PROF, seconds, AGAIN)
    try:
        yield
        if told:  # a library has swallowed it
            raise OutOfTimeError
    except KeyboardInterrupt:
        # So CasADi tells of any signal that came while IPOPT was at work.
        if told:
            raise OutOfTimeError from None
        raise
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
