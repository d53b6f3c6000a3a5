"""What answers and bars of many random clamps are worth: shares, worst offenders, figure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

Row = dict[str, Any]
ROUNDING = 1e-13  # of a size of 1 to 100: true errors below are taken to be as large
WORST = 40
COLOURS = {"sadowsky": "#c2410c", "regularized": "#2f7d32", "variational": "#1f5fa8"}


def judged(row: Row) -> list[Row]:
    """Return what is to be said of every quantity of an answer.

    `holds`: the truth is inside the bar, None where the truth's own error leaves it open;
    `tight`: the bar is at most ten times the true error; both None where the bar is not known.
    """
    result = []
    for name, (true, bar, own) in row.get("quantities", {}).items():
        words: Row = {k: row[k] for k in ("law", "tolerance", "clamp", "status")}
        words |= {"quantity": name, "true": true, "bar": bar, "own": own, "known": bar is not None}
        holds = tight = None
        if bar is not None:
            tight = bar <= 10 * max(true, own, ROUNDING)
            if true + own <= bar or (true <= bar and own <= true / 10):
                holds = True
            elif true - own > bar:
                holds = False
        result.append(words | {"holds": holds, "tight": tight})
    return result


def summarised(rows: Sequence[Row]) -> Row:
    """Return shares of answers and bars, and the cost."""
    status = Counter(row["status"] for row in rows)
    verdicts = Counter(row["verdict"] for row in rows)
    every = [q for row in rows for q in judged(row)]
    bounded = [q["holds"] for q in every if q["holds"] is not None]
    tight = [q["tight"] for q in every if q["tight"] is not None]
    seconds = [row["seconds"] for row in rows]
    refuted = [_place(row) for row in rows if row["verdict"] in ("none", "elsewhere")]
    labelled = status["REGULARIZED"] + status["TOLERANCE_MISSED"]
    return {
        "answers": len(rows),
        "exact": _share(status["CONVERGED"], len(rows)),
        "solved, labelled ones too": _share(status["CONVERGED"] + labelled, len(rows)),
        "status": dict(status),
        "verdicts": dict(verdicts),
        "refuted": refuted,
        "undecided": [f"{_place(r)}: {r['reason']}" for r in rows if r["verdict"] == "undecided"],
        "unsolved": [f"{_place(r)}: {r['message']}" for r in rows if r["verdict"] == "unsolved"],
        "bars that hold": _share(sum(bounded), len(bounded)),
        "bars within 10 times the truth": _share(sum(tight), len(tight)),
        "bars not known": _share(sum(not q["known"] for q in every), len(every)),
        "left open by the truth": sum(q["known"] and q["holds"] is None for q in every),
        "seconds, 50 % 95 % 100 %": np.quantile(seconds, (0.5, 0.95, 1)).round(4).tolist(),
    }


def by_quantity(rows: Sequence[Row]) -> Row:
    """Return shares by quantity: bars that hold, bars that are tight."""
    every = [q for row in rows for q in judged(row) if q["known"]]
    result = {}
    for name in dict.fromkeys(q["quantity"] for q in every):
        some = [q for q in every if q["quantity"] == name]
        holds = [q["holds"] for q in some if q["holds"] is not None]
        result[name] = {
            "holds": _share(sum(holds), len(holds)),
            "tight": _share(sum(q["tight"] for q in some), len(some)),
        }
    return result


def offenders(rows: Sequence[Row]) -> tuple[list[Row], list[Row]]:
    """Bars that are too small, the worst first, and those that are too large."""
    every = [q for row in rows for q in judged(row)]
    small = [q for q in every if q["holds"] is False]
    large = [q for q in every if q["tight"] is False]
    small.sort(key=lambda q: -q["true"] / q["bar"])
    large.sort(key=lambda q: -q["bar"] / max(q["true"], q["own"], ROUNDING))
    return small, large


def report(rows: Sequence[Row]) -> Row:
    """Print all of it; return it by law and tolerance, and of all together."""
    result: Row = {}
    for law, tolerance in dict.fromkeys((r["law"], r["tolerance"]) for r in rows):
        some = [r for r in rows if (r["law"], r["tolerance"]) == (law, tolerance)]
        result[f"{law} {tolerance:g}"] = summarised(some) | {"by quantity": by_quantity(some)}
    result["all"] = summarised(rows) | {"by quantity": by_quantity(rows)}
    for name, words in result.items():
        print(f"== {name}")
        for key, value in words.items():
            print(f"   {key}: {value}")
    small, large = offenders(rows)
    result |= {"too small": small[:WORST], "too large": large[:WORST]}
    for title, some in (("too small", small), ("more than 10 times too large", large)):
        print(f"== {len(some)} bars {title}; law, tolerance, clamp, quantity: true / bar (truth's)")
        for q in some[:WORST]:
            place = f"{q['law']:<12}{q['tolerance']:<6g}{q['clamp']:4} {q['quantity']:<20}"
            print(f"   {place} {q['true']:.2e} / {q['bar']:.2e} ({q['own']:.0e}) {q['status']}")
    return result


def draw(rows: Sequence[Row], path: Path) -> None:
    """Draw bars against true errors, a colour for each law."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 6), layout="constrained")
    axes = figure.subplots()
    FigureCanvasAgg(figure)
    ends = np.array([1e-16, 1e-1])
    axes.fill_between(ends, ends, ends * 10, color="#dddddd", lw=0, label="bound within 10")
    axes.loglog(ends, ends, color="#777777", lw=1)
    every = [q for row in rows for q in judged(row) if q["known"]]
    for law, colour in COLOURS.items():
        pairs = [(q["true"], q["bar"]) for q in every if q["law"] == law]
        true, bar = np.maximum(np.array(pairs).reshape(-1, 2), 2e-16).T
        axes.plot(true, bar, "o", ms=2, mew=0, alpha=0.5, color=colour, label=law)
    axes.set(xlim=ends, ylim=ends, xlabel="true error", ylabel="estimated error")
    axes.legend(frameon=False, loc="upper left")
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=150)


def _share(count: int, of: int) -> str:
    return f"{100 * count / of:.2f} % ({count} of {of})" if of else "none"


def _place(row: Row) -> str:
    return f"{row['law']} {row['tolerance']:g} clamp {row['clamp']}"
