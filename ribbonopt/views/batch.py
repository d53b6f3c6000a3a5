"""The report of a batch of ribbons: one HTML file with totals, failures, figures and first rows.

Rows are plain mappings, one for each ribbon; what they lack, None and NaN are unknown.
"""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.errors import OutputError

from .style import BENDING, FAINT, INK, TWIST, blank, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Rows = Sequence[Mapping[str, Any]]
Pair = tuple[str, str]
Mask = NDArray[np.bool_]

PANELS, ROWS, EXAMPLES, NUMBERS, REASONS, CATEGORIES, LONGEST = 6, 20, 3, 20, 30, 12, 300
HUGE = 1e100  # larger numbers count as unknown
WIDE = 100.0  # positive numbers whose 5 % and 95 % are further apart get a logarithmic axis
HISTOGRAMS = {"energy": False, "error": True, "seconds": True, "iterations": False}  # logarithmic
CSS = f"""
body {{ font: 15px/1.45 system-ui, sans-serif; color: {INK}; max-width: 75em; margin: 2em auto }}
div {{ overflow-x: auto }}
table {{ border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums }}
td {{ padding: .25em .7em; vertical-align: top; border-bottom: 1px solid #ddd; max-width: 34em }}
.first td {{ white-space: nowrap; overflow: hidden; text-overflow: ellipsis }}
.failures tr:first-child, .first tr:first-child {{ font-weight: 600 }}
b {{ color: {TWIST} }} img {{ max-width: 100% }}
"""


def save_batch_report(
    rows: Rows, folder: str | Path, *, name: str, inputs: Sequence[str], pairs: Sequence[Pair] = ()
) -> Path:
    """Write report.html, which needs no other file, into an existing folder.

    `inputs` are the keys that vary. `pairs` (x, y) are drawn, six at most; without them, the first
    two numeric inputs, and energy against each of the first three inputs.
    """
    failed = [row for row in rows if not row.get("verified")]
    parts = [f"<h1>{_text(name)}</h1>", _totals(rows, len(rows) - len(failed))]
    if failed:
        parts += ["<h2>What failed, and why</h2>", _failures(failed, inputs)]
    if rows:
        parts += ["<h2>Distributions</h2>", _picture(_histograms(rows), "histograms")]
        if drawn := list(pairs or _default_pairs(rows, inputs))[:PANELS]:
            picture = _picture(_scatters(rows, drawn, inputs), "scatter plots")
            parts += ["<h2>Results against inputs</h2>", picture]
        title = f"<h2>First {min(ROWS, len(rows))} of {len(rows)} rows</h2>"
        parts += [title, _first(rows[:ROWS], inputs)]
    head = f'<meta charset="utf-8">\n<title>{_text(name)}</title>\n<style>{CSS}</style>'
    body = "\n".join(parts)
    page = f'<!DOCTYPE html>\n<html lang="en">\n<head>\n{head}\n</head>\n<body>\n{body}\n</body>\n'
    path = Path(folder) / "report.html"
    try:
        path.write_text(page + "</html>\n", encoding="utf-8", errors="replace")
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error.strerror})") from error
    return path


def _totals(rows: Rows, done: int) -> str:
    """How many, how many of them verified, and the time they took."""
    totals = {"ribbons": f"{len(rows)}", "verified": f"{done}", "failed": f"{len(rows) - done}"}
    if rows:  # rounded down: 100 % only if all are
        totals["share verified"] = f"{done * 10000 // len(rows) / 100:g} %"
    seconds = _numbers(rows, "seconds")
    if len(seconds := seconds[np.isfinite(seconds)]):
        times = {"total CPU time": seconds.sum(), "median time of a ribbon": np.median(seconds)}
        times["95 % of the ribbons within"] = np.quantile(seconds, 0.95)
        totals |= {k: f"{v:,.0f} s" if v >= 100 else f"{v:.3g} s" for k, v in times.items()}
    return _table(totals.items(), "totals")


