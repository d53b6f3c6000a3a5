"""The report of modes of small vibrations: a table, what does not count, and what grows."""

from __future__ import annotations

from collections.abc import Sequence

from ribbonopt.checks.modes import Modes
from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from .modes_rows import HERTZ, bar_of, value_of, which_of, words_of

TITLE = "small vibrations"


def told(solution: Solution, modes: Modes, rows: Sequence[Row]) -> str:
    """Return the report of modes of a solution, with `rows_of` them."""
    numbers = [value_of(row, modes.unit) for row in rows]
    head = "frequency" if modes.unit == HERTZ else "omega"
    wide = max(map(len, (head, *numbers)), default=0)
    which = which_of(solution, modes)
    lines = [f"{solution.scene.name}: {_counted(rows)} of {TITLE}{_units(modes.unit)}"]
    lines += [f"  ({which})"] if which else []
    lines.append(f"  {'':>3}  {head:<{wide}}  rel. error")
    for row, number in zip(rows, numbers, strict=True):
        line = f"  {row['number']:>3}  {number:<{wide}}  {bar_of(row):<10}  {words_of(row)}"
        lines.append(line.rstrip())
    lines += [f"  of zero frequency, not counted: {', '.join(modes.zero)}"] if modes.zero else []
    return "\n".join([*lines, *_grows(modes)])


def _counted(rows: Sequence[Row]) -> str:
    return f"{len(rows)} mode{'' if len(rows) == 1 else 's'}"


def _units(unit: str) -> str:
    return "" if unit == HERTZ else f", omega in units of {unit}"


def _grows(modes: Modes) -> list[str]:
    """Say how many modes grow, of all, not only of those in the table."""
    if not modes.negative:
        return []
    one = modes.negative == 1
    return [f"  unstable: {modes.negative} mode{'' if one else 's'} grow{'s' if one else ''}"]
