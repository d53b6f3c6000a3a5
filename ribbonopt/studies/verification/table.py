"""Numbers with sources as aligned plain text; only the command line prints it."""

from __future__ import annotations

import math

from ribbonopt.output.digits import digits, upwards
from ribbonopt.studies.comparison.table import aligned

from .measured import COUNT, TOLERANCE
from .run import Verification
from .verdict import OK, Verdict

HEAD = ("scene", "quantity", "source", "ours", "bar", "digits", "CPU s", "")
MOST = 17  # digits that a double needs
WIDEST = 44  # column of scenes and what is set in them
TOLD = "~"  # before a bar that is the scene's tolerance


def table(study: Verification) -> str:
    """Return a line for each row, then those that are off, and what they come to."""
    lines = aligned([HEAD, *(cells(verdict) for verdict in study.verdicts)])
    wrong = [verdict for verdict in study.verdicts if verdict.status != OK]
    if wrong:
        lines += ["", "not confirmed:", *(f"  {_why(verdict)}" for verdict in wrong)]
    return "\n".join([*lines, "", *sentences(study)])


def sentences(study: Verification) -> list[str]:
    """Return what a verification comes to."""
    count, right = len(study.verdicts), study.counts[OK]
    lines = [f"{right} of {count} rows within their bars, {study.seconds:.1f} s of CPU time"]
    agreed = sorted(v.agreed for v in study.verdicts if v.agreed is not None)
    if agreed:
        middle = agreed[len(agreed) // 2]
        lines += [f"digits agreed with the source: {agreed[0]} at least, {middle} in the middle"]
    if study.tolerated:
        lines += [f"{TOLD} {study.tolerated} without a bar, judged by the scene's tolerance"]
    return lines


def cells(verdict: Verdict) -> tuple[str, ...]:
    """Return the texts of a row: scene, quantity, source, ours, bar, digits, CPU s, status."""
    claim = verdict.claim
    return (
        _cut(" ".join((claim.scene, *claim.given))),
        claim.quantity,
        written(claim.value, claim.digits),
        *_ours(verdict),
        "-" if verdict.agreed is None else str(verdict.agreed),
        f"{verdict.seconds:.2f}",
        verdict.status,
    )


def written(value: float, stand: int | None) -> str:
    """Write a number with the significant digits that stand, as far as a double has them."""
    if stand is None or stand >= MOST:
        text = repr(value)
        return text.removesuffix(".0") if stand is None else text
    if not value:
        return f"{value:.{stand}f}"
    text = f"{value:.{stand - 1}e}"
    exponent = int(text.partition("e")[2])
    if not -4 <= exponent < MOST:
        return text
    return f"{value:.{max(0, stand - 1 - exponent)}f}"


def _cut(text: str) -> str:
    return text if len(text) <= WIDEST else f"{text[: WIDEST - 4]} ..."


def _ours(verdict: Verdict) -> tuple[str, str]:
    found = verdict.found
    if found is None:
        return "-", "-"
    if found.basis == COUNT:
        return f"{found.value:g}", "-"
    small = 0 < abs(found.value) < 1e-3
    mark = TOLD if found.basis == TOLERANCE else ""
    bar = upwards(found.bar) if math.isfinite(found.bar) else "?"
    return digits(found.value, found.bar or None, small), mark + bar


def _why(verdict: Verdict) -> str:
    claim, gap = verdict.claim, verdict.gap
    if gap is None:
        return f"row {claim.number}, {claim.label}: {verdict.message}"
    assert verdict.found is not None
    value = written(claim.value, claim.digits)
    return (
        f"row {claim.number}, {claim.label}: {verdict.found.value!r}, source {value}, "
        f"apart by {gap:.1e}, bar {verdict.found.bar:.1e}"
    )
