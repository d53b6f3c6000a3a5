"""The report of a batch of ribbons: one HTML file with totals, failures, figures and first rows.

Rows are plain mappings, one for each ribbon; what they lack, None and NaN are shown as unknown.
"""

from __future__ import annotations

import math
import re
from base64 import b64encode
from collections.abc import Mapping, Sequence
from html import escape
from io import BytesIO
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import OutputError

from .style import BENDING, FAINT, INK, TWIST, blank, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PlainRow = Mapping[str, Any]
Rows = Sequence[PlainRow]
Pair = tuple[str, str]

PANELS, ROWS, EXAMPLES, NUMBERS, REASONS, CATEGORIES, LONGEST = 6, 20, 3, 20, 30, 12, 300
HUGE = 1e100  # beyond it a number counts as unknown
WIDE = 100.0  # of positive numbers whose 5 % and 95 % are further apart, the axis is logarithmic
DPI = 110
HISTOGRAMS = (  # quantity, label, logarithmic, of failed ribbons too
    ("energy", "energy (verified)", False, False),
    ("error", "estimated error", True, True),
    ("seconds", "time of a ribbon (s)", True, True),
    ("iterations", "iterations", False, True),
)
CSS = f"""
body {{ font: 15px/1.45 system-ui, sans-serif; color: {INK}; max-width: 75em; margin: 2em auto;
  padding: 0 1em }}
h1, h2 {{ font-weight: 600; line-height: 1.2 }}
h2 {{ margin-top: 1.8em }}
.wide {{ overflow-x: auto }}
table {{ border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums }}
th, td {{ padding: .25em .7em; text-align: left; vertical-align: top;
  border-bottom: 1px solid #ddd }}
td {{ overflow-wrap: anywhere; min-width: 2.5em; max-width: 34em }}
.rows td {{ white-space: nowrap; overflow: hidden; text-overflow: ellipsis }}
.number {{ text-align: right }}
.totals th {{ font-weight: 400; color: {FAINT} }}
.bad {{ color: {TWIST} }}
.faint, figcaption {{ color: {FAINT}; font-size: 13px }}
figure {{ margin: 0 }}
img {{ max-width: 100%; height: auto }}
"""


def save_batch_report(
    rows: Rows, folder: str | Path, *, name: str, inputs: Sequence[str], pairs: Sequence[Pair] = ()
) -> Path:
    """Write report.html, which needs no other file, into an existing folder.

    `inputs` are the keys of the rows that were varied, `pairs` the (x, y) to draw, six at most;
    else the first two numeric inputs, and energy against the first three.
    """
    done = [row for row in rows if row.get("verified")]
    failed = [row for row in rows if not row.get("verified")]
    parts = [f"<h1>{_text(name)}</h1>", _totals(rows, len(done))]
    if failed:
        parts += ["<h2>What failed, and why</h2>", _failures(failed, inputs)]
    if rows:
        parts += ["<h2>Distributions</h2>", _picture(_histograms(done, failed), "Histograms")]
    drawn = (list(pairs) or _default_pairs(rows, inputs))[:PANELS]
    if rows and drawn:
        picture = _picture(_scatters(rows, drawn, inputs), "Scatter plots")
        parts += ["<h2>Results against inputs</h2>", picture]
    if rows:
        parts += [f"<h2>First {min(ROWS, len(rows))} of {len(rows)} rows</h2>", _first(rows, inputs)]
    page = (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{_text(name)}</title>\n<style>{CSS}</style>\n</head>\n<body>\n"
        + "\n".join(parts)
        + "\n</body>\n</html>\n"
    )
    path = Path(folder) / "report.html"
    try:
        path.write_text(page, encoding="utf-8", errors="replace")
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error.strerror})") from error
    return path


