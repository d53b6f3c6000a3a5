"""What a plane saves: the clamped elastica to 1e-9, solved in space and with `planar: true`.

Warm: what is built for its structure is kept, and an answer is one solve from the scene's own guess
with its bar. Medians of CPU time, both ways in turn. `planar_case` is a row for tables of what is
skipped; run alone it prints that, and what building, starts, branches and stability take.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

from ribbonopt import Continuation, prepare
from ribbonopt.accuracy.estimate import relative_error
from ribbonopt.checks.stability import second_variation
from ribbonopt.scene import ContinuationStage, Scene, load_scene

CONFIGS = Path(__file__).parents[1] / "configs"
SCENE, FORCE = "elastica_clamped", -45.2259556678  # and its axial force, by elliptic integrals
TOLERANCE, TIMES, FEWER, NEIGHBOURS = 1e-9, 101, 7, 50
WAYS = {"space": False, "plane": True}


def both(name: str = SCENE, **changes: Any) -> dict[str, Scene]:
    """Return a scene of `configs` in space and in its plane, to the same tolerance."""
    scene = load_scene(CONFIGS / f"{name}.yaml")
    ways = {"tolerance": TOLERANCE, "states": "reduced", "continuation": None, **changes}
    return {way: replace(scene, planar=planar, **ways) for way, planar in WAYS.items()}


def medians(work: Mapping[str, Callable[[], object]], times: int) -> dict[str, float]:
    """Return CPU times in ms, medians of some times in turn, by name."""
    found: dict[str, list[float]] = {name: [] for name in work}
    for _ in range(times):
        for name, call in work.items():
            started = time.process_time()
            call()
            found[name].append(time.process_time() - started)
    return {name: 1e3 * float(np.median(values)) for name, values in found.items()}


def planar_case(name: str = SCENE, force: float = FORCE, times: int = TIMES) -> dict[str, Any]:
    """Return how long a warm answer of a scene takes in space and in its plane, and its digits.

    `force` is its axial force, known from elsewhere; digits are those of the worse of both ways.
    """
    prepared = {way: prepare(scene) for way, scene in both(name).items()}
    found = {way: one.solve() for way, one in prepared.items()}
    for solution in found.values():
        assert solution.verified and relative_error(solution)[0] <= TOLERANCE
    off = max(abs(solution.n0[2] / force - 1) for solution in found.values())

    def warm(way: str) -> Callable[[], object]:
        # Without what is kept of a scene that was just solved: from its guess, to its bar.
        return lambda: relative_error(prepared[way].solve_once())

    taken = medians({way: warm(way) for way in WAYS}, times)
    return {
        "scene": name,
        "space_ms": taken["space"],
        "plane_ms": taken["plane"],
        "ratio": taken["space"] / taken["plane"],
        "digits": float(-np.log10(max(off, 1e-16))),
        "load": os.getloadavg()[0],
    }


def neighbours(scene: Scene) -> Callable[[], object]:
    """Return what solves ribbons one after the other, as a batch does."""
    prepared = prepare(scene)
    solved = prepared.solve()

    def work() -> None:
        found = solved
        for shortening in np.linspace(0.25, 0.4, NEIGHBOURS):
            moved = replace(prepared.scene, parameters={"shortening": float(shortening)})
            found = prepared.solve(moved, guess=found)
            assert found.verified

    return work


def cold(scene: Scene) -> Callable[[], object]:
    """Return what builds and solves a scene."""
    return lambda: prepare(scene).solve()


def main() -> None:
    """Print the row, and what else a plane saves."""
    row = planar_case()
    print(", ".join(f"{k} {v:.3g}" if isinstance(v, float) else f"{k} {v}" for k, v in row.items()))
    stage = ContinuationStage("parameters.shortening", to=0.6, stability=False)
    stable = replace(stage, stability=True)
    cases = {
        "cold, guess given": {way: cold(scene) for way, scene in both().items()},
        "cold, from nothing": {way: cold(scene) for way, scene in both(guess="auto").items()},
    }
    cases["50 neighbours"] = {way: neighbours(scene) for way, scene in both().items()}
    named = {"branch": stage, "branch with stability": stable}
    for words, one in named.items():
        scenes = both(continuation=one)
        cases[words] = {way: lambda s=scene: list(Continuation(s)) for way, scene in scenes.items()}
    solved = {way: prepare(scene) for way, scene in both().items()}
    cases["stability"] = {
        way: lambda p=one: second_variation(p.solve_once()) for way, one in solved.items()
    }
    for words, work in cases.items():
        taken = medians(work, FEWER)
        ratio = taken["space"] / taken["plane"]
        times = f"{taken['space']:.3g} ms in space, {taken['plane']:.3g} in its plane"
        print(f"{words}: {times}, {ratio:.2f}")


if __name__ == "__main__":
    main()
