"""Bars of the energy formulation: random clamps by it and by the inverted form.

    python scripts/energy_bars.py --law wunderlich --width 0.05 --count 20 --tolerance 1e-3

Prints a row for each clamp: elements, relative error bound, and by quantity the difference of both
over the sum of their bars, which must not exceed 1. Where both find different equilibria nothing is
compared.
"""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np
from starts_clamps import clamps

from ribbonopt.accuracy.estimate import estimate_error, relative_error
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import Law, Sadowsky, Scene, Variational, Wunderlich
from ribbonopt.solution.solution import Solution

TRUTH = 1e-10  # tolerance of the inverted form
OTHER = 1e-3  # difference of the energies, relative, of other equilibria
POINTS = 201


def both(scene: Scene, tolerance: float) -> tuple[Solution, Solution]:
    """Return the answers of the energy form, with a tolerance, and of the inverted form."""
    scene = replace(scene, states="reduced")
    minimum = replace(scene, formulation="energy", tolerance=tolerance)
    return prepare(minimum).solve(), prepare(replace(scene, tolerance=TRUTH)).solve()


def shares(ours: Solution, theirs: Solution) -> dict[str, float]:
    """Return by quantity the difference of two answers over the sum of their bars."""
    s = np.linspace(*ours.scene.interval, POINTS)
    places = [np.hstack([x.sample(s, k) for k in ("r", "d1", "d2", "d3")]) for x in (ours, theirs)]
    values = [
        {"n0": x.n0, "m0": x.m0, "u0": x.u0, "H0": x.start["H"], "energy": x.energy, "states": p}
        for x, p in zip((ours, theirs), places, strict=True)
    ]
    bars = [estimate_error(x) for x in (ours, theirs)]
    return {
        name: float(np.abs(values[0][name] - values[1][name]).max()) / sum(b[name] for b in bars)
        for name in values[0]
    }


def main() -> None:
    """Print a row for each clamp and the worst of all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--law", choices=("wunderlich", "sadowsky", "variational"), required=True)
    parser.add_argument("--width", type=float, default=0.05)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--tolerance", type=float, default=1e-3)
    asked = parser.parse_args()
    laws: dict[str, Law] = {
        "wunderlich": Wunderlich(width=asked.width),
        "sadowsky": Sadowsky(),
        "variational": Variational(delta=0.01),
    }
    worst: dict[str, float] = {}
    for seed in range(asked.first, asked.first + asked.count):
        scene = replace(clamps(seed), law=laws[asked.law])
        scene = replace(scene, transcription=replace(scene.transcription, intervals=20))
        ours, theirs = both(scene, asked.tolerance)
        if ours.coarser is None or not theirs.verified:
            print(seed, "not solved:", ours.status.name, theirs.status.name, flush=True)
            continue
        words = f"{ours.status.name} {sum(ours.mesh.elements)} {relative_error(ours)[0]:.1e}"
        if abs(ours.energy - theirs.energy) > OTHER * abs(theirs.energy):
            print(seed, words, "another equilibrium", ours.energy, theirs.energy, flush=True)
            continue
        found = shares(ours, theirs)
        worst = {name: max(worst.get(name, 0.0), share) for name, share in found.items()}
        print(seed, words, {name: float(f"{v:.2g}") for name, v in found.items()}, flush=True)
    print("worst", worst)


if __name__ == "__main__":
    main()