def _totals(rows: Rows, done: int) -> str:
    """How many, how many of them verified, and the time they took."""
    totals = {"ribbons": f"{len(rows)}", "verified": f"{done}", "failed": f"{len(rows) - done}"}
    if rows:  # rounded down: 100 % only if all are
        totals["share verified"] = f"{done * 10000 // len(rows) / 100:g} %"
    seconds = _numbers(rows, "seconds")
    seconds = seconds[np.isfinite(seconds)]
    if len(seconds):
        totals["total CPU time"] = _time(seconds.sum())
        totals["median time of a ribbon"] = _time(np.median(seconds))
        totals["95 % of the ribbons within"] = _time(np.quantile(seconds, 0.95))
    lines = [f'<tr><th>{k}</th><td class="number">{v}</td></tr>' for k, v in totals.items()]
    return '<table class="totals">\n' + "\n".join(lines) + "\n</table>"


def _failures(failed: Rows, inputs: Sequence[str]) -> str:
    """Table of failures by status and message; messages that differ in numbers only are one."""
    groups: dict[str, dict[str, list[PlainRow]]] = {}
    for row in failed:
        pattern = re.sub(r"\d+(\.\d+)?(e[-+]?\d+)?", "#", str(row.get("message") or ""))
        groups.setdefault(str(row.get("status")), {}).setdefault(pattern, []).append(row)
    lines, left = [], REASONS
    for status, reasons in sorted(groups.items(), key=lambda g: -sum(map(len, g[1].values()))):
        count = sum(map(len, reasons.values()))
        lines.append(f'<tr><th colspan="4" class="bad">{_text(status)}: {count}</th></tr>')
        most = sorted(reasons.values(), key=lambda found: -len(found))
        shown = most[: max(left, 1)]
        left -= len(shown)
        for found in shown:
            alike = len({row.get("message") for row in found}) > 1
            cells = [
                _text(found[0].get("message") or "no message")
                + ' <span class="faint">(and with other numbers)</span>' * alike,
                _collapsed([row.get("number") for row in found]),
                "<br>".join(_described(row, inputs) for row in found[:EXAMPLES]),
            ]
            tds = "".join(f"<td>{cell}</td>" for cell in cells)
            lines.append(f'<tr><td class="number">{len(found)}</td>{tds}</tr>')
        if rest := most[len(shown) :]:
            note = f"{sum(map(len, rest))} more, with {len(rest)} other messages"
            lines.append(f'<tr><td colspan="4" class="faint">{note}</td></tr>')
    heads = "".join(f"<th>{h}</th>" for h in ("", "message", "ribbons", "inputs of the first"))
    table = f"<table>\n<tr>{heads}</tr>\n" + "\n".join(lines) + "\n</table>"
    return f'<div class="wide">{table}</div>'


def _collapsed(numbers: Sequence[Any]) -> str:
    more = len(numbers) - NUMBERS
    return ", ".join(map(_text, numbers[:NUMBERS])) + (f" and {more} more" if more > 0 else "")


def _described(row: PlainRow, inputs: Sequence[str]) -> str:
    values = [f"{_text(key)} = {_text(row.get(key))}" for key in inputs]
    return f'<span class="faint">{_text(row.get("number"))}:</span> ' + ", ".join(values)


def _first(rows: Rows, inputs: Sequence[str]) -> str:
    """Table of the first rows, with all that they record."""
    rows = rows[:ROWS]
    keys = dict.fromkeys(["number", "status", *inputs, *(key for row in rows for key in row)])
    lines = ["<tr>" + "".join(f"<th>{_text(key)}</th>" for key in keys) + "</tr>"]
    for row in rows:
        cells = []
        for key in keys:
            kind = ' class="number"' if np.isfinite(_number(row.get(key))) else ""
            cells.append(f"<td{kind}>{_text(row.get(key))}</td>")
        bad = "" if row.get("verified") else ' class="bad"'
        lines.append(f"<tr{bad}>" + "".join(cells) + "</tr>")
    return '<div class="wide"><table class="rows">\n' + "\n".join(lines) + "\n</table></div>"
