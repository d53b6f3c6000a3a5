"""The report of a batch: one page that says what succeeded, what failed and why, and shows it.

Plain rows in, HTML out: figures of the report are drawn by the browser or written as SVG here, so
that no plotting library is loaded. Works from a file, without a network.
"""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from statistics import median
from typing import Any

from ribbonopt.errors import OutputError

from .columns import (
    Row,
    Rows,
    columns,
    is_logarithmic,
    is_missing,
    is_number,
    is_numeric,
    numbers,
    said,
    varied,
)

NUMERIC = re.compile(r"[-+]?\d+(\.\d*)?(e[-+]?\d+)?", re.IGNORECASE)
GOOD, BAD, NONE = "#1f5fa8", ("#c2410c", "#e69f00", "#cc79a7", "#8a5a44", "#777777"), "#c9c9c9"
LONG = ("message", "path")  # columns of text, for the table of rows that failed alone
LISTED, NUMBERED, BINS, LONGEST = 200, 20, 30, 60


def write_report(
    rows: Rows, inputs: Sequence[str], path: str | Path, *, name: str, count: int
) -> Path:
    """Write the report of a batch and return where.

    Parameters
    ----------
    rows
        What came out, as in `rows.jsonl`.
    inputs
        Columns that were swept.
    path
        The file; an older one is replaced.
    name, count
        Of the study: its name, and how many ribbons it has.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    path = Path(path)
    rows = sorted(rows, key=lambda row: int(row["number"]))
    text = _page(rows, tuple(inputs), name, count)
    beside = path.with_name(f".{path.name}.new")
    try:
        beside.write_text(text, encoding="utf-8")
        beside.replace(path)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise OutputError(f"{path}: cannot be written ({error.strerror})") from error
    return path


def _page(rows: Rows, inputs: tuple[str, ...], name: str, count: int) -> str:
    here = files("ribbonopt.views")
    parts = {
        "title": escape(name),
        "body": _summary(rows, name, count) + _failures(rows, inputs) + _distributions(rows),
        "table": _table(rows),
        "data": _data(rows, inputs),
        "script": (here / "report.js").read_text(encoding="utf-8"),
    }
    page = (here / "report.html").read_text(encoding="utf-8")
    # In one pass: what a row says may look like the name of a part.
    return re.sub(r"@(\w+)@", lambda found: parts.get(found[1], found[0]), page)


def _summary(rows: Rows, name: str, count: int) -> str:
    statuses = Counter(str(row["status"]) for row in rows)
    good = sum(bool(row["verified"]) for row in rows)
    seconds, errors = sorted(numbers(rows, "seconds")), numbers(rows, "error")
    tiles = [(f"{good}", "verified", "good")]
    tiles += [(f"{len(rows) - good}", "failed", "bad")] if len(rows) > good else []
    tiles += [(f"{count - len(rows)}", "missing: go on by --resume", "bad")] * (count > len(rows))
    if seconds:
        late = seconds[min(int(0.95 * len(seconds)), len(seconds) - 1)]
        spent = f"{sum(seconds):.3g} s"
        each = f"{1e3 * median(seconds):.3g} ms"
        tiles += [(spent, "of solving", ""), (each, f"median; 95 % below {1e3 * late:.3g} ms", "")]
    if errors:
        label = f"largest relative error; median {median(errors):.0e}"
        tiles.append((f"{max(errors):.0e}", label, ""))
    shown = "".join(
        f'<div><b class="{kind}">{escape(value)}</b><span>{escape(label)}</span></div>'
        for value, label, kind in tiles
    )
    parts = [(status, n, _colour(i, status)) for i, (status, n) in enumerate(_ordered(statuses))]
    parts += [("missing", count - len(rows), NONE)] if count > len(rows) else []
    bar = "".join(f'<div style="flex:{n} 0 0;background:{colour}"></div>' for _, n, colour in parts)
    legend = "".join(
        f'<span><i style="background:{colour}"></i>{escape(status)} {n}</span>'
        for status, n, colour in parts
    )
    return (
        f"<h1>{escape(name)}</h1><p>{count} ribbons</p>"
        f'<div class="tiles">{shown}</div><div class="bar">{bar}</div>'
        f'<div class="legend">{legend}</div>'
    )


def _ordered(statuses: Counter[str]) -> list[tuple[str, int]]:
    return sorted(statuses.items(), key=lambda item: (item[0] != "converged", -item[1]))


def _colour(place: int, status: str) -> str:
    return GOOD if status == "converged" else BAD[place % len(BAD)]


def _failures(rows: Rows, inputs: tuple[str, ...]) -> str:
    """Rows that failed for the same reason, messages being the same but for their numbers."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        if not row["verified"]:
            kind = NUMERIC.sub("#", str(row.get("message", "")))
            groups.setdefault((str(row["status"]), kind), []).append(row)
    if not groups:
        return "<h2>What failed</h2><p>Nothing: every ribbon is solved and verified.</p>"
    lines = []
    for (status, _), group in sorted(groups.items(), key=lambda item: -len(item[1])):
        some = ", ".join(str(row["number"]) for row in group[:NUMBERED])
        some += ", ..." if len(group) > NUMBERED else ""
        ranges = "; ".join(text for key in inputs if (text := _range(group, key)))
        cells = (len(group), status, str(group[0].get("message", "")), some, ranges)
        lines.append(_cells(cells, "message", ("n", "", "m", "", "")))
    head = "".join(
        f"<th>{title}</th>"
        for title in ("ribbons", "status", "why (the first)", "numbers", "where")
    )
    return (
        f'<h2>What failed, and why</h2><div class="scroll"><table><tr>{head}</tr>'
        f"{''.join(lines)}</table></div>"
    )


