"""What `batch` says of its rows: how they ended, numbers and bars, notes, files; what they took."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ribbonopt.output.digits import upwards
from ribbonopt.plain import SPECIALS, Row, is_number
from ribbonopt.text import one_line

from .common import listing

if TYPE_CHECKING:
    from ribbonopt.studies.batch.files import BatchFolder


def report(folder: BatchFolder) -> str:
    """Return what is said of a batch in its folder."""
    rows = list(folder.rows)
    counts = Counter(row["status"] for row in rows).most_common()
    statuses = ", ".join(f"{number} {status.replace('_', ' ')}" for status, number in counts)
    verified = sum(row["verified"] for row in rows)
    share = "all verified" if verified == len(rows) else f"{verified} verified"
    lines = [
        f"{folder.study.name}: {len(rows)} ribbons: {statuses}; {share}",
        *_numbers(rows),
        *_special(rows),
        *_noted(rows),
        f"  written: {one_line(listing(folder.folder))}",
    ]
    return "\n".join(lines)


def took(folder: BatchFolder, seconds: float) -> str:
    """Return what the rows took, from where they were begun, and the seconds of this run."""
    rows = list(folder.rows)
    each = sorted(row.get("seconds", 0.0) for row in rows)
    iterations = sorted(n for row in rows if (n := row.get("iterations")) is not None)
    starts = Counter(_start(row["start"]) for row in rows if row.get("start")).most_common()
    median, most = each[len(each) // 2], each[-1]
    lines = [
        "  what it took:",
        f"    {sum(each):.1f} s of solving; a ribbon {median:.3g} s (median), at most {most:.3g} s",
        f"    this run in all: {seconds:.1f} s",
    ]
    if iterations:
        middle = iterations[len(iterations) // 2]
        lines.append(f"    iterations: {middle} a ribbon (median), at most {iterations[-1]}")
    if starts:
        lines.append(f"    begun from: {', '.join(f'{word} ({n})' for word, n in starts)}")
    return "\n".join(lines)


def _start(word: str) -> str:
    """Return from where a ribbon was begun, whichever other ribbon that was."""
    return "another ribbon" if word.startswith("ribbon ") else word


def _numbers(rows: Sequence[Row]) -> list[str]:
    """Return a line on energies and bars of what is verified; none of branches, which have none."""
    good = [row for row in rows if row["verified"]]
    energies = [row["energy"] for row in good if is_number(row.get("energy"))]
    errors = [row["error"] for row in good if row.get("error") is not None]
    parts = [f"energy {min(energies):.6g} to {max(energies):.6g}"] if energies else []
    if errors:
        parts.append(f"relative error at most {upwards(max(errors))}")
    if unknown := len(good) - len(errors):
        parts.append(f"error not known of {unknown}")
    return [f"  {'; '.join(parts)}"] if parts else []


def _special(rows: Sequence[Row]) -> list[str]:
    """Return a line on the special points of branches, where rows are of these."""
    kinds = Counter(point["kind"] for row in rows for point in row.get(SPECIALS, []))
    told = ", ".join(f"{kind} {count}" for kind, count in kinds.most_common())
    return [f"  special points: {told}"] if told else []


def _noted(rows: Sequence[Row]) -> list[str]:
    """Return a line on the ribbons that were not solved from where they were begun, if any."""
    noted = [row for row in rows if row.get("note")]
    if not noted:
        return []
    first = min(noted, key=lambda row: int(row["number"]))
    count = f"{len(noted)} ribbon{'s' * (len(noted) > 1)}"
    return [f"  note: {count} fell back (column note); number {first['number']}: {first['note']}"]
