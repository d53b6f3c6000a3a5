"""What a piece saves where symmetry repeats the rest, in CPU time: `symmetry_case()` measures it.

Whole and piece are solved in turns, each from its scene alone, everything built anew; medians.
"""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from ribbonopt import Scene, load_scene, solve
from ribbonopt.problem import Posed
from ribbonopt.scene import Boundary, Loop
from ribbonopt.starts import automatic

CONFIGS = Path(__file__).parents[1] / "configs"
REPEATS = 7
BANDS = ("moebius_whole", "band_three_whole", "band_five_whole")
LAWS = (
    "{type: variational, delta: 0.01}",
    "{type: sadowsky}",
    "{type: regularized, epsilon: 0.01}",
)
ARCH = ("shear/arch", ["guess=auto", "continuation=null", "parameters.shear=0.1"])


def symmetry_case(repeats: int = REPEATS) -> list[dict[str, Any]]:
    """Return a row for each scene: the whole, the piece, and their times in ms."""
    rows = []
    for name in BANDS:
        for law in LAWS:
            scene = load_scene(CONFIGS / f"{name}.yaml", [f"law={law}", "tolerance=1e-8"])
            loop = scene.boundary.loop
            assert loop is not None
            auto = replace(scene, boundary=Boundary(loop=Loop(loop.half_twists, "auto")))
            rows.append(_row(f"{name}, {scene.law.type}", scene, auto, repeats))
    arch = load_scene(CONFIGS / f"{ARCH[0]}.yaml", ARCH[1])
    rows.append(_row("sheared arch", arch, replace(arch, symmetric="d1"), repeats))
    return rows


def starts_case(repeats: int = REPEATS) -> list[dict[str, Any]]:
    """Return a row for each band: started by least energy, and by Newton's method from a circle."""
    rows = []
    for name in BANDS:
        scene = load_scene(CONFIGS / f"{name}.yaml", ["tolerance=1e-8"])
        newton = automatic.newton_suffices

        def least(scene: Scene = scene, newton: Any = newton) -> Any:
            automatic.newton_suffices = lambda *parts: False
            try:
                return solve(scene)
            finally:
                automatic.newton_suffices = newton

        times = _in_turns((least, lambda scene=scene: solve(scene)), repeats)
        rows.append({"scene": name, "ms least energy": times[0], "ms circle": times[1]})
    return rows


def _row(name: str, whole: Scene, piece: Scene, repeats: int) -> dict[str, Any]:
    solved, posed = (solve(whole), solve(piece)), Posed.of(piece)
    count = posed.given.boundary.pieces
    for found in solved:
        assert found.verified, f"{name}: {found.message}"
    # The same ribbon: its energy tells.
    off = abs(count * solved[1].energy / solved[0].energy - 1)
    times = _in_turns((lambda: solve(whole), lambda: solve(piece)), repeats)
    return {
        "scene": name,
        "piece": f"1/{count}",
        "ms whole": times[0],
        "ms piece": times[1],
        "ratio": times[0] / times[1],
        "energies differ by": off,
        "load": os.getloadavg()[0],
    }


def _in_turns(solves: tuple[Callable[[], Any], ...], repeats: int) -> list[float]:
    """Return the median CPU times of solves in turns, in ms."""
    times: list[list[float]] = [[] for _ in solves]
    for _ in range(repeats):
        for spent, one in zip(times, solves, strict=True):
            began = time.process_time()
            one()
            spent.append(1e3 * (time.process_time() - began))
    return [statistics.median(spent) for spent in times]


if __name__ == "__main__":
    for row in (*symmetry_case(), *starts_case()):
        print(", ".join(f"{k} {v:.3g}" if isinstance(v, float) else str(v) for k, v in row.items()))
