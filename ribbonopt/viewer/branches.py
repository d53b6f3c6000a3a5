"""The view of a branch: the shapes of its points, in one lab frame, to one width and one scale."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ribbonopt.errors import ViewError
from ribbonopt.output.summary import settings_of
from ribbonopt.plain import Row, is_number
from ribbonopt.scene.stages import stages_of
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.studies.continuation.walk.points import POINT
from ribbonopt.studies.continuation.walk.steps import JUMPED
from ribbonopt.views.branch_rows import VALUE, BranchFigure
from ribbonopt.views.pieces import ROWS
from ribbonopt.views.subject import subject_of

from .diagram import diagram_of
from .facts import about_of, number_of, vector_of
from .view import Ribbon, View
from .width import width_of

MOST = 400  # shapes of a page
MANY, FEW_ROWS = 40, 121  # shapes, of more of which each has fewer rows
LAST = "error"  # column after those of the answer


def view_of_branch(branch: Branch, half_width: float | None = None) -> View:
    """Return the view of a branch, as `view_of`: of all points, or evenly of 400.

    Raises
    ------
    ViewError
        If it has no points.
    """
    if not branch.rows:
        raise ViewError(
            f"{branch.scene.name}: the branch has no points, so there is nothing to see"
        )
    chosen = chosen_of(branch.rows)
    rows = ROWS if len(chosen) <= MANY else FEW_ROWS
    subjects = [subject_of(branch[i], complete=True, rows=rows) for i in chosen]
    ribbons = tuple(
        Ribbon(
            subject,
            caption=caption_of(branch.rows[i]),
            note=branch.rows[i].get("note") or "",
            numbers=numbers_of_row(branch.rows[i]),
            row=i,
        )
        for i, subject in zip(chosen, subjects, strict=True)
    )
    first = subjects[0]
    width, words = width_of(subjects, half_width)
    law = about_of({"law": settings_of(branch.scene)["law"], "units": first.units.name})
    count = f"{len(branch)} points"
    if len(chosen) < len(branch):
        count += f", {len(chosen)} of them with their shapes"
    about = ", ".join(filter(None, [count, law, words]))
    diagram = diagram_of(figure_of(branch))
    name = branch.scene.name
    few = left_out(len(branch), len(chosen), "points")
    return View(
        "branch",
        *(name, about, ribbons, width),
        diagram=diagram,
        units=first.units,
        left_out=few,
    )


def left_out(count: int, shown: int, what: str) -> tuple[str, ...]:
    """Return what is to be said where a page has not the shapes of all points or ribbons."""
    if shown == count:
        return ()
    return (f"the shapes of {count - shown} of {count} {what}: a page holds {MOST} at most",)


def figure_of(branch: Branch) -> BranchFigure:
    """Return what a diagram of a branch is made of; what the scene records is shown first."""
    stages, formulas = stages_of(branch.scene), branch.continuation.recorder.formulas
    planes = tuple((stage.paths[0], stage.paths[1]) for stage in stages if stage.is_locus)
    return BranchFigure(
        branch.rows,
        planes[:1] or tuple((VALUE, name) for name in list(formulas)[:1]),
        title=branch.scene.name,
        log=[stage.moved for stage in stages if stage.scale == "log"],
        jumps=[row["number"] for row in branch.rows if JUMPED in (row.get("note") or "")],
        si=branch.scene.ribbon is not None,
    )


def chosen_of(rows: Sequence[Row], most: int = MOST) -> list[int]:
    """Return which points are shown, `most` at most: all, or special ones and some evenly between.

    First and last are among them.
    """
    if len(rows) <= most:
        return list(range(len(rows)))
    special = [i for i, row in enumerate(rows) if row["kind"] != POINT]
    kept = {0, len(rows) - 1, *evenly(special, most // 2)}
    others = [i for i in range(len(rows)) if i not in kept]
    return sorted({*kept, *evenly(others, most - len(kept))})


def evenly(places: Sequence[int], most: int) -> list[int]:
    """Return at most so many of some places, evenly among them, the first and the last too."""
    if len(places) <= most:
        return list(places)
    return [places[int(k)] for k in np.linspace(0, len(places) - 1, most).round()]


def caption_of(row: Row) -> str:
    """Return what a point is: its number, where it is, whether it is stable."""
    kind = "" if row["kind"] == POINT else f"{row['kind']}, "
    where = f"{row['parameter'].rpartition('.')[2]} = {number_of(row[row['parameter']])}"
    known = row["kind"] == POINT or row.get("negative") is not None
    stability = f", {stability_of(row)}" if known else ""  # which changes at special points
    return f"point {row['number']}: {kind}{where}{stability}"


def stability_of(row: Row) -> str:
    """Return in words whether a point is stable."""
    count = row.get("negative")
    if count is None:
        return "stability not known"
    if not count:
        return "stable"
    return f"unstable, {count} direction{'s' * (count > 1)}"


def numbers_of_row(row: Row) -> list[tuple[str, str]]:
    """Return names and values of what a point records: parameters, formulas, the answer, error."""
    names = [name for name in row if "." in name and is_number(row[name])]
    after = list(row)[list(row).index("u3") + 1 :] if "u3" in row else []
    own = [name for name in after if name not in names and is_number(row[name])]
    recorded = [name for name in own if name not in ("intervals", "iterations")]
    found = [(name, number_of(row.get(name))) for name in (*names, *recorded, "energy")]
    for name, label in (("n0", "force n(0), lab frame"), ("m0", "moment m(0), lab frame")):
        parts = [row[key] for axis in "xyz" if is_number(row.get(key := f"{name}{axis}"))]
        if len(parts) == 3:
            found.append((label, vector_of(parts)))
    bar = row.get(LAST)
    return [*found, *([("relative error", f"{bar:.0e}")] if is_number(bar) else [])]
