"""What the compiled kernel and lighter Python bring: CPU time against an older checkout and peers.

    python scripts/bench_compiled.py [--before CHECKOUT] [--peers] [--turns 9]
        [--only half whole ...] [--out results/compiled]

Contenders are this checkout with its kernel and without (`RIBBONOPT_KERNEL=off`), the checkout
before, and with `--peers` what is found of COLNEW, AUTO, CasADi's rootfinder and scipy's solve_bvp.
Each has a process of its own, in which all is built before it is timed; they take turns in one run,
and all that is told is a median of turns, so that ratios hold on a noisy machine. The ratio of a
turn is the CPU of the checkout before over that of this one. Answers of all checkouts must agree
within their tolerance, and all be verified; where ribbons have several equilibria, it is counted
how many have another energy. Errors are against the references below. Writes
`compiled.json` and `compiled.png`.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring, for all contenders.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

from compiled_cases import CASES
from compiled_figure import draw
from peer_states import HALF, WHOLE
from results_machine import conditions

from ribbonopt.studies.machine import machine

ROOT = Path(__file__).resolve().parent.parent
BEFORE, WITH, WITHOUT = "before", "with kernel", "without"
# epsilon = 1e-4: this package to 1e-12 and COLNEW to 1e-9 agree to 3e-14.
LAST = [0, 43.491515795830, 42.062655833544, 0, 2.0069761447399, -8.8666016238828]
# name: answers in a turn, tolerance, ratios wanted with the kernel and without, reference
ROWS: dict[str, tuple[int, float, float, float, list[float] | None]] = {
    "half 1e-6": (8, 1e-6, 3.5, 1.5, HALF),
    "half 1e-9": (8, 1e-9, 3.5, 1.5, HALF),
    "half 1e-12": (8, 1e-12, 3.0, 1.5, HALF),
    "whole 1e-9": (2, 1e-9, 4.0, 1.8, WHOLE),
    "branch": (1, 2e-9, 2.5, 1.2, LAST),
    "batch half 1e-8": (1, 1e-8, 2.5, 1.3, None),
    "batch clamps 1e-6": (1, 1e-6, 2.2, 1.2, None),
    "clamp from nothing": (2, 1e-6, 2.0, 1.2, None),
}
assert tuple(ROWS) == CASES

Found = dict[str, Any]
Ask = Callable[[str, int, int], Found]


class Checkout:
    """A process that works with the package of a checkout."""

    def __init__(self, label: str, path: Path, kernel: bool) -> None:
        """Start it; without a package there Python would take the one that is installed."""
        if not (path / "ribbonopt").is_dir():
            raise SystemExit(f"--before: found {path}, expected a folder that has ribbonopt/")
        environment = os.environ | {"PYTHONPATH": str(path.resolve())}
        environment.pop("RIBBONOPT_KERNEL", None)
        if not kernel:
            environment["RIBBONOPT_KERNEL"] = "off"
        self._label = label
        self._process = subprocess.Popen(
            [sys.executable, str(ROOT / "scripts" / "compiled_cases.py")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        self.versions: dict[str, str] = self._answer("starting")

    @property
    def process(self) -> int:
        """Number of the process."""
        return self._process.pid

    def ask(self, name: str, count: int, turn: int) -> Found:
        """Do the work of a case so many times."""
        assert self._process.stdin is not None
        print(json.dumps([name, count, turn]), file=self._process.stdin, flush=True)
        return self._answer(name)

    def close(self) -> None:
        """End it."""
        self._process.communicate()

    def _answer(self, what: str) -> Found:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise SystemExit(f"{what}: the process of '{self._label}' has ended, as said above")
        found: Found = json.loads(line)
        return found


def main() -> None:
    """Measure, print, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", type=Path, help="an older checkout of this package")
    parser.add_argument("--peers", action="store_true", help="the peers as well")
    parser.add_argument("--turns", type=int, default=9)
    parser.add_argument("--only", nargs="+", default=[""], help="cases whose names begin so")
    parser.add_argument("--out", type=Path, default=Path("results") / "compiled")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    checkouts = {WITH: Checkout(WITH, ROOT, True), WITHOUT: Checkout(WITHOUT, ROOT, False)}
    if options.before:
        checkouts[BEFORE] = Checkout(BEFORE, options.before, True)
    peers: dict[str, dict[str, Ask]] = {}
    if options.peers:
        from compiled_peers import peers_found

        peers = peers_found()
    result: dict[str, Any] = {
        "machine": machine(),
        "versions": {label: checkout.versions for label, checkout in checkouts.items()},
        "before": str(options.before) if options.before else None,
        "turns": options.turns,
        "load_before": os.getloadavg(),
        "rows": {},
    } | conditions()
    for name in (name for name in CASES if name.startswith(tuple(options.only))):
        asks = {label: checkout.ask for label, checkout in checkouts.items()}
        runs = interleaved(name, asks | peers.get(name, {}), options.turns)
        result["rows"][name] = summary(name, runs)
        report(name, result["rows"][name])
    for checkout in checkouts.values():
        checkout.close()
    result["load_after"] = os.getloadavg()
    print(f"load {result['load_before'][0]:.2f} before, {result['load_after'][0]:.2f} after")
    print("\n".join(f"{label}: {found}" for label, found in result["versions"].items()))
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "compiled.json").write_text(text, encoding="utf-8")
    draw(result["rows"], options.out / "compiled.png")
    print(f"written: {options.out}: compiled.json, compiled.png")


