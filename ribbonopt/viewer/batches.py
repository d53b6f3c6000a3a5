"""The view of a batch: scatter and table of its rows, and the shapes of those that were saved."""

from __future__ import annotations

from ribbonopt.errors import ViewError
from ribbonopt.plain import Row
from ribbonopt.scene.units import Units
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.batch.results import Batch
from ribbonopt.studies.batch.special import with_columns
from ribbonopt.views.pieces import ROWS
from ribbonopt.views.subject import subject_of

from .branches import FEW_ROWS, MANY, MOST, evenly, left_out
from .facts import number_of
from .rows import table_of
from .view import Ribbon, View
from .width import width_of

ANSWERS = ("energy", "error", "seconds")


def view_of_batch(batch: Batch, half_width: float | None = None) -> View:
    """Return the view of a batch, as `view_of`: with the shapes that were saved, evenly of 400.

    Of a ribbon that was continued the last point is shown.

    Raises
    ------
    ViewError
        If it has no rows.
    """
    if not batch.rows:
        raise ViewError(f"{batch.name}: the batch has no rows, so there is nothing to see")
    saved = batch.saved
    chosen = set(evenly(saved, MOST))
    rows = ROWS if len(chosen) <= MANY else FEW_ROWS
    places = {row["number"]: i for i, row in enumerate(batch.rows)}
    solutions = {number: _solution(batch, number) for number in saved if number in chosen}
    subjects = {
        number: subject_of(solution, complete=True, rows=rows)
        for number, solution in solutions.items()
    }
    ribbons = tuple(
        Ribbon(
            subject,
            caption=_caption(batch.rows[places[number]]),
            note=str(batch.rows[places[number]].get("note") or ""),
            verified=bool(batch.rows[places[number]]["verified"]),
            numbers=_numbers(batch.rows[places[number]], batch.inputs),
            row=places[number],
        )
        for number, subject in subjects.items()
    )
    width, words = width_of(list(subjects.values()), half_width)
    units = ribbons[0].subject.units if ribbons else Units()
    table = table_of([with_columns(row) for row in batch.rows], batch.inputs)
    about = ", ".join(filter(None, [_count(batch, len(saved), len(ribbons)), words]))
    few = left_out(len(saved), len(ribbons), "ribbons")
    return View(
        "batch", *(batch.name, about, ribbons, width), table=table, units=units, left_out=few
    )


def _solution(batch: Batch, number: int) -> Solution:
    found = batch[number]
    return found if isinstance(found, Solution) else found[len(found) - 1]


def _count(batch: Batch, saved: int, shown: int) -> str:
    """Return how many ribbons there are, and of how many the shapes."""
    of = f" of {batch.count}" if len(batch) < batch.count else ""
    text = f"{len(batch)}{of} ribbons"
    if not saved:
        return f"{text}, no shapes (`save: all` in the study keeps them)"
    return f"{text}, {shown}{f' of {saved}' if shown < saved else ''} saved with their shapes"


def _caption(row: Row) -> str:
    status = "verified" if row["verified"] else f"{row['status']}: {row.get('message') or ''}"
    return f"ribbon {row['number']}, {status}"


def _numbers(row: Row, inputs: tuple[str, ...]) -> list[tuple[str, str]]:
    return [(name, number_of(row[name])) for name in (*inputs, *ANSWERS) if name in row]
