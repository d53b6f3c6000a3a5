"""One trial: solved within its time, judged, and what it cost."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import RibbonoptError, no_memory
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.plain import Row, finite
from ribbonopt.solution.solution import Solution

from .answer import Answer, gap_between
from .condition import condition_of
from .limit import OutOfTimeError, limited
from .trial import Trial
from .verdict import Judged, Verdict, judge
from .witness import witnesses

COLUMNS: tuple[str, ...] = (
    "kind",
    "value",
    "label",
    "verdict",
    "digits_lost",
    "error",
    "over_bars",
    "condition",
)
COLUMNS += ("cpu", "intervals", "status", "message")
EPSILON = float(np.finfo(float).eps)

#: says why a verified solution is no equilibrium; "" if it is one, None if it does not know
Examine = Callable[[Solution], str | None]


@dataclass(frozen=True)
class Outcome:
    """What a trial came to.

    Attributes
    ----------
    kind, value, label : str
        The trial.
    verdict : Verdict
        What it came to.
    message : str
        Why, in one line; of a failure what the user is told.
    error : float or None
        Relative error of n(0), m(0), against the truth or a witness.
    over_bars : float or None
        The largest error over its bar.
    condition : float or None
        Condition of the linearised equations.
    cpu : float
        Seconds of the processor, of the solve alone.
    intervals : int or None
        Elements of the answer.
    status : str
        How the solve ended, by the words of a summary.
    """

    kind: str
    value: str
    label: str
    verdict: Verdict
    message: str = ""
    error: float | None = None
    over_bars: float | None = None
    condition: float | None = None
    cpu: float = 0.0
    intervals: int | None = None
    status: str = ""

    @property
    def digits_lost(self) -> float | None:
        """Of the sixteen digits of a number how many are not right; None if that is not known."""
        if self.error is None or not math.isfinite(self.error):
            return None
        return max(0.0, math.log10(max(self.error, EPSILON) / EPSILON))

    def plain(self) -> Row:
        """Columns by name, for files and figures."""
        own: dict[str, Any] = {name: getattr(self, name) for name in COLUMNS}
        found: Row = finite(own | {"verdict": self.verdict.value})
        return found


def run(
    kind: str, trial: Trial, truth: Answer | None, seconds: float, examine: Examine | None = None
) -> Outcome:
    """Solve and judge a trial; `truth` is the answer of the scene as it was, if it is known.

    The solve may take so many seconds of the processor, and so may those that judge it.
    """
    named, started = (kind, trial.value, trial.label), time.process_time()
    late = f"took longer than {seconds:g} s"
    try:
        with limited(seconds):
            found = _solved(trial)
    except OutOfTimeError:
        cpu = time.process_time() - started
        return Outcome(*named, Verdict.FAILED, late, cpu=cpu, status="timeout")
    except Exception as error:
        cpu = time.process_time() - started
        verdict = Verdict.FAILED if _told(error) else Verdict.CRASHED
        status = getattr(error, "status", "refused" if _told(error) else "error")
        told = str(error) if verdict is Verdict.FAILED else f"{type(error).__name__}: {error}"
        return Outcome(*named, verdict, _line(told), cpu=cpu, status=status)
    cpu, count = time.process_time() - started, len(found.nodes) - 1
    status = found.status.name.lower()
    if not found.verified:
        message = _line(found.message)
        return Outcome(*named, Verdict.FAILED, message, None, None, None, cpu, count, status)
    try:
        with limited(seconds):
            condition = condition_of(found)
            judged = _judged(trial, found, truth, examine)
    except OutOfTimeError:
        judged, condition = Judged(Verdict.UNCONFIRMED, f"judging it {late}"), None
    return Outcome(
        *named,
        judged.verdict,
        judged.reason,
        judged.error,
        judged.over_bars,
        condition,
        cpu,
        count,
        status,
    )


def _solved(trial: Trial) -> Solution:
    if trial.start is None:
        return solve(trial.scene)
    prepared = prepare(trial.scene)
    return prepared.solve(guess=trial.start(prepared))


def _judged(trial: Trial, found: Solution, truth: Answer | None, examine: Examine | None) -> Judged:
    # Witnesses are asked in units of the trial.
    answer = Answer.of(found, trial.units)
    others = (Answer.of(witness, trial.units) for witness in witnesses(found))
    known = truth if trial.same else None
    if known is not None and gap_between(answer, known).agree:
        return judge(answer, known, ())  # the truth was examined itself
    judged = judge(answer, known, others)
    fault = None if examine is None or judged.verdict.bad else examine(found)
    if fault:
        return Judged(Verdict.WRONG, fault, judged.error, judged.over_bars)
    if fault == "" and judged.verdict is Verdict.UNCONFIRMED:
        return Judged(Verdict.SOLVED if known is None else Verdict.OTHER)
    return judged


def _told(error: Exception) -> bool:
    """Whether it is an error that a user is told of on purpose."""
    return isinstance(error, RibbonoptError) or no_memory(error)


def _line(text: str) -> str:
    return " ".join(text.split())
