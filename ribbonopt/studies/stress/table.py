"""A study of stress as aligned plain text; only the command line prints it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ribbonopt.studies.comparison.table import aligned
from ribbonopt.text import shortened

from .run import Outcome
from .stress import Stress
from .verdict import Verdict

HEAD = ("kind", "value", "verdict", "digits lost", "condition", "CPU ms", "message")
LEFT, LONGEST = 3, 100


def table(study: Stress) -> str:
    """Return a line for every trial, what does not apply, and the counts."""
    lines = [f"{study.name} under stress; truth: {study.truth}", ""]
    lines += aligned([HEAD, *(_cells(row) for row in study.rows)], LEFT)
    if study.not_applicable:
        lines += ["", "not applicable:"]
    lines += [f"  {kind}: {reason}" for kind, reason in study.not_applicable.items()]
    lines += ["", *aligned(counted(study.rows), 1), "", sentence(study.rows)]
    return "\n".join(lines)


def counted(rows: Sequence[Outcome]) -> list[tuple[str, ...]]:
    """Return a row of cells for each kind: how many trials came to each verdict; then for all."""
    found: dict[str, Counter[Verdict]] = {}
    for row in rows:
        for name in (row.kind, "all"):
            found.setdefault(name, Counter())[row.verdict] += 1
    names = [name for name in found if name != "all"]
    cells = [
        (name, *(str(found[name][verdict]) for verdict in Verdict))
        for name in (*names, *(["all"] if rows else []))
    ]
    return [("kind", *(verdict.value for verdict in Verdict)), *cells]


def sentence(rows: Sequence[Outcome]) -> str:
    """Return what came of all in one sentence."""
    found = Counter(row.verdict for row in rows)
    parts = [f"{found[verdict]} {verdict.value}" for verdict in Verdict if found[verdict]]
    wrong = "" if found[Verdict.WRONG] else "; none wrong"
    return f"{len(rows)} trials: {', '.join(parts) or 'nothing'}{wrong}."


def _cells(row: Outcome) -> tuple[str, ...]:
    return (
        row.kind,
        row.value,
        row.verdict.value,
        "-" if row.digits_lost is None else f"{row.digits_lost:.1f}",
        "-" if row.condition is None else f"{row.condition:.0e}",
        f"{1e3 * row.cpu:.0f}",
        shortened(row.message, LONGEST),
    )
