"""Work against precision: all pairs on grids of degrees and meshes, timed in one interleaved run.

Orders are measured: slopes of log error against log h, over the meshes where the error is neither
rounding nor larger than the thing itself.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, replace
from statistics import median
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.output.summary import versions
from ribbonopt.scene import Scene
from ribbonopt.studies.machine import machine

from .compare import TOLERANCES
from .measure import Measurement, Repeated, measure
from .pairs import Mesh, Pair, pairs_of
from .profile import Profile, errors_of
from .rows import PairRow, cheapest, row_of
from .truth import UNKNOWN, Numbers, SourcedLoads, fine_solves, reference_of, truth_of

# Relative errors between which a slope is an order.
ROUNDING, COARSE = 1e-12, 1e-1
SLOW = 0.5  # seconds of a solve from which it is timed once only
PATIENCE = 20.0


@dataclass(frozen=True)
class Peer:
    """Another program's solve of the same problem; `run` returns n and m at the start."""

    name: str
    detail: str
    run: Callable[[], tuple[Numbers, Numbers]]


@dataclass(frozen=True)
class PeerRow:
    """A peer, timed: seconds of one solve and relative error of n(0), m(0)."""

    name: str
    detail: str
    solve: float
    error: float | None


@dataclass(frozen=True)
class Slope:
    """Measured order in h of a pair at a degree, over some meshes."""

    name: str
    degree: int
    order: float
    points: int


@dataclass(frozen=True)
class Benchmark:
    """What was measured; `rows` as in a comparison, `solve` the median of `repeat` solves."""

    name: str
    truth: str
    repeat: int
    rows: tuple[PairRow, ...]
    rivals: tuple[PeerRow, ...]

    @property
    def slopes(self) -> tuple[Slope, ...]:
        """Measured orders, where two meshes or more show one."""
        return slopes_of(self.rows)

    @property
    def sentences(self) -> tuple[str, ...]:
        """The cheapest pair at each error."""
        return tuple(cheapest(self.rows, tolerance).sentence for tolerance in TOLERANCES)

    @property
    def solved(self) -> bool:
        """Whether any pair gave a verified solution."""
        return any(row.verified for row in self.rows)

    def plain(self) -> dict[str, Any]:
        """Everything as plain data for JSON."""
        return {
            "name": self.name,
            "truth": self.truth,
            "repeat": self.repeat,
            "rows": [row.plain() for row in self.rows],
            "slopes": [asdict(slope) for slope in self.slopes],
            "peers": [asdict(rival) for rival in self.rivals],
            "sentences": list(self.sentences),
            "machine": machine(),
            "versions": versions(),
        }


def benchmark(
    scene: Scene,
    formulations: Iterable[str] | None = None,
    transcriptions: Iterable[str] | None = None,
    repeat: int = 11,
    quick: bool = False,
    reference: SourcedLoads | None = None,
    peers: Sequence[Peer] = (),
) -> Benchmark:
    """Time all pairs on their grids, and peers, in one interleaved run.

    Parameters
    ----------
    scene
        What to solve; its formulation, states and transcription are not used.
    formulations, transcriptions
        As for `compare`.
    repeat
        Solves of which the median is taken.
    quick
        Reduced states and the lowest two degrees only.
    reference
        The truth, if known better than by the best solution.
    peers
        Other programs on the same problem.
    """
    pairs = [p for p in pairs_of(formulations, transcriptions) if not quick or p.states != "full"]
    fine = fine_solves(scene, ROUNDING)
    found = [one for pair in pairs for one in _on_grid(pair, scene, quick)]
    seconds, peer_seconds = _timed([built for _, built in found], peers, repeat)
    reference = reference or reference_of(scene)
    truth = truth_of([*fine, *(one for one, _ in found)], reference)
    profile, source = (truth.profile, truth.source) if truth else (None, UNKNOWN)
    rows = tuple(
        _with_time(row_of(one, profile), value)
        for (one, _), value in zip(found, seconds, strict=True)
    )
    rivals = tuple(
        PeerRow(peer.name, peer.detail, value, _peer_error(peer, profile))
        for peer, value in zip(peers, peer_seconds, strict=True)
    )
    return Benchmark(scene.name, source, repeat, rows, rivals)


def slopes_of(rows: Sequence[PairRow]) -> tuple[Slope, ...]:
    """Measured order of every pair and degree, by least squares."""
    groups: dict[tuple[str, int], list[tuple[float, float]]] = {}
    for row in rows:
        if row.verified and row.error is not None and ROUNDING < row.error < COARSE:
            # Steps of the integration, whether or not an interval ends with them.
            group = groups.setdefault((row.name, row.degree), [])
            group.append((math.log(row.intervals * row.steps), math.log(row.error)))
    return tuple(
        Slope(name, degree, _order(points), len(points))
        for (name, degree), points in groups.items()
        if len(points) > 1
    )


def _order(points: Sequence[tuple[float, float]]) -> float:
    h, error = np.array(points).T
    h = h - h.mean()
    return -float(h @ error / (h @ h))


def _on_grid(pair: Pair, scene: Scene, quick: bool) -> list[tuple[Measurement, Repeated | None]]:
    degrees = sorted({getattr(mesh, "degree", 0) for mesh in pair.family.grid})
    meshes = [m for m in pair.family.grid if not quick or m.degree in degrees[:2]]
    found: list[tuple[Measurement, Repeated | None]] = []
    started = time.perf_counter()
    for mesh in meshes:
        if _exact(found, mesh) or time.perf_counter() - started > PATIENCE:
            continue
        found.append(measure(pair, scene, mesh, repeat=1))
        if found[-1][0].refused and len(found) == 1:
            break
    return found


def _exact(found: Sequence[tuple[Measurement, Repeated | None]], mesh: Mesh) -> bool:
    """Whether a coarser mesh of this degree is exact already, so that finer ones show nothing."""
    return any(
        one.mesh.degree == mesh.degree and one.estimate is not None and one.estimate < ROUNDING
        for one, _ in found
    )


def _timed(
    built: Sequence[Repeated | None], peers: Sequence[Peer], repeat: int
) -> tuple[list[float | None], list[float]]:
    """Median seconds of one solve of each, every round through all of them."""
    ours: list[list[float]] = [[] for _ in built]
    theirs: list[list[float]] = [[] for _ in peers]
    for _ in range(repeat):
        for prepared, seconds in zip(built, ours, strict=True):
            if prepared is not None and not (seconds and seconds[0] > SLOW):
                seconds.append(prepared.cost().solve)
        for peer, seconds in zip(peers, theirs, strict=True):
            if not (seconds and seconds[0] > SLOW):
                start = time.perf_counter()
                peer.run()
                seconds.append(time.perf_counter() - start)
    return [median(s) if s else None for s in ours], [median(s) for s in theirs]


def _with_time(row: PairRow, seconds: float | None) -> PairRow:
    return row if seconds is None else replace(row, solve=seconds)


def _peer_error(peer: Peer, truth: Profile | None) -> float | None:
    if truth is None:
        return None
    n0, m0 = peer.run()
    errors = errors_of(replace(truth, n0=np.array(n0), m0=np.array(m0)), truth)
    return max(errors["error_n0"], errors["error_m0"])