def interleaved(name: str, asks: dict[str, Ask], turns: int) -> dict[str, list[Found]]:
    """Ask by turns, every other one the other way round; the first turn, which builds, is off."""
    count = ROWS[name][0]
    runs: dict[str, list[Found]] = {label: [] for label in asks}
    for turn in range(turns + 1):
        for label, ask in list(asks.items())[:: 1 if turn % 2 else -1]:
            if turn:
                runs[label].append(ask(name, count, turn))
            else:
                ask(name, 1, turn)
    return runs


def summary(name: str, runs: dict[str, list[Found]]) -> Found:
    """Return medians, ratios, errors, and how far the checkouts are from each other."""
    _, tolerance, wanted, wanted_without, truth = ROWS[name]
    result: Found = {"wanted": {WITH: wanted, WITHOUT: wanted_without}, "contenders": {}}
    for label, found in runs.items():
        one = {
            "ms": 1e3 * statistics.median(run["cpu_s"] for run in found),
            "ms_least": 1e3 * min(run["cpu_s"] for run in found),
            "verified": all(run.get("verified", True) for run in found),
        }
        one |= {key: found[-1][key] for key in ("bar", "points") if key in found[-1]}
        if truth is not None:
            one["error"] = max(apart(run["numbers"], truth) for run in found)
        if BEFORE in runs and label != BEFORE:
            pairs = zip(runs[BEFORE], found, strict=True)
            ratios = sorted(a["cpu_s"] / b["cpu_s"] for a, b in pairs)
            one["ratio"] = statistics.median(ratios)
            one["ratios"] = [ratios[len(ratios) // 4], ratios[-1 - len(ratios) // 4]]
        result["contenders"][label] = one
    ours = [runs[label] for label in (BEFORE, WITH, WITHOUT) if label in runs]
    pairs = [pair for other in ours[1:] for pair in zip(ours[0], other, strict=True)]
    if truth is None:
        result["energies"] = energies(pairs, tolerance)
    else:
        result["apart"] = max(apart(b["numbers"], a["numbers"]) for a, b in pairs)
        result["agree"] = result["apart"] <= 2 * tolerance
    return result


def energies(pairs: list[tuple[Found, Found]], tolerance: float) -> dict[str, int]:
    """Count energies against those of the first checkout: many clamps have several equilibria."""
    counts = {"same": 0, "lower": 0, "higher": 0}
    for first, other in pairs:
        for a, b in zip(first["numbers"], other["numbers"], strict=True):
            same = abs(b - a) <= 2 * tolerance * abs(a)
            counts["same" if same else "lower" if b < a else "higher"] += 1
    return counts


def apart(numbers: list[float], truth: list[float]) -> float:
    """Largest difference, relative to the largest of the numbers."""
    return max(abs(a - b) for a, b in zip(numbers, truth, strict=True)) / max(map(abs, truth))


def report(name: str, row: Found) -> None:
    """Print a row: a line for each contender."""
    if "energies" in row:
        counts = ", ".join(f"{count} {word}" for word, count in row["energies"].items())
        print(f"{name}: energies against the first checkout: {counts}")
    else:
        agree = "" if row["agree"] else "; THEY DO NOT AGREE"
        print(f"{name}: checkouts differ by {row['apart']:.1e}{agree}")
    for label, one in row["contenders"].items():
        text = f"  {label:<22} {one['ms']:9.3f} ms (least {one['ms_least']:.3f})"
        if "ratio" in one:
            low, high = one["ratios"]
            text += f"  {one['ratio']:.2f} x as fast as before [{low:.2f}, {high:.2f}]"
        if label in row["wanted"]:
            text += f", wanted {row['wanted'][label]:g}"
        if name.startswith("batch"):
            text += f"; {1e3 / one['ms']:.0f} ribbons/s a core"
        text += "".join(f"; {k} {one[k]:.1e}" for k in ("error", "bar") if k in one)
        print(text + ("" if one["verified"] else "; NOT VERIFIED"), flush=True)


if __name__ == "__main__":
    main()
