"""The report of a batch: one page that says what succeeded, what failed and why, and shows it.

Plain rows in, HTML out: figures of the report are drawn by the browser or written as SVG here, so
that no plotting library is loaded. Works from a file, without a network.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from statistics import median
from typing import Any

from ribbonopt.errors import OutputError
from ribbonopt.output.staging import replacing
from ribbonopt.plain import Row, Rows, is_number
from ribbonopt.scene.quantities import START_VECTORS
from ribbonopt.text import marked_up

from .columns import (
    as_text,
    columns,
    is_logarithmic,
    is_missing,
    is_numeric,
    numbers,
    varied,
    words,
)
from .failures import failures_html
from .histogram import distributions_html

GOOD, BAD = "#1f5fa8", ("#c2410c", "#e69f00", "#cc79a7", "#8a5a44", "#777777")
NONE = "#c9c9c9"  # ribbons that are missing
LONG = ("message", "note", "path", "verified")  # not for axes
MINOR = (
    "potential",
    "H0",
    *(part for vector in START_VECTORS for part in vector),
    "start",
    "note",
    "message",
)
LISTED, FAILED, LONGEST = 200, 1000, 60  # rows of the table, more that failed, letters of a cell
FILES = ("table.csv", "rows.jsonl")
SOLUTIONS = "solutions"  # folder beside the report; what is saved of ribbon 7 is in solutions/7


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
    text = _page(rows, tuple(inputs), name, count, path.parent)
    try:
        # Half a character, which JSON can say and UTF-8 cannot, is no reason to fail.
        with replacing(path, errors="xmlcharrefreplace") as file:
            file.write(text)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error.strerror})") from error
    return path


def _page(rows: Rows, inputs: tuple[str, ...], name: str, count: int, here: Path) -> str:
    own = files("ribbonopt.views")
    counts = Counter(str(row["status"]) for row in rows)
    # A status is good if all its rows are verified.
    failed = {str(row["status"]) for row in rows if not row["verified"]}
    statuses = sorted(counts, key=lambda status: (status in failed, -counts[status]))
    bad = [status for status in statuses if status in failed]
    colours = {status: BAD[i % len(BAD)] for i, status in enumerate(bad)}
    colours = {status: colours.get(status, GOOD) for status in statuses}
    parts = {
        "title": marked_up(name),
        "head": _summary(rows, name, count, {s: (counts[s], c) for s, c in colours.items()}),
        "failures": failures_html(rows, inputs, colours),
        "distributions": distributions_html(rows, inputs),
        "table": _table(rows, inputs, here),
        "data": _data(rows, inputs, colours),
        "script": (own / "report.js").read_text(encoding="utf-8"),
    }
    page = (own / "report.html").read_text(encoding="utf-8")
    # In one pass: what a row says may look like the name of a part.
    return re.sub(r"@(\w+)@", lambda found: parts.get(found[1], found[0]), page)


def _summary(rows: Rows, name: str, count: int, statuses: dict[str, tuple[int, str]]) -> str:
    good = [row for row in rows if row["verified"]]
    seconds, errors = sorted(numbers(rows, "seconds")), numbers(good, "error")
    missing, failed = max(count - len(rows), 0), len(rows) - len(good)
    tiles = [(str(len(good)), "verified", "good")]
    tiles += [(str(failed), "failed", "bad")] if failed else []
    tiles += [(str(missing), "missing: go on by --resume", "bad")] if missing else []
    if seconds:
        late = seconds[min(int(0.95 * len(seconds)), len(seconds) - 1)]
        tiles.append((_time(sum(seconds)), "of solving", ""))
        tiles.append((_time(median(seconds)), f"median; 95 % below {_time(late)}", ""))
    if errors:
        tiles.append((f"{max(errors):.0e}", f"largest error; median {median(errors):.0e}", ""))
    shown = "".join(
        f'<div><b class="{kind}">{value}</b><span>{label}</span></div>'
        for value, label, kind in tiles
    )
    parts = [(status, *statuses[status]) for status in statuses]
    parts += [("missing", missing, NONE)] if missing else []
    bar = "".join(f'<div style="flex:{n} 0 0;background:{colour}"></div>' for _, n, colour in parts)
    legend = "".join(
        f'<span><i style="background:{colour}"></i>{marked_up(status)} {n}</span>'
        for status, n, colour in parts
    )
    return (
        f"<h1>{marked_up(name)}</h1><p>{count} ribbon{'s' * (count != 1)}</p>"
        f'<div class="tiles">{shown}</div><div class="bar">{bar}</div>'
        f'<div class="legend">{legend}</div>'
    )


def _time(seconds: float) -> str:
    units = ((3600.0, "h"), (60.0, "min"), (1.0, "s"))
    size, unit = next((pair for pair in units if seconds >= pair[0]), (1e-3, "ms"))
    value = seconds / size
    return f"{value:.0f} {unit}" if value >= 100 else f"{value:.3g} {unit}"


def _table(rows: Rows, inputs: tuple[str, ...], here: Path) -> str:
    """Table of the first rows and of those that failed; numbers of what is saved are links."""
    failed = [row for row in rows[LISTED:] if not row["verified"]]
    chosen = [*rows[:LISTED], *failed[:FAILED]]
    hidden = {"path", "verified"} | ({"scene"} if len(words(rows, "scene")) < 2 else set())
    names = [name for name in columns(rows, inputs) if name not in hidden]
    saved = here / SOLUTIONS
    folders = {item.name for item in saved.iterdir()} if saved.is_dir() else set()
    whole = " and ".join(  # links where the report lies beside the rows
        f'<a href="{file}">{file}</a>' if (here / file).is_file() else file for file in FILES
    )
    head = "".join(f'<th class="{_kind(name)}">{marked_up(name)}</th>' for name in names)
    body = "".join(f"<tr>{_cells(row, names, folders)}</tr>" for row in chosen)
    which = f"the first {LISTED}" + (" and those that failed" if failed else "")
    which += f" ({FAILED} of {len(failed)} more)" if len(failed) > FAILED else ""
    few = f"{len(chosen)} of {len(rows)}, {which}; " if len(chosen) < len(rows) else ""
    return (
        f"<h2>Rows</h2><p>{few}all of them are in {whole}.</p>"
        f'<div class="scroll"><table><tr>{head}</tr>{body}'
        "</table></div>"
    )


def _cells(row: Row, names: Sequence[str], folders: set[str]) -> str:
    cells = []
    for name in names:
        value = row.get(name)
        text, title, kind = as_text(value), "", _kind(name)
        if len(text) > LONGEST:
            text, title = text[: LONGEST - 1] + "…", f' title="{marked_up(text)}"'
        text = marked_up(text)
        if name == "number" and text in folders:
            text = f'<a href="{SOLUTIONS}/{text}/">{text}</a>'
        if name == "status" and not row["verified"]:
            kind = "bad"
        kind += " n" if is_number(value) else ""
        cells.append(f'<td class="{kind.strip()}"{title}>{text}</td>')
    return "".join(cells)


def _kind(name: str) -> str:
    """Class of a column: paper has no room for those that are minor."""
    return "minor" if name in MINOR else ""


def _data(rows: Rows, inputs: tuple[str, ...], colours: dict[str, str]) -> str:
    """Columns for the scatter plot as JSON that no row can end before its time."""
    names = [name for name in columns(rows, inputs) if name not in LONG]
    kinds = {name: is_numeric(rows, name) for name in names}
    logs = [
        kinds[name] and name != "number" and is_logarithmic(numbers(rows, name)) for name in names
    ]
    swept = [key for key in inputs if kinds.get(key) and varied(rows, key)]
    given = [key for key in inputs if len(words(rows, key)) > 1]
    x, *others = [*swept, *(key for key in given if key not in swept)] or ["number"]
    y = "energy" if kinds.get("energy") else (others or ["status"])[0]
    shades = [key for key in others if key != y] or ["status"]
    data = {
        "names": names,
        "numeric": list(kinds.values()),
        "log": logs,
        "rows": [[_plain(row.get(name), kinds[name]) for name in names] for row in rows],
        "status": [bool(row["verified"]) for row in rows],
        "colours": colours,
        "defaults": {"x": x, "y": y, "c": shades[0], "inputs": list(inputs)},
    }
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _plain(value: Any, numeric: bool) -> Any:
    if is_missing(value):
        return None
    return value if numeric else as_text(value)
