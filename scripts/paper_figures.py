"""Figures 2 to 5 of the paper, each panel above its numbers, and the paper's misprints.

    python scripts/paper_figures.py [--out results/paper]

Neukirch & Audoly, A convenient formulation of Sadowsky's model for elastic ribbons. From the scenes
of `configs/paper`: `figure2.png` to `figure5.png` (and `.pdf`), the curves of figures 4 and 5 as
`figure4.csv`, `figure5.csv`, all numbers as `numbers.json` and `.csv`, the misprints with the
demonstration of each as `misprints.json` and `.csv`. See docs/paper.md.
"""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from paper import figure2, figure3, figure4, figure5
from paper.found import Found
from paper.misprints import misprints, write_misprints
from paper.numbers import Table, write_columns, write_numbers
from paper.page import Panel, draw_page, tables

ROOT = Path(__file__).resolve().parents[1]


def main() -> None:
    """Solve, draw and write all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "paper")
    folder = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    begin = time.perf_counter()
    found = Found()
    collected: list[Table] = []
    for name, title, panels in drawn(found):
        draw_page(title, panels, folder / name)
        collected += tables(name, panels)
        print(f"{time.perf_counter() - begin:5.1f} s  {folder / name}.png, .pdf")
    write_numbers(collected, folder)
    write_columns(figure4.columns(found), folder / "figure4.csv")
    write_columns(figure5.columns(found), folder / "figure5.csv")
    write_misprints(misprints(found), folder)
    print(f"{time.perf_counter() - begin:5.1f} s  numbers and misprints, as .json and .csv")


def drawn(found: Found) -> list[tuple[str, str, list[Panel]]]:
    """Return file name, title and panels of each figure."""
    return [
        ("figure2", figure2.TITLE, figure2.panels()),
        ("figure3", figure3.TITLE, figure3.panels()),
        ("figure4", figure4.TITLE, figure4.panels(found)),
        ("figure5", figure5.TITLE, figure5.panels(found)),
    ]


if __name__ == "__main__":
    main()
