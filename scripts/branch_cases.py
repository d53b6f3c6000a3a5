"""Branches that benchmarks follow: scenes, and what they are to cost.

Run as a program it follows them, with the package that Python finds first: a name of `CASES` in a
line of the input, an answer as JSON in a line of the output. What is built is kept, as it is where
many branches of a kind are followed.

    PYTHONPATH=CHECKOUT python scripts/branch_cases.py
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

from stopwatches import stopwatches

CONFIGS = Path(__file__).resolve().parent.parent / "configs"

HALF = (CONFIGS / "moebius_half.yaml").read_text(encoding="utf-8")
WHOLE = (CONFIGS / "moebius_regularized.yaml").read_text(encoding="utf-8")
CLAMP = """
name: turned-clamp
law: {type: variational, delta: 0.3}
parameters: {angle: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0.1, 0, 0.6], directors: {turns: [{z: angle*deg}]}}
transcription: {type: collocation, scheme: gauss, degree: 4, intervals: 80}
continuation: {parameter: parameters.angle, from: 10, to: 90, largest: 3}
"""
ARCH = """
name: sheared-arch
law: {type: kirchhoff, B2: 1, B3: 1.3333333333333333}
parameters: {shear: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, shear, 0.6875], directors: identity}
guess: {force: [0, 0, -46.97375812], moment: [0, 7.49816358, 0]}
tolerance: 1e-8
record: {middle: "dot(r, ex) at 0.5"}
continuation: {parameter: parameters.shear, from: 0, to: 0.6, largest: 0.02, stop: [middle < 0.001]}
"""
ROTATION = """
name: clamped-rotation
law: {type: sadowsky}
parameters: {angle: 0, shortening: 0.3}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 1 - shortening], directors: {turns: [{z: angle*deg}]}}
tolerance: 1e-8
continuation: {parameter: parameters.angle, from: 0, to: 180, largest: 10}
"""


class Case(NamedTuple):
    """A scene in YAML, what is set in it, and the CPU it may take: seconds, or ms a point."""

    scene: str
    settings: tuple[str, ...] = ()
    seconds: float | None = None
    point_ms: float | None = None


CASES = {
    "half Moebius, epsilon 0.1 to 1e-4": Case(
        HALF,
        (
            "law={type: regularized, epsilon: 0.1}",
            "continuation={parameter: law.epsilon, to: 1e-4, scale: log, largest: 0.15}",
            *("tolerance=2e-9", "transcription.degree=6", "transcription.intervals=8"),
        ),
        seconds=0.25,
    ),
    "whole Moebius, epsilon 0.1 to 1e-8": Case(
        WHOLE,
        (
            "continuation={parameter: law.epsilon, from: 0.1, to: 1e-8, scale: log, largest: 0.28}",
            *("tolerance=1e-8", "transcription.degree=8", "transcription.intervals=10"),
        ),
        seconds=0.5,
    ),
    "clamp turned, stability on 80 elements": Case(CLAMP, point_ms=25),
    "rod arch sheared": Case(ARCH),
    "Sadowsky, clamp turned to 180": Case(ROTATION),
}


class Followed:
    """The branches of this package, each with what was built for it."""

    def __init__(self) -> None:
        """Build nothing yet."""
        self._built: dict[str, Any] = {}

    def follow(self, name: str) -> dict[str, Any]:
        """Follow a branch: seconds, points, what was found, and where the seconds went."""
        from ribbonopt.scene import loads_scene
        from ribbonopt.studies.continuation.continuation import Continuation

        case = CASES[name]
        scene = loads_scene(case.scene, overrides=list(case.settings))
        with stopwatches(_watched()) as spent_on:
            wall, cpu = time.perf_counter(), time.process_time()
            continuation = Continuation(scene, self._built.get(name))
            rows = [point.row for point in continuation]
            seconds = {"cpu_s": time.process_time() - cpu, "wall_s": time.perf_counter() - wall}
        self._built[name] = continuation.prepared
        parts: dict[str, float] = {}
        for label, spent in spent_on:
            parts[label] = parts.get(label, 0.0) + spent
        last = rows[-1]
        return seconds | {
            "parts_s": parts,
            "points": len(rows),
            "reached": continuation.ending.reached,
            "ending": continuation.ending.reason,
            "special": [row["kind"] for row in rows if row["kind"] != "point"],
            "counted": sum(row["negative"] is not None for row in rows),
            "largest_error": max(row["error"] or 0.0 for row in rows if row["kind"] == "point"),
            "loads": [last[f"{load}0{x}"] for load in "nm" for x in "xyz"],
        }


def _watched() -> list[tuple[Any, str, str]]:
    """Return what clocks are put on: all of it that this package has."""
    from ribbonopt.accuracy import estimate
    from ribbonopt.checks import stability
    from ribbonopt.solvers.newton import NewtonSolver
    from ribbonopt.studies.continuation.walk import steps

    watched = (
        (NewtonSolver, "solve", "Newton"),
        (steps, "near", "tangents"),
        (estimate, "_analysed", "estimates"),
        (steps, "special_points", "special points"),
        (stability, "second_variation", "stability"),
    )
    return [entry for entry in watched if hasattr(*entry[:2])]


def main() -> None:
    """Answer line by line."""
    followed = Followed()
    for line in sys.stdin:
        print(json.dumps(followed.follow(line.rstrip("\n"))), flush=True)


if __name__ == "__main__":
    main()