def _failures(failed: Rows, inputs: Sequence[str]) -> str:
    """Table by status and message; messages that differ in numbers only go together."""
    groups: dict[str, dict[str, list[Mapping[str, Any]]]] = {}
    for row in failed:
        pattern = re.sub(r"\d+(\.\d+)?(e[-+]?\d+)?", "#", _plain(row.get("message")))
        groups.setdefault(_text(row.get("status")), {}).setdefault(pattern, []).append(row)
    lines, left = [["", "message", "ribbons", "inputs of the first"]], REASONS
    counts = {status: sum(map(len, group.values())) for status, group in groups.items()}
    for status in sorted(groups, key=lambda status: -counts[status]):
        lines.append([f"<b>{counts[status]}</b>", f"<b>{status}</b>", "", ""])
        most = sorted(groups[status].values(), key=lambda found: -len(found))
        shown, left = most[: max(left, 1)], left - len(most)
        for found in shown:
            texts = list(dict.fromkeys(_text(row.get("message")) for row in found))
            text = texts[0] + " (also with other numbers)" * (len(texts) > 1)
            more = f" and {len(found) - NUMBERS} more" * (len(found) > NUMBERS)
            ribbons = ", ".join(_text(row.get("number")) for row in found[:NUMBERS]) + more
            few = [[f"{k} = {_plain(row.get(k))}" for k in inputs] for row in found[:EXAMPLES]]
            values = "<br>".join(escape(", ".join(line)) for line in few)
            lines.append([f"{len(found)}", text, ribbons, values])
        if rest := most[len(shown) :]:
            lines.append([f"{sum(map(len, rest))}", f"{len(rest)} other messages", "", ""])
    return _table(lines, "failures")


def _first(rows: Rows, inputs: Sequence[str]) -> str:
    """Table of the first rows, with all that they record."""
    keys = list(dict.fromkeys(["number", "status", *inputs, *(key for row in rows for key in row)]))
    lines = [[_text(key) for key in keys]]
    for row in rows:
        lines.append([_text(row.get(key)) for key in keys])
        lines[-1][1] = lines[-1][1] if row.get("verified") else f"<b>{lines[-1][1]}</b>"
    return _table(lines, "first")


def _table(lines: Iterable[Sequence[str]], kind: str) -> str:
    """Lines of cells that are HTML already."""
    rows = ("".join(f"<td>{cell}</td>" for cell in line) for line in lines)
    body = "\n".join(f"<tr>{row}</tr>" for row in rows)
    return f'<div><table class="{kind}">\n{body}\n</table></div>'


def _text(value: Any) -> str:
    return escape(_plain(value))


def _plain(value: Any, longest: int = LONGEST) -> str:
    """Text on one line: numbers in 6 digits, a dash for the unknown, long ones cut."""
    unknown = value is None or (isinstance(value, float) and np.isnan(value))
    text = f"{value:.6g}" if isinstance(value, float | np.floating) else str(value)
    text = "-" if unknown else "".join(c if c.isprintable() else " " for c in text)
    return text if len(text) <= longest else text[: longest - 1] + "…"


def _label(value: Any, longest: int = 40) -> str:
    """Text in letters that the font has, and no formulas."""
    known = (c if ord(c) < 0x400 or c == "…" else "?" for c in _plain(value, longest))
    return "".join(known).replace("$", r"\$")


def _numbers(rows: Rows, key: str) -> Array:
    """Values of a quantity, NaN where it is no number."""
    found = (row.get(key) for row in rows)
    kinds = (int, float, np.integer, np.floating)
    real = (v if isinstance(v, kinds) and not isinstance(v, bool) else np.nan for v in found)
    return np.array([v if abs(v) < HUGE else np.nan for v in real], dtype=np.float64)


def _default_pairs(rows: Rows, inputs: Sequence[str]) -> list[Pair]:
    numeric = [key for key in inputs if np.isfinite(_numbers(rows, key)).any()]
    both = [(numeric[0], numeric[1])] if len(numeric) > 1 else []
    return [*both, *((key, "energy") for key in inputs[:3])]


def _picture(figure: Figure, alt: str) -> str:
    file = BytesIO()
    figure.savefig(file, format="png", dpi=110)
    return f'<img alt="{alt}" src="data:image/png;base64,{b64encode(file.getvalue()).decode()}">'


def _histograms(rows: Rows) -> Figure:
    """Distributions, failed ribbons on top; energies of verified ones only."""
    figure, done = blank(11, 6.2), np.array([bool(row.get("verified")) for row in rows])
    for axes, (key, log) in zip(figure.subplots(2, 2).flat, HISTOGRAMS.items(), strict=True):
        values, asked = _numbers(rows, key), done | (key != "energy")
        usable = asked & np.isfinite(values) & ((values > 0) | (not log))
        low, high = _range(np.log10(values[usable]) if log else values[usable])
        edges = 10 ** np.linspace(low, high, 31) if log else np.linspace(low, high, 31)
        if key == "iterations":
            width = max(1.0, np.ceil((high - low) / 30))
            edges = np.arange(np.floor(low) - 0.5, high + width, width)
        sets = [values[usable & done], values[usable & ~done]]
        axes.hist(sets, list(edges), stacked=True, color=[BENDING, TWIST], ec="w", lw=0.4)
        axes.set(xscale="log" if log else "linear", xlabel=key, ylabel="ribbons")
        outside = usable & ((values < edges[0]) | (values > edges[-1]))
        _finish(axes, {"outside": outside, "unknown": asked & ~usable})
    _legend(figure, {"verified": "s", "failed": "s"})
    return figure


