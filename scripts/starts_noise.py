"""Noise on the start of Moebius ribbons, half and whole: what comes of it, and whether it is right.

Part of `bench_starts.py`. Every number of the start is changed by its own share of itself, up to
10, 30 or 100 %. Each verified answer is integrated anew by `tests/independent`, which shares
nothing with the package: `wrong` where that says otherwise. Found is the Moebius band that the
scene means; other equilibria are counted apart, with their energies.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from subprocess import TimeoutExpired
from typing import Any

import numpy as np
from peer_colnew import Colnew
from peer_states import Ribbon

from ribbonopt.guess import Guess
from ribbonopt.mechanics.rotations import matrix_of, quaternions_from
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tests"))

from independent.confirm import confirm  # noqa: E402  (lies beside the tests)

LEVELS = (0.1, 0.3, 1.0)
LAW = "law={type: regularized, epsilon: 0.01}"
LOADS = "guess={force: [0, 40, 40], moment: [0, 2, -9]}"  # what peers start from
# name: scene, settings
SCENES = {
    "half, from loads": ("moebius_half", [LOADS]),
    "whole (6.1), from loads": ("moebius_whole", [LAW, LOADS]),
    "whole (6.1), automatic": ("moebius_whole", [LAW]),
    "whole variational, automatic": ("moebius_whole", []),
}
WHOLE_PATH = "whole path"
METHODS = ("Newton", "Newton, then IPOPT", WHOLE_PATH)  # the first two of the half ribbon only
PEER_SETTING = (5, 10, 1e-6)  # of COLNEW: stages, intervals of the first mesh, tolerance
PATIENCE = 5.0  # seconds that it is given
PEER_SAME = 1e-4  # of what it finds; other equilibria are far away
SAME = 1e-6  # of n(0), m(0) against the scene's own answer; symmetry leaves their signs open
RIGHT = 1e-7  # gaps of an answer and its integration, over what an error grows by


@dataclass(frozen=True, eq=False)
class Noisy:
    """A guess with every number changed; n and m(0) as the unknowns of the reduced states are."""

    guess: Guess
    level: float
    seed: int

    def fields(self, fraction: np.ndarray) -> RodFields:
        """Fields at fractions (k,) of the length."""
        rng = np.random.default_rng(self.seed)
        f = self.guess.fields(fraction)
        r, q = (changed(v, self.level, rng) for v in (f.r, quaternions_from(f.frames)))
        n, m0 = (changed(v[0], self.level, rng) for v in (f.n, f.m))
        m = m0 + np.cross(n, r - r[0])
        return RodFields(r, np.stack([matrix_of(v) for v in q]), np.tile(n, (len(r), 1)), m)


def changed(values: np.ndarray, level: float, rng: np.random.Generator) -> np.ndarray:
    """Change every number by up to a share of itself."""
    return values * (1 + level * rng.uniform(-1, 1, values.shape))


def bench_noise(seeds: int, names: tuple[str, ...] = tuple(SCENES)) -> list[dict[str, Any]]:
    """Solve from every perturbed start by every method, built once."""
    rows = []
    for name in names:
        file, settings = SCENES[name]
        prepared = prepare(load_scene(ROOT / "configs" / f"{file}.yaml", settings))
        own = prepared.solve()
        search = prepared.search()
        next(prepared.automatic.guesses(search.posed, search.ledger))  # builds it, once
        for method, run in runs(prepared, own, file == "moebius_half").items():
            rows += [tried(name, method, run, level, seeds) for level in LEVELS]
    return rows


def bench_peer(seeds: int) -> list[dict[str, Any]]:
    """Solve from starts with the same noise by COLNEW on 13 states, where it is found."""
    peer = Colnew()
    if peer.why:
        print(f"COLNEW is not run: {peer.why}")
        return []
    rows = []
    for whole in (False, True):
        ribbon = Ribbon(whole)

        def run(level: float, seed: int, ribbon: Ribbon = ribbon) -> tuple[float, Told]:
            _, x = ribbon.guess()
            rng = np.random.default_rng(seed)
            constants = changed(x[0, ribbon.moving :], level, rng)
            noisy = np.tile(np.append(np.zeros(ribbon.moving), constants), (len(x), 1))
            noisy[:, : ribbon.moving] = changed(x[:, : ribbon.moving], level, rng)
            try:
                found = peer.run(ribbon, PEER_SETTING, 1, guess=noisy, patience=PATIENCE)
            except TimeoutExpired:
                return PATIENCE, (f"no end within {PATIENCE:g} s", {})
            if not found["verified"]:
                return found["cpu_s"], ("it did not converge", {})
            band = same(np.array(found["numbers"]), np.array(ribbon.truth), PEER_SAME)
            return found["cpu_s"], ("found" if band else "another solution of the equations", {})

        name = "whole (6.1), from loads" if whole else "half, from loads"
        rows += [tried(name, "COLNEW, 13 states", run, level, seeds) for level in LEVELS]
    return rows


Told = tuple[str, dict[str, Any]]
Run = Callable[[float, int], tuple[float, Told]]


def runs(prepared: Prepared, own: Solution, half: bool) -> dict[str, Run]:
    """Return the methods: CPU seconds from a level and a seed, and what came of it."""
    guess, truth = prepared.guess(), np.append(own.n0, own.m0)

    def path(level: float, seed: int) -> tuple[float, Told]:
        start = Noisy(guess, level, seed)
        used = time.process_time()
        solution = prepared.solve(guess=start)
        return time.process_time() - used, judged(solution, truth)

    if not half:
        return {WHOLE_PATH: path}
    w, p = prepared.start()
    solver = prepared.solver
    solver.ipopt.build()

    def alone(solve: Callable[..., Any], level: float, seed: int) -> tuple[float, Told]:
        start = changed(w, level, np.random.default_rng(seed))
        used = time.process_time()
        report = solve(start, p)
        used = time.process_time() - used
        if not report.status.converged:
            return used, (report.status.value.split(":")[0], {})
        band = same(report.w[-6:], truth)  # the last six are n and m(0)
        return used, ("found" if band else "another solution of the equations", {})

    return {
        METHODS[0]: lambda level, seed: alone(solver.newton.solve, level, seed),
        METHODS[1]: lambda level, seed: alone(solver.solve, level, seed),
        WHOLE_PATH: path,
    }


def tried(name: str, method: str, run: Run, level: float, seeds: int) -> dict[str, Any]:
    """Return the row of a method at a level: counts, CPU, gaps, what else was found."""
    outcomes: Counter[str] = Counter()
    seconds, gaps, others = [], [], []
    for seed in range(seeds):
        used, (outcome, more) = run(level, seed)
        outcomes[outcome] += 1
        seconds.append(used)
        gaps += [more["gap"]] if "gap" in more else []
        if outcome != "found":
            others.append({"seed": seed, "outcome": outcome} | more)
    return {
        "scene": name,
        "method": method,
        "level": level,
        "seeds": seeds,
        "found": outcomes.pop("found", 0),
        "not_found": dict(outcomes),
        "ms_median": 1e3 * float(np.median(seconds)),
        "ms_max": 1e3 * max(seconds),
        "gap_max": max(gaps, default=None),
        "others": others,
    }


def judged(solution: Solution, truth: np.ndarray) -> Told:
    """Whether it is the Moebius band; otherwise what it is, or why there is nothing."""
    if not solution.verified:
        return solution.message.split(":")[0], {"message": solution.message}
    told = {"energy": solution.energy, "gap": confirm(solution)}
    told |= {"n0": solution.n0.tolist(), "m0": solution.m0.tolist()}
    if not told["gap"] <= RIGHT:
        return "wrong", told
    band = same(np.append(solution.n0, solution.m0), truth)
    return ("found" if band else "another equilibrium"), told


def same(loads: np.ndarray, truth: np.ndarray, within: float = SAME) -> bool:
    """Whether loads are those of the band, but for their signs."""
    return bool(np.abs(np.abs(loads) - np.abs(truth)).max() < within * np.abs(truth).max())
