"""Branches and studies under several laws as aligned plain text."""

from __future__ import annotations

from collections.abc import Sequence

from ribbonopt.plain import Row
from ribbonopt.studies.comparison.table import aligned

from .batches import StudyComparison
from .branches import BranchComparison
from .row_gaps import GAPS, SPECIAL_GAPS
from .table import PERCENT, barred, seconds, status, told

HEAD = ("law", "numbers", "points", "seconds", "status")
MOST = 40  # special points that are printed
NAMES = {"energy": "energy", "n0": "n(0)", "m0": "m(0)"} | {
    name: f"place of special point {i}" for i, name in enumerate(SPECIAL_GAPS, start=1)
}


def branch_table(study: BranchComparison) -> str:
    """Return laws with how far each went, special points law beside law, reasons and notes."""
    cells = [
        (law["law"], law["numbers"], str(len(law["points"])), seconds(law), status(law))
        for law in study.laws
    ]
    lines = [f"{study.name} continued under {len(study.laws)} laws; units {study.units}", ""]
    lines += aligned([HEAD, *cells])
    lines += _special(study.laws)
    short = [f"  {law['law']}{text}" for law in study.laws for text in _endings(law)]
    if short:
        lines += ["", "ended short of the goal:", *short]
    return "\n".join([*lines, *told(study.laws)])


def _endings(law: Row) -> list[str]:
    """Say of each branch of a law that ended short how it did."""
    if law["verified"] and not law["endings"]:  # broken off
        return [f": {law['message']}"]
    return [
        f", stage {e['stage'] + 1}, branch {e['branch']}: {e['reason']}"
        for e in law["endings"]
        if not e["reached"]
    ]


def _special(laws: Sequence[Row]) -> list[str]:
    """Return the table of special points: a line for each, a column for each law."""
    solved = [law for law in laws if law["verified"]]
    keys = dict.fromkeys(_key(row) for law in solved for row in law["special"])
    if not keys:
        return ["", "no special points"] if solved else []
    rows = [("special point", *(law["law"] for law in solved))]
    for key in sorted(keys)[:MOST]:
        cells = []
        for law in solved:
            found = next((row for row in law["special"] if _key(row) == key), None)
            cells.append("-" if found is None else _place(found))
        rows.append((_words(key, laws), *cells))
    more = [f"  and {len(keys) - MOST} more (laws.csv)"] if len(keys) > MOST else []
    return ["", *aligned(rows, left=1), *more]


def _key(row: Row) -> tuple[int, int, str, int]:
    return row["stage"], row["branch"], row["group"], row["place"]


def _words(key: tuple[int, int, str, int], laws: Sequence[Row]) -> str:
    stage, branch, group, place = key
    several = len({row["stage"] for law in laws for row in law["points"]}) > 1
    where = [f"stage {stage + 1}"] * several + [f"branch {branch}"] * (branch > 0)
    return ", ".join([f"{group} {place}", *where])


def _place(row: Row) -> str:
    return f"{barred(row['value'], row['value_error'])} ({row['kind'].removesuffix(' point')})"


def study_table(study: StudyComparison) -> str:
    """Return how many ribbons each law carries, and how far from the study's own law."""
    known = [name for name in NAMES if any(_known(law, name) for law in study.laws)]
    head = ("law", "numbers", "solved", *(f"{NAMES[name]}: median, largest" for name in known))
    rows = [(*head, "seconds", "status")]
    for law in study.laws:
        gaps = (_percent(law, name) for name in known)
        count = f"{law['solved']}/{law['ribbons']}"
        rows.append((law["law"], law["numbers"], count, *gaps, seconds(law), status(law)))
    lines = [f"{study.name}: {study.count} ribbons; differences to their own law", ""]
    lines += aligned(rows)
    some = [law for law in study.laws if law["verified"] and law["message"]]
    if some:
        lines += ["", "not solved under all laws, the first:"]
        lines += [f"  {law['law']}: {law['message']}" for law in some]
    return "\n".join([*lines, *told(study.laws)])


def _known(law: Row, name: str) -> list[float]:
    """Median and largest difference of the ribbons of a law; nothing where there is none."""
    both = law.get(f"{name}_gap"), law.get(f"{name}_gap_largest")
    return [value for value in both if value is not None]


def _percent(law: Row, name: str) -> str:
    """Write median and largest, relative in per cent; of places of special points as they are."""
    relative = name in GAPS
    words = [f"{value * (PERCENT if relative else 1.0):.3g}" for value in _known(law, name)]
    return f"{', '.join(words)}{' %' * relative}" if words else "-"