def _range(rows: Rows, key: str) -> str:
    values = numbers(rows, key)
    if values:
        low, high = min(values), max(values)
        return f"{key} = {low:.4g}" + (f" to {high:.4g}" if high > low else "")
    words = list(dict.fromkeys(said(row[key]) for row in rows if row.get(key) is not None))
    return f"{key}: {', '.join(words[:4])}{', ...' if len(words) > 4 else ''}" if words else ""


def _distributions(rows: Rows) -> str:
    names = [name for name in columns(rows) if name != "number"]
    drawn = [_histogram(name, values) for name in names if (values := varied(rows, name))]
    if not drawn:
        return ""
    return f'<h2>Distributions</h2><div class="hists">{"".join(drawn)}</div>'


def _histogram(name: str, values: Sequence[float]) -> str:
    log = is_logarithmic(values)
    places = [math.log10(value) for value in values] if log else values
    low, high = min(places), max(places)
    bins = min(len(set(values)), BINS)
    counts = [0] * bins
    for place in places:
        counts[min(int(bins * (place - low) / (high - low)), bins - 1)] += 1
    bars = "".join(
        f'<rect x="{10 * i + 1}" y="{70 - 68 * n / max(counts):.1f}" width="8" '
        f'height="{68 * n / max(counts):.1f}"/>'
        for i, n in enumerate(counts)
    )
    scale = " (log)" if log else ""
    return (
        f"<figure><figcaption>{escape(name)}{scale}</figcaption>"
        f'<svg viewBox="0 0 {10 * bins} 70" preserveAspectRatio="none" fill="{GOOD}">{bars}</svg>'
        f"<small><span>{min(values):.4g}</span><span>{max(values):.4g}</span></small></figure>"
    )


def _table(rows: Rows) -> str:
    names = [name for name in columns(rows) if name not in LONG]
    failed = [row for row in rows if not row["verified"]][:LISTED]
    chosen = failed + [row for row in rows if row["verified"]][: LISTED - len(failed)]
    chosen.sort(key=lambda row: int(row["number"]))
    head = "".join(f"<th>{escape(name)}</th>" for name in names)
    body = "".join(_cells([row.get(name) for name in names]) for row in chosen)
    few = "" if len(chosen) == len(rows) else f"{len(chosen)} of {len(rows)}, failed ones first; "
    return (
        f'<h2>Rows</h2><p>{few}all of them are in <a href="table.csv">table.csv</a> and '
        f'<a href="rows.jsonl">rows.jsonl</a>.</p><div class="scroll"><table><tr>{head}</tr>{body}'
        "</table></div>"
    )


def _cells(values: Sequence[Any], whole: str = "", kinds: Sequence[str] = ()) -> str:
    cells = []
    for i, value in enumerate(values):
        kind = kinds[i] if kinds else ("n" if is_number(value) else "")
        text = said(value)
        if not whole and len(text) > LONGEST:
            text = text[: LONGEST - 3] + "..."
        cells.append(f'<td class="{kind}">{escape(text)}</td>')
    return f"<tr>{''.join(cells)}</tr>"


def _data(rows: Rows, inputs: tuple[str, ...]) -> str:
    """Columns for the scatter plot as JSON that no row can end before its time."""
    names = [name for name in columns(rows) if name not in LONG]
    kinds = {name: is_numeric(rows, name) for name in names}
    first = [key for key in inputs if kinds.get(key)] or list(inputs[:1]) or ["number"]
    y = "energy" if "energy" in names else first[-1]
    chosen: dict[str, Any] = {"x": first[0], "y": y, "c": first[1] if first[1:] else "status"}
    chosen |= {f"l{axis}": is_logarithmic(numbers(rows, chosen[axis])) for axis in "xy"}
    table = [[_plain(row.get(name), kinds[name]) for name in names] for row in rows]
    data = {
        "names": names,
        "numeric": list(kinds.values()),
        "rows": table,
        "status": [bool(row["verified"]) for row in rows],
        "defaults": chosen | {"inputs": list(inputs)},
    }
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _plain(value: Any, numeric: bool) -> Any:
    if is_missing(value):
        return None
    return value if numeric else said(value)
