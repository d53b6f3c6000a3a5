"""Histograms of columns of rows: how many ribbons, verified and failed, for each value.

As numbers, for any picture, and as SVG, for the report.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

from ribbonopt.classes import dataclass
from ribbonopt.plain import Rows, is_number
from ribbonopt.text import marked_up

from .columns import as_text, columns, is_logarithmic, is_missing, is_numeric, varied, words

BINS = (6, 24)  # least and most, if values do not recur
MOST_BARS = 60  # of values that recur, and in the room of which they lie
MOST_WORDS = 12
HEIGHT = 66  # of the SVG; 100 wide, stretched as the page has room


@dataclass(frozen=True)
class Bar:
    """Ribbons between two values; in a logarithmic histogram, between two logarithms."""

    left: float
    right: float
    verified: int
    failed: int


@dataclass(frozen=True)
class Histogram:
    """Bars of a column from left to right; of words, a bar around 0, 1, ... for each.

    `ends` are the least and the greatest value.
    """

    name: str
    log: bool
    words: tuple[str, ...]
    bars: tuple[Bar, ...]
    ends: tuple[float, float] = (0.0, 0.0)

    def edges(self, bar: Bar) -> tuple[float, float]:
        """Return the values that a bar lies between."""
        return (10**bar.left, 10**bar.right) if self.log else (bar.left, bar.right)


def histogram_of(rows: Rows, name: str) -> Histogram | None:
    """Return the histogram of a column; none if its values do not vary, or are too many words."""
    if not is_numeric(rows, name):
        return _of_words(rows, name)
    values = varied(rows, name)
    if not values:
        return None
    log = is_logarithmic(values)
    verified = [bool(row["verified"]) for row in rows if is_number(row.get(name))]
    places = [math.log10(value) for value in values] if log else values
    low, width = min(places), max(places) - min(places)
    # Values that differ by rounding belong to one bar.
    shares = [round((place - low) / width, 9) for place in places]
    distinct = sorted(set(shares))
    gap = min(b - a for a, b in pairwise(distinct))
    if 2 * len(distinct) <= len(shares) and gap * MOST_BARS >= 1:
        half = 0.42 * gap
        spans = [(share - half, share + half) for share in distinct]
        slots = {share: i for i, share in enumerate(distinct)}
        placed = [slots[share] for share in shares]
    else:
        count = min(max(round(math.sqrt(len(shares))), BINS[0]), BINS[1])
        spans = [(i / count, (i + 1) / count) for i in range(count)]
        placed = [min(int(share * count), count - 1) for share in shares]
    spans = [(low + left * width, low + right * width) for left, right in spans]
    bars = _counted(spans, zip(placed, verified, strict=True))
    return Histogram(name, log, (), bars, (min(values), max(values)))


def distributions_html(rows: Rows, inputs: Sequence[str]) -> str:
    """Return a section of the report: all columns of numbers, and of words that were swept."""
    names = [name for name in columns(rows, inputs) if name in inputs or is_numeric(rows, name)]
    found = (histogram_of(rows, name) for name in names if name != "number")
    drawn = "".join(_figure(histogram) for histogram in found if histogram is not None)
    if not drawn:
        return ""
    note = "verified" if all(row["verified"] for row in rows) else "verified; orange: failed"
    return (
        f"<h2>Distributions</h2><p>Ribbons for each value, the most at the right of each name; "
        f'blue: {note}.</p><div class="hists">{drawn}</div>'
    )


def _of_words(rows: Rows, name: str) -> Histogram | None:
    known = words(rows, name)
    if not 1 < len(known) <= MOST_WORDS:
        return None
    slots = {word: i for i, word in enumerate(known)}
    placed = [
        (slots[as_text(row[name])], bool(row["verified"]))
        for row in rows
        if not is_missing(row.get(name))
    ]
    spans = [(i - 0.42, i + 0.42) for i in range(len(known))]
    return Histogram(name, False, tuple(known), _counted(spans, placed))


def _counted(
    spans: Sequence[tuple[float, float]], placed: Iterable[tuple[int, bool]]
) -> tuple[Bar, ...]:
    """Bars of given spans; `placed` tells the bar of each ribbon, and whether it is verified."""
    counts = [[0, 0] for _ in spans]
    for slot, verified in placed:
        counts[slot][not verified] += 1
    return tuple(Bar(*span, *count) for span, count in zip(spans, counts, strict=True))


def _figure(histogram: Histogram) -> str:
    bars = histogram.bars
    left, scale = bars[0].left, 100 / (bars[-1].right - bars[0].left)
    most = max(bar.verified + bar.failed for bar in bars)
    drawn = []
    for i, bar in enumerate(bars):
        x, width = scale * (bar.left - left), 0.94 * scale * (bar.right - bar.left)
        good, bad = (HEIGHT * count / most for count in (bar.verified, bar.failed))
        rects = "".join(
            f'<rect class="{kind}" x="{x:.2f}" y="{HEIGHT - top:.2f}" width="{width:.2f}" '
            f'height="{height:.2f}"/>'
            for kind, top, height in (("good", good, good), ("bad", good + bad, bad))
            if height
        )
        low, high = histogram.edges(bar)
        where = histogram.words[i] if histogram.words else f"{low:.4g} to {high:.4g}"
        title = f"{where}: {bar.verified} verified, {bar.failed} failed"
        drawn.append(f"<g><title>{marked_up(title)}</title>{rects}</g>")
    under = histogram.words or [f"{end:.4g}" for end in histogram.ends]
    texts = "".join(f"<span>{marked_up(text)}</span>" for text in under)
    return (
        f"<figure><figcaption><span>{marked_up(histogram.name)}{' (log)' * histogram.log}</span>"
        f'<em>{most}</em></figcaption><svg viewBox="0 0 100 {HEIGHT}" preserveAspectRatio="none">'
        f'{"".join(drawn)}</svg><small class="{"words" * bool(histogram.words)}">{texts}</small>'
        "</figure>"
    )
