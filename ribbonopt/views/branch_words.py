"""Words of the figures of a branch: the legend under them, and captions of ribbons."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ribbonopt.plain import Row
from ribbonopt.text import drawn

from .branch_axes import label, unit_of
from .branch_rows import POINT, BranchFigure
from .branch_style import COLOURS, DOT, STABLE, STYLES, UNKNOWN, UNSTABLE, mark_of, state_of
from .lettering import LETTER
from .locus_style import locus_of
from .paper_style import NARROW, sized, spaced, thinner
from .style import INK

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ENTRY = 2.2  # inches for one of the legend
HANDLE = 0.65  # inches of its line or mark, and between two


def plain_of(subject: BranchFigure) -> dict[str, Any]:
    """Return how curves are drawn where stability is known nowhere; nothing where it is."""
    known = any(state_of(row) in (STABLE, UNSTABLE) for row in subject.rows)
    return {} if known else {"ls": "-", "lw": 1.6}


def caption_of(row: Row, subject: BranchFigure) -> str:
    """Return what stands under a ribbon: number, kind, parameter, branch."""
    kind = "" if row["kind"] == POINT else f"  {drawn(row['kind'])}"
    branch = f"\nbranch {row['branch']}" if row["branch"] else ""
    unit = unit_of(row["parameter"], subject.si)
    value = f"{row[row['parameter']]:.4g}{f' {unit}' if unit else ''}"
    return (
        f"{row['number']}{kind}\n{label(row['parameter'], False, subject.labels)} = {value}{branch}"
    )


def write_legend(figure: Figure, subject: BranchFigure, numbers: str) -> None:
    """Entries for branches if there are several, and for the lines and marks that are drawn.

    `numbers` is the file of what bears numbers, "" for none.
    """
    from matplotlib.lines import Line2D

    planes = [plane for pair in subject.pairs for plane in subject.axes_of(pair)]
    drawn = {row["number"]: row for plane in planes for row in plane.rows}.values()
    names = {line.get_label() for axes in figure.axes for line in axes.lines}
    branches = sorted({row["branch"] for row in drawn if not locus_of(row)})
    entries: dict[str, dict[str, Any]] = {}
    # A branch beside loci, which have colours of their own, is told by its own.
    alone = len(branches) == 1 and any(map(locus_of, drawn))
    line = {"color": COLOURS[branches[0] % len(COLOURS)] if alone else INK}
    for branch in branches if len(branches) > 1 else []:
        entries[f"branch {branch}"] = {"color": COLOURS[branch % len(COLOURS)], "lw": 3}
    for name in (name for name in STYLES if name in names):
        count = sum(row["kind"] != POINT and mark_of(row) == name for row in drawn)
        plain = plain_of(subject) if name == UNKNOWN else {}
        tone = line if name in (STABLE, UNSTABLE, UNKNOWN) else {"color": INK}
        entries[name + (f" ({count})" if count else "")] = tone | STYLES[name] | plain
    if numbers:
        entries[f"numbers: points in {numbers}"] = {"color": INK, "ls": ""} | DOT
    handles = [Line2D([], [], label=text, **thinner(style)) for text, style in entries.items()]
    longest = max((len(text) for text in entries), default=0)
    entry = max(spaced(ENTRY) if figure.get_figwidth() > NARROW else 0, worded(longest))
    wide = max(1, int(figure.get_figwidth() / entry))
    n = math.ceil(len(handles) / math.ceil(len(handles) / wide)) if handles else 1
    look = {"ncols": n, "frameon": False, "fontsize": sized(9)}
    figure.legend(handles=handles, loc="outside lower center", **look)


def worded(letters: int) -> float:
    """Return the inches that an entry of so many letters takes."""
    return spaced(HANDLE) + LETTER * letters * sized(9) / 72
