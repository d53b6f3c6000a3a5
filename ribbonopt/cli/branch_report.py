"""What `continue` says of a branch: stages, special points, stability, notes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, Any

from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.text import one_line

from .common import listing

if TYPE_CHECKING:
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.files import BranchFolder

Row = dict[str, Any]


def report(folder: BranchFolder, continuation: Continuation) -> str:
    """Return what is said of a branch in its folder."""
    lines = [f"{folder.scene.name}: {len(folder.rows)} points"]
    for (stage, branch), ending in continuation.endings.items():
        rows = [r for r in folder.rows if (r["stage"], r["branch"]) == (stage, branch)]
        where = f"stage {stage + 1}" + (f", branch {branch}" if branch else "")
        lines.append(f"  {where}: {_extent(rows)}: {ending.reason}")
        lines += _notes(rows)
        for before, row in zip([None, *rows], rows, strict=False):
            if row["kind"] != "point":
                more = _more(row, before, continuation.stages[stage].switch)
                lines.append(f"    {row['kind']} at {_place(row, '.10g')}{more}")
        changes = list(_changes(rows))
        lines += [f"    {change}" for change in changes]
        if changes and continuation.prepared.scene.boundary.repeats:
            lines.append("    (among disturbances with the symmetry of which a piece is solved)")
    return "\n".join([*lines, f"  written: {one_line(listing(folder.folder))}"])


def _place(row: Row, digits: str) -> str:
    return f"{row['parameter']} = {value_of(row):{digits}}"


def _more(row: Row, before: Row | None, switch: bool | int) -> str:
    """Say how to reach the ribbons that leave a special point, and what is noted of it alone."""
    told = _parts(before) if before else []
    note = "; ".join(part for part in _parts(row) if part not in told)
    way = row["kind"] == "buckling point" and not switch
    more = " (`switch: true` follows the buckled ribbon)" if way else ""
    return more + (f": {note}" if note else "")


def _parts(row: Row) -> list[str]:
    return [part for part in row.get("note", "").split("; ") if part]


def _extent(rows: list[Row]) -> str:
    if not rows:
        return "no points"
    errors = [row["error"] for row in rows if row["error"] is not None]
    return f"{len(rows)} points, {_place(rows[0], '.6g')} to {value_of(rows[-1]):.6g}, " + (
        f"relative error at most {max(errors):.0e}" if errors else "errors not known"
    )


def _notes(rows: list[Row]) -> Iterator[str]:
    """Say what is to be told of points; once for those that follow one another."""
    regular = [row for row in rows if row["kind"] == "point"]
    for note, run in groupby(regular, key=lambda row: row.get("note")):
        if note:
            same = list(run)
            values = dict.fromkeys(f"{value_of(row):.6g}" for row in (same[0], same[-1]))
            yield f"    note at {same[0]['parameter']} = {' to '.join(values)}: {note}"


def _changes(rows: list[Row]) -> Iterator[str]:
    """Say where stability changes, and how it is where it is known and does not."""
    known = [row for row in rows if row["negative"] is not None]
    for a, b in pairwise(known):
        if a["negative"] != b["negative"]:
            yield (
                f"{a['negative']} negative directions at {value_of(a):.6g}, {b['negative']} at "
                f"{value_of(b):.6g}"
            )
    if known and len({row["negative"] for row in known}) == 1:
        count = known[0]["negative"]
        yield "stable" if count == 0 else f"unstable: {count} negative directions"
