"""Figure 5d of the paper: u2(0) as epsilon or delta goes to zero, for the whole Moebius ribbon.

    python scripts/figure_continuation.py [--out scripts/figures/continuation.png]

Prints the orders in which u2(0) goes to its limit; the variational law on the half ribbon.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from branch_cases import CASES, HALF

from ribbonopt.scene import loads_scene
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.recorded import value_of

LIMIT = 3.38657617297834557330  # u2(0) of Sadowsky's ribbon, 28 digits (SCIENCE, section 5)
EPSILON = CASES["whole Moebius, epsilon 0.1 to 1e-8"]
DELTA = (
    "law={type: variational, delta: 0.1}",
    "continuation={parameter: law.delta, to: 1e-3, scale: log, stability: false}",
    "tolerance=1e-8",
)


def main() -> None:
    """Follow both branches, print the orders, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("scripts/figures/continuation.png"))
    options = parser.parse_args()
    epsilon, delta = rows(EPSILON.scene, EPSILON.settings), rows(HALF, DELTA)
    print(
        f"u2(0) against its limit: order {slope(epsilon, 1e-8):.3f} in epsilon, "
        f"{slope(delta, 1e-8):.2f} in delta"
    )
    draw(epsilon, delta, options.out)
    print(f"written: {options.out}")


def rows(scene: str, settings: tuple[str, ...]) -> list[dict[str, Any]]:
    """Follow a branch to its end."""
    continuation = Continuation(loads_scene(scene, overrides=settings))
    found = [dict(point.row) for point in continuation]
    assert continuation.ending.reached, continuation.ending.reason
    return found


def slope(rows: list[dict[str, Any]], least: float) -> float:
    """Order of u2(0) - limit in the parameter, from the smaller half of its values."""
    rows = [row for row in rows if row["kind"] == "point"]
    pairs = [(value_of(row), abs(row["u2"] - LIMIT)) for row in rows[len(rows) // 2 :]]
    known = np.log([pair for pair in pairs if pair[1] > 10 * least * LIMIT])
    return float(np.polyfit(known[:, 0], known[:, 1], 1)[0])


def draw(epsilon: list[dict[str, Any]], delta: list[dict[str, Any]], path: Path) -> None:
    """Draw Figure 5d: u2(0) against both parameters, and the distance from the limit."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    curves = (
        (epsilon, "o-", "#1f5fa8", "eq. (6.1), epsilon"),
        (delta, "s-", "#c0501a", "variational, delta"),
    )
    for rows, mark, colour, label in curves:
        values = np.array([(value_of(row), row["u2"]) for row in rows if row["kind"] == "point"])
        left.semilogx(*values.T, mark, ms=3.5, color=colour, label=label)
        gap = np.abs(values[:, 1] - LIMIT)
        right.loglog(values[:, 0], gap, mark, ms=3.5, color=colour, label=label)
    left.axhline(LIMIT, color="0.5", lw=0.8, ls="--", label="Sadowsky")
    left.set(xlabel="epsilon or delta", ylabel="u2(0)", title="Moebius ribbon, Figure 5d")
    right.set(xlabel="epsilon or delta", ylabel="|u2(0) - limit|", title="distance from the limit")
    for axes in (left, right):
        axes.grid(True, which="major", alpha=0.3)
        axes.legend()
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
