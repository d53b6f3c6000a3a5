"""Other programs on the same problem: how they are asked, and their rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.plain import finite

from .frontier import frontier
from .profile import Profile, errors_of
from .timing import Contender, Span, Times, span_of
from .truth import Numbers

ENOUGH = 2.0  # seconds in all from which a peer is not timed again
Answer = tuple[Numbers, Numbers] | tuple[Numbers, Numbers, float]


@dataclass(frozen=True)
class Peer:
    """Another program's solve of the same problem.

    `run` returns n and m at the start, and if it knows better what it cost than the clock of this
    process and of the processes it waited for, the CPU seconds of one solve. What it raises makes
    a row that says so.
    """

    name: str
    detail: str
    run: Callable[[], Answer]

    @property
    def contender(self) -> Contender:
        """The peer, to be timed."""
        return Contender(self._loads, lambda answer: answer[1], ENOUGH)

    def _loads(self) -> tuple[Array, float | None]:
        """Return n, m (6,) at the start, and its own CPU seconds."""
        n0, m0, *told = self.run()
        loads = np.concatenate([np.ravel(np.asarray(v, dtype=float)) for v in (n0, m0)])
        if loads.shape != (6,) or not np.isfinite(loads).all():
            raise ValueError(f"expected n and m of three finite numbers each, found {n0}, {m0}")
        if told and not 0 < float(told[0]) < float("inf"):
            raise ValueError(f"expected CPU seconds, found {told[0]}")
        return loads, float(told[0]) if told else None


@dataclass(frozen=True)
class PeerRow:
    """A peer, timed: CPU seconds of one solve and relative error of n(0), m(0).

    `low`, `high` are quartiles over `rounds`, None where those were few; `message` says why there
    is no answer; `frontier`: no other row of this peer is as quick and as accurate.
    """

    name: str
    detail: str
    solve: float | None
    error: float | None
    low: float | None = None
    high: float | None = None
    rounds: int = 0
    message: str = ""
    frontier: bool = False

    @property
    def label(self) -> str:
        """Name in sentences."""
        return f"{self.name} ({self.detail})" if self.detail else self.name

    @property
    def span(self) -> Span:
        """Where its time is believed."""
        return span_of(self.solve or 0.0, self.low, self.high)

    def meets(self, tolerance: float) -> bool:
        """Whether this is an answer within the tolerance."""
        return self.solve is not None and self.error is not None and self.error <= tolerance

    def plain(self) -> dict[str, Any]:
        """Columns by name, for JSON and figures."""
        found: dict[str, Any] = finite(asdict(self))
        return found


def rows_of_peers(
    peers: Sequence[Peer], times: Sequence[Times], truth: Profile | None, floor: float = 0.0
) -> tuple[PeerRow, ...]:
    """Return a row for each peer: failures too, with their reasons. Floor as in `rows_of`."""
    rows = [_row(peer, found, truth) for peer, found in zip(peers, times, strict=True)]
    best: set[int] = set()
    for name in dict.fromkeys(row.name for row in rows):
        own = [(i, row.error, row.solve) for i, row in enumerate(rows) if row.name == name]
        good = [(i, e, t) for i, e, t in own if e is not None and t is not None]
        best |= {good[k][0] for k in frontier([(max(e, floor), t) for _, e, t in good])}
    return tuple(replace(row, frontier=i in best) for i, row in enumerate(rows))


def _row(peer: Peer, times: Times, truth: Profile | None) -> PeerRow:
    if times.failure:
        return PeerRow(peer.name, peer.detail, None, None, message=times.failure)
    error = None if truth is None else max(_error(loads, truth) for loads, _ in times.answers)
    return PeerRow(peer.name, peer.detail, error=error, **times.numbers)


def _error(loads: Array, truth: Profile) -> float:
    errors = errors_of(replace(truth, n0=loads[:3], m0=loads[3:]), truth)
    return max(errors["error_n0"], errors["error_m0"])
