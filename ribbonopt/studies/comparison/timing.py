"""CPU time of many contenders: one clock, and rounds that go through all of them in turn.

What else a machine does stretches CPU time less than the clock on the wall, and all contenders
alike if they take turns. What it still does shows in the spread of the rounds.
"""

from __future__ import annotations

import gc
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, field
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.studies.machine import cores

LEAST = 1e-3  # seconds of one sample: what is quicker is done again and again, most MOST times
MOST = 300
ENOUGH = 0.25  # seconds in all from which a contender is not timed again
FEW = 4  # samples from which quartiles are told
UNSURE = 1.5  # factor either way within which fewer samples are trusted

Span = tuple[float, float]


def cpu() -> float:
    """CPU seconds of this process, all its threads, and of its children that have ended."""
    used = time.process_time()
    try:
        import resource
    except ImportError:  # Windows does not tell of children
        return used
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used + children.ru_utime + children.ru_stime


@dataclass(frozen=True)
class Contender:
    """What is timed: a call, the CPU seconds its result tells itself, and when that is enough."""

    call: Callable[[], Any]
    own: Callable[[Any], float | None] = lambda _: None
    enough: float = ENOUGH


@dataclass(frozen=True)
class Times:
    """CPU seconds (rounds,) of one solve and what it returned in each round; why it failed."""

    seconds: tuple[float, ...] = ()
    answers: tuple[Any, ...] = ()
    failure: str = ""

    @property
    def numbers(self) -> dict[str, Any]:
        """Median, quartiles and number of rounds, by the names of rows; empty if it failed."""
        if self.failure or not self.seconds:
            return {}
        low, middle, high = np.quantile(self.seconds, (0.25, 0.5, 0.75)).tolist()
        known = len(self.seconds) >= FEW
        return {
            "solve": middle,
            "low": low if known else None,
            "high": high if known else None,
            "rounds": len(self.seconds),
        }


@dataclass(frozen=True)
class Conditions:
    """How often was timed, on how many processors, and the load of the machine about it."""

    rounds: int = 0
    load_before: float | None = None
    load_after: float | None = None
    cpus: int = field(default_factory=cores)

    @property
    def words(self) -> str:
        """How times are to be read."""
        cores = f"{self.cpus} core{'s' if self.cpus > 1 else ''}"
        return f"CPU ms, median of {self.rounds}, {self._load}{cores}"

    def plain(self) -> dict[str, Any]:
        """Everything as plain data for JSON."""
        return {"clock": "CPU"} | asdict(self)

    @property
    def columns(self) -> dict[str, Any]:
        """What every row of a table says of its times."""
        return {name: value for name, value in asdict(self).items() if name != "rounds"}

    @property
    def _load(self) -> str:
        loads = [f"{load:.1f}" for load in (self.load_before, self.load_after) if load is not None]
        return f"load {' to '.join(dict.fromkeys(loads))}, " if loads else ""


def interleaved(
    contenders: Sequence[Contender], rounds: int
) -> tuple[tuple[Times, ...], Conditions]:
    """Time all contenders, every round through all of them.

    A contender that raises is not timed again: its times say why. The collector of garbage runs
    between rounds only.
    """
    runs = [_Run(contender) for contender in contenders]
    before, collected = load(), gc.isenabled()
    for _ in range(rounds):
        gc.collect()
        gc.disable()
        try:
            for run in runs:
                run.sample()
        finally:
            if collected:
                gc.enable()
    times = tuple(Times(tuple(run.seconds), tuple(run.answers), run.failure) for run in runs)
    return times, Conditions(rounds, before, load())


def load() -> float | None:
    """Return how many processes ran or waited in the last minute; None where nobody tells."""
    try:
        return os.getloadavg()[0]
    except (AttributeError, OSError):
        return None


class _Run:
    """The samples of one contender so far."""

    def __init__(self, contender: Contender) -> None:
        self.contender = contender
        self.seconds: list[float] = []
        self.answers: list[Any] = []
        self.spent, self.failure = 0.0, ""

    def sample(self) -> None:
        """Take a sample, unless there are enough or it has failed."""
        if self.failure or self.spent >= self.contender.enough:
            return
        try:
            self._sample()
        except Exception as error:  # another program's: whatever it is, the others are timed
            self.failure = " ".join(f"{type(error).__name__}: {error}".split())

    def _sample(self) -> None:
        count, start = 0, cpu()
        while True:
            answer = self.contender.call()
            count, used = count + 1, cpu() - start
            told = self.contender.own(answer)
            if told is not None or used >= LEAST or count == MOST:
                break
        # A clock that ticks slowly may not have moved.
        self.seconds.append(told if told is not None else max(used, 1e-9) / count)
        self.answers.append(answer)
        self.spent += used


def span_of(solve: float, low: float | None, high: float | None) -> Span:
    """Return the range in which a time is believed: its quartiles, or wide where it has none."""
    if low is None or high is None:
        return solve / UNSURE, solve * UNSURE
    return low, high
