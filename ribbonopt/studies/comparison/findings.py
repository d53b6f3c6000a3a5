"""What rows say: the quickest within an error, what is as fast, and who wins among peers.

No more is said than the rounds show: where the ranges of two times overlap, they are as fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ribbonopt.classes import dataclass

from .peers import PeerRow
from .rows import PairRow

MOST = 2  # pairs as fast as the quickest that a sentence names

Entry = PairRow | PeerRow


@dataclass(frozen=True)
class Cheapest:
    """The quickest pair within a tolerance, and what comes near it; None if there is none.

    Attributes
    ----------
    tolerance : float
        Relative error of n(0), m(0) that all of these meet.
    winner, runner_up : PairRow or None
        The quickest row, and the quickest of another pair.
    equals : tuple of PairRow
        The best rows of other pairs that are as fast: the difference is within the spread.
    slower : PairRow or None
        The quickest row of a pair that is not.
    peer : PeerRow or None
        The quickest of the peers.
    peers : bool
        Whether there were any.
    """

    tolerance: float
    winner: PairRow | None
    runner_up: PairRow | None
    equals: tuple[PairRow, ...] = ()
    slower: PairRow | None = None
    peer: PeerRow | None = None
    peers: bool = False

    @property
    def ratio(self) -> float | None:
        """Time of the runner-up over that of the winner."""
        if self.winner is None or self.runner_up is None:
            return None
        return _ratio(self.runner_up, self.winner)

    @property
    def sentence(self) -> str:
        """The finding, to be read."""
        if self.winner is None:
            beaten = f"; {_cost(self.peer, cpu=True)}" if self.peer else ""
            return f"To {self.tolerance:.0e}: no pair gets there{beaten}."
        return f"To {self.tolerance:.0e}: {'; '.join(self._clauses(self.winner))}."

    def plain(self) -> dict[str, Any]:
        """Return numbers for JSON."""
        return {
            "tolerance": self.tolerance,
            "pair": self.winner and self.winner.name,
            "seconds": self.winner and self.winner.solve,
            "runner_up": self.runner_up and self.runner_up.name,
            "ratio": self.ratio,
            "label": self.winner and self.winner.label,
            "as_fast": [row.label for row in self.equals],
            "peer": self.peer and self.peer.label,
            "peer_seconds": self.peer and self.peer.solve,
        }

    def _clauses(self, winner: PairRow) -> list[str]:
        named = " and ".join(_cost(row) for row in self.equals[:MOST])
        more = f" and {len(self.equals) - MOST} more" if len(self.equals) > MOST else ""
        equal = f", as fast as {named}{more}" if named else ""
        said = [f"{_cost(winner, cpu=True)}{equal}"]
        if self.slower is not None:
            said.append(f"next {_cost(self.slower)}, {_times(self.slower, winner)}")
        elif not self.equals:
            said.append("no other pair gets there")
        if self.peer is not None:
            said.append(f"of the peers {_cost(self.peer)}, {_against(self.peer, winner)}")
        elif self.peers:
            said.append("no peer gets there")
        return said


def cheapest(rows: Sequence[PairRow], tolerance: float, peers: Sequence[PeerRow] = ()) -> Cheapest:
    """Find the quickest pair within a tolerance, the next, and the quickest of the peers."""
    quickest: dict[str, PairRow] = {}
    for row in sorted((row for row in rows if row.meets(tolerance)), key=_time):
        quickest.setdefault(row.name, row)
    peer = min((row for row in peers if row.meets(tolerance)), key=_time, default=None)
    if not quickest:
        return Cheapest(tolerance, None, None, peer=peer, peers=bool(peers))
    winner, *others = quickest.values()
    return Cheapest(
        tolerance,
        winner,
        others[0] if others else None,
        tuple(row for row in others if as_fast(winner, row)),
        next((row for row in others if not as_fast(winner, row)), None),
        peer,
        bool(peers),
    )


def sentences_of(found: Sequence[Cheapest], truth_error: float) -> tuple[str, ...]:
    """Return the findings in words; what the truth cannot tell is not decided."""
    return tuple(
        one.sentence
        if one.tolerance >= truth_error
        else f"To {one.tolerance:.0e}: not decided, the truth is known to "
        f"{truth_error:.0e} only; give a reference."
        for one in found
    )


def as_fast(one: Entry, other: Entry) -> bool:
    """Whether the ranges of two times overlap, so that neither is shown to be quicker."""
    return max(one.span[0], other.span[0]) <= min(one.span[1], other.span[1])


def milliseconds(seconds: float) -> str:
    """Return a time in ms, to two digits or more."""
    value = 1e3 * seconds
    return f"{value:.{sum(value < limit for limit in (10.0, 1.0, 0.1))}f}"


def _against(peer: PeerRow, winner: PairRow) -> str:
    if as_fast(peer, winner):
        return "as fast"
    if _time(peer) < _time(winner):
        return f"which wins: ours takes {_times(winner, peer)}"
    return _times(peer, winner)


def _times(slower: Entry, quicker: Entry) -> str:
    ratio = _ratio(slower, quicker)
    return f"{ratio:.{0 if ratio >= 10 else 1}f} times as long"


def _ratio(slower: Entry, quicker: Entry) -> float:
    return _time(slower) / _time(quicker)


def _time(row: Entry) -> float:
    return float("inf") if row.solve is None else row.solve


def _cost(row: Entry, cpu: bool = False) -> str:
    return f"{row.label}, {milliseconds(_time(row))} ms{' CPU' if cpu else ''}"
