"""Verdicts: what is said of one trial, and by which comparisons."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from ribbonopt.classes import dataclass

from .answer import Answer, Gap, gap_between, image_gap


class Verdict(Enum):
    """What a trial came to; the value is the word for it."""

    SOLVED = "solved"
    OTHER = "another equilibrium"
    FAILED = "honest failure"
    UNCONFIRMED = "unconfirmed"
    CRASHED = "crashed"
    WRONG = "wrong"

    @property
    def bad(self) -> bool:
        """Whether it must not be."""
        return self in (Verdict.WRONG, Verdict.CRASHED)


@dataclass(frozen=True)
class Judged:
    """A verdict with its reason, and the relative error of n(0), m(0) where that is known.

    `over_bars` is by how much the error exceeds the bars; below one it does not.
    """

    verdict: Verdict
    reason: str = ""
    error: float | None = None
    over_bars: float | None = None


def judge(found: Answer, truth: Answer | None, witnesses: Iterable[Answer]) -> Judged:
    """Return the verdict on a verified answer.

    `truth` is what it should be, None where that is not known; `witnesses` are answers near it by
    other schemes, of which none is asked for where the truth is met, and only those tell whose own
    bars are small enough.
    """
    apart = None if truth is None else gap_between(found, truth)
    if apart is not None and apart.agree:
        return Judged(Verdict.SOLVED, _doubt(apart), apart.relative, apart.over_bars)
    telling = (witness for witness in witnesses if witness.tells(found))
    nearest = _nearest(gap_between(found, witness) for witness in telling)
    if nearest is None:
        return Judged(
            Verdict.UNCONFIRMED, "no other scheme solves it from here, exactly enough to tell"
        )
    if not nearest.agree:
        return Judged(Verdict.WRONG, _words(nearest), nearest.relative, nearest.over_bars)
    same = truth is None or image_gap(found, truth).agree
    verdict = Verdict.SOLVED if same else Verdict.OTHER
    return Judged(verdict, _doubt(nearest), nearest.relative, nearest.over_bars)


def _nearest(gaps: Iterable[Gap]) -> Gap | None:
    """Return the gap to the witness that agrees, or else the smallest."""
    best: Gap | None = None
    for gap in gaps:
        if best is None or gap.over_bars < best.over_bars:
            best = gap
        if best.agree:
            break
    return best


def _doubt(gap: Gap) -> str:
    return "" if gap.known else "without bars"


def _words(gap: Gap) -> str:
    if not gap.known:
        return f"no equilibrium near it: {gap.what} is off, loads by {gap.relative:.0e} relative"
    words = f"{gap.what} is off by {gap.over_bars:.2g} times its bar"
    return f"{words} (loads by {gap.relative:.0e} relative)"
