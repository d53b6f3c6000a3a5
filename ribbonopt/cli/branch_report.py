"""What `continue` says of a branch: stages, special points with bars, stability, notes, files.

What it took is told apart (`took`), for `--verbose`.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING, Any

from ribbonopt.checks.stability import stability_in_words
from ribbonopt.output.digits import SMALL, digits, upwards
from ribbonopt.studies.continuation.locus.surface import Surface
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.text import one_line

from .common import listing

if TYPE_CHECKING:
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.curve import Curve
    from ribbonopt.studies.continuation.files import BranchFolder

Row = dict[str, Any]


def report(folder: BranchFolder, continuation: Continuation) -> str:
    """Return what is said of a branch in its folder."""
    count = len(folder.rows)
    lines = [f"{folder.scene.name}: {count} points, all verified"]
    if not count:
        lines = [f"{folder.scene.name}: no points"]
    for (stage, branch), ending in continuation.endings.items():
        rows = [r for r in folder.rows if (r["stage"], r["branch"]) == (stage, branch)]
        curve = continuation.curve(stage, continuation.scene)
        which = _which(stage, branch) + _followed(curve)
        lines.append(f"  {which}: {_extent(rows)}: {ending.reason}")
        lines += _notes(rows)
        for before, row in zip([None, *rows], rows, strict=False):
            if row["kind"] != "point":
                more = _more(row, before, continuation.stages[stage].switch)
                lines.append(f"    {row['kind']} at {_place(row, curve)}{more}")
        told = list(_stability(rows))
        beside = (
            "on the side with fewer negative directions: " if isinstance(curve, Surface) else ""
        )
        lines += [f"    {beside}{each}" for each in told]
        if told and continuation.prepared.scene.boundary.repeats:
            lines.append("    (among disturbances with the symmetry of which a piece is solved)")
    return "\n".join([*lines, f"  written: {one_line(listing(folder.folder))}"])


def took(folder: BranchFolder, continuation: Continuation, seconds: float) -> str:
    """Return what a branch took, stage by stage, what was skipped, and the seconds of this run."""
    lines = ["  what it took:"]
    for stage, branch in continuation.endings:
        rows = [r for r in folder.rows if (r["stage"], r["branch"]) == (stage, branch)]
        if rows:
            iterations = sum(row["iterations"] for row in rows)
            meshes = [row["intervals"] for row in rows]
            lines.append(
                f"    {_which(stage, branch)}: {iterations} iterations of the solves that stayed, "
                f"on {min(meshes)} to {max(meshes)} intervals"
            )
    prepared = continuation.prepared
    lines.append(f"    equations and functions, built before the first: {prepared.seconds:.2f} s")
    lines.append(f"    this run in all: {seconds:.1f} s")
    lines.append("  skipped, and why:")
    return "\n".join(lines + [f"    {reason}" for reason in continuation.skipped])


def _which(stage: int, branch: int) -> str:
    return f"stage {stage + 1}" + (f", branch {branch}" if branch else "")


def _followed(curve: Curve) -> str:
    """Say what a stage follows where it is a locus."""
    if not isinstance(curve, Surface):
        return ""
    return f", locus of {curve.stage.of}s in {curve.other} and {curve.name}"


def _place(row: Row, curve: Curve) -> str:
    """Return where a special point is, with the bar of that where it is known."""
    if isinstance(curve, Surface):
        return _in_plane(row, curve)
    value, relative = value_of(row), row["error"]
    if relative is None:
        return f"{row['parameter']} = {value:.10g} +- not known"
    bar = relative * curve.measure(value)
    number = digits(value, bar, 0 < abs(value) < SMALL)
    return f"{row['parameter']} = {number} +- {upwards(bar)}"


def _in_plane(row: Row, surface: Surface) -> str:
    """Return where a special point of a locus is: l1 with its bar, and l2."""
    value, relative = float(row[surface.other]), row["error"]
    told = f"{value:.10g} +- not known"
    if relative is not None:
        bar = relative * surface.measure(value)
        told = f"{digits(value, bar, 0 < abs(value) < SMALL)} +- {upwards(bar)}"
    return f"{surface.other} = {told}, {surface.name} = {value_of(row):.10g}"


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
    # Of a locus its special points are less exact, and say so in lines of their own.
    told = [row for row in rows if row["kind"] == "point" or not row.get("of")]
    errors = [row["error"] for row in told if row["error"] is not None]
    where = f"{rows[0]['parameter']} = {value_of(rows[0]):.6g} to {value_of(rows[-1]):.6g}"
    return f"{len(rows)} points, {where}, " + (
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


def _stability(rows: list[Row]) -> Iterator[str]:
    """Say where a branch is stable and where not, of the points where that is known."""
    known = [row for row in rows if row["negative"] is not None]
    runs = [list(run) for _, run in groupby(known, key=lambda row: row["negative"])]
    for run in runs:
        words = stability_in_words(run[0]["negative"])
        if len(runs) > 1:
            places = dict.fromkeys(f"{value_of(row):.6g}" for row in (run[0], run[-1]))
            comma = "," if run[0]["negative"] else ""
            words += f"{comma} at {run[0]['parameter']} = {' to '.join(places)}"
        yield words
