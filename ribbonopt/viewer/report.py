"""The report of a batch: one page that says what succeeded, what failed and why, and shows it.

Plain rows in, HTML out: figures of the report are drawn by the browser or written as SVG here, so
that no plotting library is loaded. Works from a file, without a network.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from ribbonopt.errors import OutputError
from ribbonopt.output.staging import replacing
from ribbonopt.plain import Rows
from ribbonopt.text import marked_up
from ribbonopt.views.columns import numbers
from ribbonopt.views.failures import failures_html
from ribbonopt.views.histogram import distributions_html

from .parts import CHARTS, SCATTER, as_script, hash_of, joined, text_of
from .rows import status_colours, table_of

NONE = "--none"  # colour of ribbons that are missing
FILES = ("table.csv", "rows.jsonl")
SOLUTIONS = "solutions"  # folder beside the report; what is saved of ribbon 7 is in solutions/7
SCRIPTS = (*CHARTS, *SCATTER, "report.js")
STYLES = ("colours.css", "charts.css", "report.css")


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
    colours = status_colours(rows)
    script = joined(SCRIPTS)
    whole = " and ".join(  # links where the report lies beside the rows
        f'<a href="{file}">{file}</a>' if (here / file).is_file() else file for file in FILES
    )
    parts = {
        "title": marked_up(name),
        "policy": f"default-src 'none'; script-src {hash_of(script)}; style-src 'unsafe-inline'",
        "style": joined(STYLES),
        "head": _summary(rows, name, count, colours),
        "failures": failures_html(rows, inputs, colours),
        "distributions": distributions_html(rows, inputs),
        "files": whole,
        "data": as_script(table_of(rows, inputs, _links(rows, here))),
        "script": script,
    }
    # In one pass: what a row says may look like the name of a part.
    return re.sub(r"@(\w+)@", lambda found: parts.get(found[1], found[0]), text_of("report.html"))


def _links(rows: Rows, here: Path) -> dict[int, str]:
    """Return where solutions lie that are saved beside the report, by the numbers of rows."""
    saved = here / SOLUTIONS
    folders = {item.name for item in saved.iterdir()} if saved.is_dir() else set()
    numbered = (int(row["number"]) for row in rows)
    return {number: f"{SOLUTIONS}/{number}/" for number in numbered if str(number) in folders}


def _summary(rows: Rows, name: str, count: int, colours: Mapping[str, str]) -> str:
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
    counts = Counter(str(row["status"]) for row in rows)
    parts = [(status, counts[status], colour) for status, colour in colours.items()]
    parts += [("missing", missing, NONE)] if missing else []
    bar = "".join(
        f'<div style="flex:{n} 0 0;background:var({colour})"></div>' for _, n, colour in parts
    )
    legend = "".join(
        f'<span><i style="background:var({colour})"></i>{marked_up(status)} {n}</span>'
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
