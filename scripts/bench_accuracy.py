"""CPU time against error on Moebius ribbons: ours, and peers on 18 and on 13 states.

    python scripts/bench_accuracy.py [--out results/accuracy] [--ribbon half whole] [--repeat 11]
        [--all] [--quick]

The half ribbon by Sadowsky's law and the whole one by (6.1), epsilon = 0.01; interleaved rounds,
medians; errors relative to the references of `peer_states.py`. Ours are the inverted form by Gauss
points on fixed meshes (`--all`: every pair), and the whole path to a tolerance with its bars. Peers
are those of `peer_contenders.py`: solve_bvp, CasADi with IPOPT and with its own Newton, AUTO and
COLNEW where they are found. Writes `half.csv`, `half.json` (with machine, versions and what is
missing), `half.png`, the same of `whole`, and, what an answer with its error bar costs step by
step, `bars.json` (`accuracy_bars.py`). `results_page.py` makes a page of it.
"""

from __future__ import annotations

import argparse
import json
import os
from dataclasses import dataclass
from pathlib import Path

# Small matrices: threads of the linear algebra cost more than they bring, for all contenders.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import accuracy_bars
from peer_contenders import SCENES, STARTED, contenders
from peer_states import HALF, WHOLE
from results_machine import conditions

from ribbonopt.scene import load_scene
from ribbonopt.studies.comparison.benchmark import benchmark
from ribbonopt.studies.comparison.files import save_study
from ribbonopt.studies.comparison.table import table
from ribbonopt.studies.comparison.truth import SourcedLoads
from ribbonopt.views.comparison import save_figure


@dataclass(frozen=True)
class Part:
    """One ribbon, and what its reference is."""

    whole: bool
    truth: list[float]
    source: str


PARTS = {
    "half": Part(False, HALF, "28 digits by Taylor series"),
    "whole": Part(True, WHOLE, "21 digits of the half-interval solution of the same law"),
}
BEST = ("inverted",), ("gauss",)  # formulation and transcription that peers are to be set beside


def main() -> None:
    """Run, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "accuracy")
    parser.add_argument("--ribbon", nargs="+", choices=tuple(PARTS), default=list(PARTS))
    parser.add_argument("--repeat", type=int, default=11)
    parser.add_argument("--quick", action="store_true", help="fewer pairs, meshes and peers")
    parser.add_argument("--all", action="store_true", help="every pair of ours, for half an hour")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    bars = accuracy_bars.bench_bars(options.repeat)
    accuracy_bars.report(bars)
    (options.out / "bars.json").write_text(json.dumps(bars, indent=2) + "\n", encoding="utf-8")
    for name in options.ribbon:
        run(name, PARTS[name], options)


def run(name: str, part: Part, options: argparse.Namespace) -> None:
    """Time one ribbon, print its table and write its files."""
    missing: dict[str, str] = {}
    out, quick = options.out, options.quick
    peers = contenders(part.whole, quick, missing)
    for peer, why in missing.items():
        print(f"{peer} is not run: {why}")
    study = benchmark(
        load_scene(SCENES[part.whole], [STARTED]),
        *((None, None) if options.all else BEST),
        repeat=options.repeat,
        quick=quick,
        reference=SourcedLoads(tuple(part.truth[:3]), tuple(part.truth[3:]), part.source),
        peers=peers,
    )
    print(table(study))
    save_study(study, out, name)
    path = out / f"{name}.json"
    found = json.loads(path.read_text(encoding="utf-8")) | {"missing": missing}
    path.write_text(json.dumps(found | conditions(), indent=2) + "\n", encoding="utf-8")
    save_figure(study.plain(), out / f"{name}.png")
    print(f"written: {out}: {name}.csv, {name}.json, {name}.png", flush=True)


if __name__ == "__main__":
    main()
