"""Rows of a comparison: plain numbers under names that stay, as CSV, JSON and figures take them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, fields
from typing import Any

from ribbonopt.classes import dataclass
from ribbonopt.plain import finite

from .measure import Measurement
from .profile import Profile, errors_of


@dataclass(frozen=True)
class PairRow:
    """One solve, compared with the truth; None where not known.

    Attributes
    ----------
    formulation, states, transcription : str
        The pair, by the names of the command line.
    degree, intervals, steps : int
        The mesh; `degree` 0 for explicit shooting, `steps` 1 for collocation.
    unknowns, nonzeros, iterations : int
        Size of the program, nonzeros of its Jacobian, iterations of the solver.
    build, evaluate, linear, solve : float
        Seconds: to build; of one solve, in functions, in linear algebra, in all.
    error_n0, error_m0, error_u : float
        Errors relative to |n(0)|, |m(0)|, and of u along s relative to its largest component.
    drift_invariant, drift_law, drift_frame : float
        Change of H along s (relative), |u - u*(m)| along s (relative), and departure of the
        directors from orthonormality.
    estimate : float
        The solution's own estimate of its relative error.
    verified, status, message : bool, str, str
        How it ended.
    """

    formulation: str
    states: str
    transcription: str
    degree: int
    intervals: int
    steps: int
    unknowns: int | None = None
    nonzeros: int | None = None
    iterations: int | None = None
    build: float | None = None
    evaluate: float | None = None
    linear: float | None = None
    solve: float | None = None
    error_n0: float | None = None
    error_m0: float | None = None
    error_u: float | None = None
    drift_invariant: float | None = None
    drift_law: float | None = None
    drift_frame: float | None = None
    estimate: float | None = None
    verified: bool = False
    status: str = ""
    message: str = ""

    @property
    def name(self) -> str:
        """The pair."""
        return f"{self.formulation}, {self.states}, {self.transcription}"

    @property
    def mesh(self) -> str:
        """The mesh in words."""
        degree = f"degree {self.degree}, " if self.degree else ""
        steps = f" of {self.steps} steps" if self.steps > 1 else ""
        return f"{degree}{self.intervals} intervals{steps}"

    @property
    def error(self) -> float | None:
        """Relative error of n(0), m(0), the larger: what tolerances mean; None if not known."""
        if self.error_n0 is None or self.error_m0 is None:
            return None
        return max(self.error_n0, self.error_m0)

    def meets(self, tolerance: float) -> bool:
        """Whether this is a verified solution within the tolerance."""
        return self.verified and self.error is not None and self.error <= tolerance

    def plain(self) -> dict[str, Any]:
        """Columns by name, for JSON and figures."""
        return {"pair": self.name} | asdict(self) | {"error": self.error}


COLUMNS = ("pair", *(f.name for f in fields(PairRow)), "error")


def row_of(found: Measurement, truth: Profile | None) -> PairRow:
    """Return the row of a measurement, its errors against the truth."""
    mesh = found.mesh
    # Shooting by an explicit scheme has no degree, collocation no steps.
    explicit = getattr(mesh, "scheme", "") in ("rk4", "rk8")
    values: dict[str, Any] = {**found.numbers}
    if found.profile is not None and truth is not None:
        values |= errors_of(found.profile, truth)
    values |= {"estimate": found.estimate}
    return PairRow(
        formulation=found.pair.formulation,
        states=found.pair.states,
        transcription=found.pair.transcription,
        degree=0 if explicit else mesh.degree,
        intervals=mesh.intervals,
        steps=getattr(mesh, "steps", 1),
        verified=found.verified,
        status=found.status,
        message=found.message,
        **{key: finite(value) for key, value in values.items()},
    )


@dataclass(frozen=True)
class Cheapest:
    """The quickest row within a tolerance, and the quickest of another pair; None if there is none.

    `ratio` is the time of the runner-up over that of the winner.
    """

    tolerance: float
    winner: PairRow | None
    runner_up: PairRow | None

    @property
    def ratio(self) -> float | None:
        """Time of the runner-up over that of the winner."""
        if self.winner is None or self.runner_up is None:
            return None
        return _time(self.runner_up) / _time(self.winner)

    @property
    def sentence(self) -> str:
        """The finding, to be read."""
        if self.winner is None:
            return f"To {self.tolerance:.0e}: no pair gets there."
        won = f"To {self.tolerance:.0e}: {self.winner.name} is cheapest, {_cost(self.winner)}"
        if self.runner_up is None:
            return f"{won}; no other pair gets there."
        return (
            f"{won}; next {self.runner_up.name}, {_cost(self.runner_up)}: "
            f"{self.ratio:.1f} times as long."
        )

    def plain(self) -> dict[str, Any]:
        """Return numbers for JSON."""
        return {
            "tolerance": self.tolerance,
            "pair": self.winner and self.winner.name,
            "seconds": self.winner and self.winner.solve,
            "runner_up": self.runner_up and self.runner_up.name,
            "ratio": self.ratio,
        }


def cheapest(rows: Sequence[PairRow], tolerance: float) -> Cheapest:
    """Find the quickest pair within a tolerance, and the next."""
    good = sorted((row for row in rows if row.meets(tolerance)), key=_time)
    winner = good[0] if good else None
    others = [row for row in good if winner and row.name != winner.name]
    return Cheapest(tolerance, winner, others[0] if others else None)


def _time(row: PairRow) -> float:
    return math.inf if row.solve is None else row.solve


def _cost(row: PairRow) -> str:
    return f"{1e3 * _time(row):.1f} ms ({row.mesh})"