def _scatters(rows: Rows, pairs: Sequence[Pair], inputs: Sequence[str]) -> Figure:
    """One panel for each pair; what is unknown of failed ribbons lies on the edge of the panel."""
    columns = min(2, len(pairs))
    lines = -(-len(pairs) // columns)
    figure = blank(5.5 * columns, 4.0 * lines + 0.3)
    done = np.array([bool(row.get("verified")) for row in rows])
    energy, size = _numbers(rows, "energy"), 28 - 6 * np.log10(len(rows))
    look: dict[str, Any] = {"clip_on": False, "zorder": 3}
    for i, pair in enumerate(pairs):
        axes = figure.add_subplot(lines, columns, i + 1)
        x, no_x, far_x = _place(axes, 0, rows, pair[0], done | (pair[0] in inputs))
        y, no_y, far_y = _place(axes, 1, rows, pair[1], done | (pair[1] in inputs))
        drawn = ~np.where(done, no_x | no_y, no_x & no_y)
        bad, dots = drawn & ~done, drawn & done
        hot = dots & np.isfinite(energy) & (pair[1] in inputs)
        axes.scatter(*(v[dots & ~hot] for v in (x, y)), s=size, lw=0, color=BENDING, **look)
        if hot.any():
            low, high = np.quantile(energy[hot], (0.01, 0.99))
            points = axes.scatter(x[hot], y[hot], size, energy[hot], vmin=low, vmax=high, **look)
            figure.colorbar(points, ax=axes, label="energy", extend="both")
        axes.scatter(x[bad], y[bad], 1.5 * size, TWIST, "x", lw=1, **look)
        _finish(axes, {"beyond the edge": drawn & (far_x | far_y), "not drawn": ~drawn})
    _legend(figure, {"verified": "o", "failed; on the edge where unknown": "x"})
    return figure


def _place(axes: Axes, k: int, rows: Rows, key: str, leads: Mask) -> tuple[Array, Mask, Mask]:
    """Scale an axis to the leading rows; return positions, which are unknown, which are beyond."""
    values, axis, log = _numbers(rows, key), "xy"[k], False
    if not np.isfinite(values).any():  # texts: a column each, the last one for all others
        found = [None if row.get(key) is None else _label(row[key], 14) for row in rows]
        names = [text for text in dict.fromkeys(found) if text is not None]
        at = {None: np.nan} | {name: min(i, CATEGORIES) for i, name in enumerate(names)}
        values = np.array([at[text] for text in found]) + 0.3 * np.sin(np.arange(len(rows)))
        ticks = names[:CATEGORIES] + ["others"] * (len(names) > CATEGORIES)
        axes.set(**{f"{axis}ticks": range(len(ticks)), f"{axis}ticklabels": ticks})
    known = np.isfinite(values)
    if (known & leads).any() and not np.any(values[known] <= 0):
        first, last = np.quantile(values[known & leads], (0.05, 0.95))
        log = last > WIDE * first
    values = np.log10(values) if log else values
    low, high = _range(values[known & leads])
    low, high = low - 0.05 * (high - low), high + 0.05 * (high - low)
    places = np.clip(np.where(known, values, low), low, high)
    axes.set(**{f"{axis}label": _label(key), f"{axis}scale": "log" if log else "linear"})
    axes.set(**{f"{axis}lim": (10**low, 10**high) if log else (low, high)})
    return 10**places if log else places, ~known, known & (values != places)


def _range(values: Array) -> tuple[float, float]:
    """Where nearly all values are: not much further than from 1 % to 99 % of them."""
    first, last = np.quantile(values, (0.01, 0.99)) if values.size else (0.0, 1.0)
    more = last - first if last > first else np.inf
    low = max(min(values, default=first), first - more)
    high = min(max(values, default=last), last + more)
    half = 0.1 * abs(low) or 1.0
    return (low, high) if high - low > 1e-6 * abs(low) else (low - half, high + half)


def _finish(axes: Axes, notes: Mapping[str, Mask]) -> None:
    """Tidy up, and tell how many ribbons are not where they should be."""
    texts = [f"{mask.sum()} {what}" for what, mask in notes.items() if mask.any()]
    axes.set_title(", ".join(texts), loc="right", fontsize=8, color=FAINT)
    tidy(axes)


def _legend(figure: Figure, markers: Mapping[str, str]) -> None:
    from matplotlib.lines import Line2D

    looks = zip(markers.items(), (BENDING, TWIST), strict=True)
    lines = [Line2D([], [], ls="", label=label, marker=m, color=c) for (label, m), c in looks]
    figure.legend(handles=lines, loc="outside lower center", ncols=2, frameon=False, fontsize=9)
