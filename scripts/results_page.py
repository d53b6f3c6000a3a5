"""A page of results for a release, from the JSON that the benchmarks have written.

    python scripts/results_page.py [--results results] [--out docs/results]

Reads `accuracy/half.json`, `accuracy/whole.json`, `accuracy/bars.json` (`bench_accuracy.py`),
`compiled/compiled.json` (`bench_compiled.py --peers`) and `bench_starts/bench_starts.json`
(`bench_starts.py`); what is not there is left out. Writes VERSION.md, the version being that of the
package, and its figures beside it. No figure of it is written by hand: for the next release run the
benchmarks and then this.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import results_tables as tables

from ribbonopt.version import VERSION
from ribbonopt.views.comparison import save_figure

FILES = {
    "half": "accuracy/half.json",
    "whole": "accuracy/whole.json",
    "bars": "accuracy/bars.json",
    "compiled": "compiled/compiled.json",
    "starts": "bench_starts/bench_starts.json",
}
RIBBONS = {
    "half": "Half a Möbius ribbon, Sadowsky's law",
    "whole": "Whole Möbius ribbon, (6.1), ε = 0.01",
}


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--out", type=Path, default=Path("docs") / "results")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    found, figures = {}, {}
    for name, place in FILES.items():
        path = options.results / place
        if not path.is_file():
            print(f"{path} is not there: that part is left out")
            continue
        found[name] = json.loads(path.read_text(encoding="utf-8"))
        if name in RIBBONS:
            figures[name] = f"{VERSION}-{name}.png"
            save_figure(found[name], options.out / figures[name])
    if not found:
        raise SystemExit(f"{options.results}: no results to make a page of")
    path = options.out / f"{VERSION}.md"
    path.write_text(page(found, figures), encoding="utf-8")
    print(f"written: {path}, {', '.join(figures.values())}")


def page(found: dict[str, Any], figures: dict[str, str]) -> str:
    """Return the page as Markdown."""
    parts = [
        f"# Results of ribbonopt {VERSION}",
        "Made by `scripts/results_page.py` from what the benchmarks wrote; nothing here is written"
        " by hand.\nHow it is measured, and what peers are given: [docs/speed.md](../speed.md).",
        tables.conditions(found),
    ]
    studies = {name: found[name] for name in RIBBONS if name in found}
    if studies:
        parts += ["## The one to beat", tables.leader(studies)]
    for name, study in studies.items():
        parts += [f"## {RIBBONS[name]}: CPU against error", tables.ladder(study)]
        if name in figures:
            parts.append(f"![{RIBBONS[name]}: CPU against error]({figures[name]})")
        parts.append(tables.orders(study))
    if "bars" in found:
        parts += ["## An answer with its bar, step by step", tables.steps(found["bars"])]
    if "compiled" in found:
        parts += ["## The branch, and ours with its kernel and without"]
        parts += [tables.compiled(found["compiled"])]
    if "starts" in found and "noise" in found["starts"]:
        parts += ["## Noise on the start", tables.noise(found["starts"])]
    return "\n\n".join(part for part in parts if part) + "\n"


if __name__ == "__main__":
    main()
