"""Numbers with sources as a page of Markdown: a table for each source."""

from __future__ import annotations

from ribbonopt.text import printable

from .run import Verification
from .table import cells, sentences
from .verdict import Verdict

HEAD = (
    *("scene", "set", "quantity", "source", "ours", "bar", "digits", "CPU s", "", "what it is"),
)
BEFORE = """# Numbers with sources, computed again

Made by `ribbonopt verify --out FOLDER`; not written by hand. Scenes and rows are in
[`verification.yaml`](../ribbonopt/studies/verification/verification.yaml), which stands by itself:
cite it, and run it against another program.

    ribbonopt verify                       # all rows; exit status 3 if one is off
    ribbonopt verify half 'fold.*'         # some, by scene or quantity
    ribbonopt verify --file own.yaml       # rows of your own

A row is *ok* where

    |ours - source| <= bar + half a unit of the last digit that the source has.

`source` has the digits that stand, as far as a double has them; `ours` those that the bar leaves;
`digits` is how many of them agree (decimals, where the source is zero). `bar` is what the package
claims of the error of this very answer; `~` before it says that there is none for this quantity,
and the scene's tolerance stands in for it; `-` that it is a count, right or wrong. The CPU time of
a row is that of what was not there yet: the first of a scene pays for its solution or its branch.

## The file

`scenes` are whole scenes by name, as `ribbonopt solve` takes them. A row has `scene`, maybe `set`
(other values in it, by dotted keys), `quantity`, `value`, `digits` (significant digits of the value
that stand, or `exact`), `source`, maybe `about`. Units are D w = L = 1, or SI where a scene has a
`ribbon`; d1 is the normal, d2 across the width, d3 the tangent; n and m are in the lab frame.

| quantity | what it is |
| --- | --- |
| `n0.x`, `m0.y` | force and moment at the start |
| `u0.2` | strains there, along the directors |
| `r(0.5).x`, `d1(end).z`, `u(0).2`, `m2(0.25)` | any output at an arclength |
| `energy`, `potential`, `H`, `twist` | H = W_Leg + n3 at the start; turns |
| `record.NAME` | a formula that the scene records |
| `reaction.2.x` | force of the second support |
| `switch.1` | arclength where the curvature jumps |
| `negative`, `switches`, `half_twists` | negative directions of the second variation; how many |
| `fold.1.value`, `branch_point.2.value` | the parameter at a special point of the `continuation` |
| `at(0.25).energy` | the branch where the parameter is 0.25 |
| `locus(0.25)` | the first of two parameters on a locus, where the second is 0.25 |
| `frequency.1` | natural frequency of small vibrations |
| `buckling.1` | buckling load of a straight ribbon, in the range of the `continuation` |

## All rows
"""


def page(study: Verification) -> str:
    """Return the page."""
    lines = [BEFORE, *(f"{printable(text)}.  " for text in sentences(study)), _machine(study)]
    sources: dict[str, list[Verdict]] = {}
    for verdict in study.verdicts:
        sources.setdefault(verdict.claim.source, []).append(verdict)
    for source, rows in sources.items():
        lines += ["", f"### {_cell(source)}", "", _line(HEAD), _line(("---",) * len(HEAD))]
        lines += [_line(_row(verdict)) for verdict in rows]
    return "\n".join(lines) + "\n"


def _machine(study: Verification) -> str:
    plain = study.plain()
    found = {**plain["versions"], "system": plain["machine"]["system"]}
    return "With " + ", ".join(f"{name} {value}" for name, value in found.items()) + "."


def _row(verdict: Verdict) -> tuple[str, ...]:
    claim, (_, *others) = verdict.claim, cells(verdict)
    given = "; ".join(f"`{text}`" for text in claim.given)
    return (claim.scene, given, f"`{others[0]}`", *others[1:], claim.about)


def _line(texts: tuple[str, ...]) -> str:
    return "| " + " | ".join(map(_cell, texts)) + " |"


def _cell(text: str) -> str:
    """Return a text that stays in its cell."""
    return printable(text).replace("\n", " ").replace("|", r"\|")
