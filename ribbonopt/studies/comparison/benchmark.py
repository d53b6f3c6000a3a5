"""Work against precision: all pairs on grids of degrees and meshes, timed in one interleaved run.

Orders are measured: slopes of log error against log h, over the meshes where the error is neither
rounding nor larger than the thing itself.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.output.summary import versions
from ribbonopt.scene import Scene
from ribbonopt.studies.machine import machine

from .compare import TOLERANCES
from .findings import Cheapest, cheapest, sentences_of
from .measure import Measurement, Repeated, measure
from .pairs import Mesh, Pair, pairs_of
from .peers import Peer, PeerRow, rows_of_peers
from .rows import PairRow, rows_of
from .timing import Conditions, Contender, interleaved
from .truth import UNKNOWN, SourcedLoads, fine_solves, reference_of, truth_of

__all__ = ["Benchmark", "Peer", "PeerRow", "Slope", "benchmark", "slopes_of"]

# Relative errors between which a slope is an order.
ROUNDING, COARSE = 1e-12, 1e-1
PATIENCE = 20.0  # CPU seconds after which a pair goes to no further mesh


@dataclass(frozen=True)
class Slope:
    """Measured order in h of a pair at a degree, over some meshes."""

    name: str
    degree: int
    order: float
    points: int


@dataclass(frozen=True)
class Benchmark:
    """What was measured; `rows` as in a comparison, `solve` the median of `repeat` rounds."""

    name: str
    truth: str
    repeat: int
    rows: tuple[PairRow, ...]
    rivals: tuple[PeerRow, ...]
    truth_error: float = 0.0
    timing: Conditions = Conditions()

    @property
    def slopes(self) -> tuple[Slope, ...]:
        """Measured orders, where two meshes or more show one."""
        return slopes_of(self.rows)

    @property
    def sentences(self) -> tuple[str, ...]:
        """The cheapest pair at each error, and who wins among peers."""
        return sentences_of(self.cheapest, self.truth_error)

    @property
    def cheapest(self) -> tuple[Cheapest, ...]:
        """The cheapest pair at each error, and the cheapest of the peers."""
        return tuple(cheapest(self.rows, tolerance, self.rivals) for tolerance in TOLERANCES)

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
            "peers": [rival.plain() for rival in self.rivals],
            "sentences": list(self.sentences),
            "truth_error": self.truth_error,
            "cheapest": [found.plain() for found in self.cheapest],
            "timing": self.timing.plain(),
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
        Rounds of which the median is taken.
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
    ours = [Contender(built) for _, built in found if built]
    times, timing = interleaved([*ours, *(peer.contender for peer in peers)], repeat)
    reference = reference or reference_of(scene)
    truth = truth_of([*fine, *(one for one, _ in found)], reference)
    profile = truth.profile if truth else None
    source, error = (truth.source, truth.error) if truth else (UNKNOWN, 0.0)
    rows = rows_of(found, profile, times[: len(ours)], error)
    rivals = rows_of_peers(peers, times[len(ours) :], profile, error)
    return Benchmark(scene.name, source, repeat, rows, rivals, error, timing)


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
    started = time.process_time()
    for mesh in meshes:
        if _exact(found, mesh) or time.process_time() - started > PATIENCE:
            continue
        found.append(measure(pair, scene, mesh))
        if found[-1][0].refused and len(found) == 1:
            break
    return found


def _exact(found: Sequence[tuple[Measurement, Repeated | None]], mesh: Mesh) -> bool:
    """Whether a coarser mesh of this degree is exact already, so that finer ones show nothing."""
    return any(
        one.mesh.degree == mesh.degree and one.estimate is not None and one.estimate < ROUNDING
        for one, _ in found
    )
