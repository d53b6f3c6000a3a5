"""Peers of `bench_accuracy.py`, each on 18 states and on 13, and ours as a user writes it.

What a peer needs and is not there is said, and the peer left out.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from peer_auto import Auto
from peer_casadi import IPOPT, NEWTON, Collocated
from peer_colnew import Colnew
from peer_scipy import Scipy
from peer_settings import AUTO, COLNEW, SCIPY, SETTINGS
from peer_states import FORCE, MOMENT, Ribbon

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import load_scene
from ribbonopt.studies.comparison.benchmark import Peer

CONFIGS = Path(__file__).resolve().parent.parent / "configs"
SCENES = {False: CONFIGS / "moebius_half.yaml", True: CONFIGS / "moebius_regularized.yaml"}
STARTED = f"guess={{force: {list(FORCE)}, moment: {list(MOMENT)}}}"  # as all peers
TIMES = 10  # that a compiled peer solves for each time that it is asked
QUICK = 2  # rungs of each ladder
OURS = "ribbonopt with its bar"
# tolerance, degree, intervals of the first mesh
LADDER = {
    False: [(1e-4, 4, 6), (1e-6, 6, 6), (1e-9, 6, 8), (1e-12, 8, 8)],
    True: [(1e-4, 6, 8), (1e-6, 6, 8), (1e-9, 7, 10), (1e-12, 8, 14)],
}
Loads = tuple[list[float], list[float]]
Run = Callable[[], Loads | tuple[list[float], list[float], float]]


def contenders(whole: bool, quick: bool, missing: dict[str, str]) -> list[Peer]:
    """Return the rows of all peers and of ours; `missing` is told who is not there, and why."""
    found: list[Peer] = []
    peers = {COLNEW: Colnew(), AUTO: Auto()}
    missing |= {name: peer.why for name, peer in peers.items() if peer.why}
    for states in (13, 18):
        ribbon = Ribbon(whole, states)
        ladder = LADDER[whole][:QUICK] if quick else LADDER[whole]
        found += [_ours(ribbon, *rung) for rung in ladder]
        for name, settings in SETTINGS.items():
            if name in missing:
                continue
            scipy = Scipy(ribbon) if name == SCIPY else None
            for setting in settings[ribbon][:QUICK] if quick else settings[ribbon]:
                if name in peers:
                    run: Run = partial(_compiled, peers[name], ribbon, setting)
                elif scipy is not None:
                    run = partial(_scipy, scipy, setting)
                else:
                    run = partial(_casadi, Collocated(ribbon, name, *setting))
                found.append(Peer(f"{name}, {states} states", _words(name, setting), run))
    return found


def _ours(ribbon: Ribbon, tolerance: float, degree: int, intervals: int) -> Peer:
    """Return the whole path to a tolerance, structure kept, its bars included."""
    settings = [
        f"tolerance={tolerance}",
        f"states={'reduced' if ribbon.states == 13 else 'full'}",
        f"transcription.degree={degree}",
        f"transcription.intervals={intervals}",
        STARTED,
    ]
    prepared = prepare(load_scene(SCENES[ribbon.whole], settings))

    def run() -> Loads:
        solution = prepared.solve()
        if not solution.verified:
            raise RuntimeError(solution.message)
        estimate_error(solution)
        return solution.n0.tolist(), solution.m0.tolist()

    run()  # what a first solve builds
    return Peer(f"{OURS}, {ribbon.states} states", f"to {tolerance:.0e}", run)


def _compiled(peer: Any, ribbon: Ribbon, setting: Any) -> tuple[list[float], list[float], float]:
    found = peer.run(ribbon, setting, TIMES if isinstance(peer, Colnew) else 1)
    if not found.get("verified", True):
        raise RuntimeError("it did not converge")
    return found["numbers"][:3], found["numbers"][3:], found["cpu_s"]


def _scipy(problem: Scipy, tolerance: float) -> Loads:
    loads, _ = problem.solve(tolerance)
    return loads[:3], loads[3:]


def _casadi(program: Collocated) -> Loads:
    loads = program.solve()
    return loads[:3], loads[3:]


def _words(name: str, setting: Any) -> str:
    """Return a setting in a few words."""
    if name == SCIPY:
        return f"to {setting:.0e}"
    if name == COLNEW:
        stages, intervals, tolerance = setting
        return f"{stages} x {intervals}, to {tolerance:.0e}"
    intervals, degree = setting[:2]
    assert name in (AUTO, NEWTON, IPOPT)
    return f"{degree} x {intervals}"
