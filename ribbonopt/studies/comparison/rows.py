"""Rows of a comparison: plain numbers under names that stay, as CSV, JSON and figures take them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, fields, replace
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.plain import finite

from .frontier import frontier
from .measure import Measurement, Repeated
from .profile import Profile, errors_of
from .timing import Span, Times, span_of

OVERALL, OWN, PAIR = "overall", "formulation", "pair"  # frontiers that a row may be on


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
        CPU seconds: to build; of one solve, in functions, in linear algebra, in all. Medians of
        the rounds; of what is not verified `solve` alone, of the whole try.
    error_n0, error_m0, error_u : float
        Errors relative to |n(0)|, |m(0)|, and of u along s relative to its largest component.
    drift_invariant, drift_law, drift_frame : float
        Change of H along s (relative), |u - u*(m)| along s (relative), and departure of the
        directors from orthonormality.
    estimate : float
        The solution's own estimate of its relative error.
    verified, status, message : bool, str, str
        How it ended.
    low, high : float
        Quartiles of `solve` over the rounds; None where those were few.
    rounds : int
        How many times it was timed.
    frontier : str
        "overall" if no verified row is as quick and as accurate; "formulation" if none of its
        formulation is, "pair" if none of its pair is, else "".
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
    low: float | None = None
    high: float | None = None
    rounds: int = 0
    frontier: str = ""

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
    def size(self) -> str:
        """The mesh, short: degree x intervals, or intervals x steps of an explicit scheme."""
        if not self.degree:
            return f"{self.intervals} x {self.steps} steps"
        steps = f" x {self.steps} steps" if self.steps > 1 else ""
        return f"{self.degree} x {self.intervals}{steps}"

    @property
    def label(self) -> str:
        """Pair and mesh, short."""
        states = "" if self.states == "reduced" else f" ({self.states} states)"
        return f"{self.formulation}{states} + {self.transcription} {self.size}"

    @property
    def span(self) -> Span:
        """Where its time is believed."""
        return span_of(self.solve or 0.0, self.low, self.high)

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
        values = {"pair": self.name} | asdict(self) | {"error": self.error}
        return {name: values[name] for name in COLUMNS}


_NEW = ("low", "high", "rounds", "frontier")  # columns stay where they were
COLUMNS = (
    "pair",
    *(f.name for f in fields(PairRow) if f.name not in _NEW),
    *("error", *_NEW),
)


def rows_of(
    found: Sequence[tuple[Measurement, Repeated | None]],
    truth: Profile | None,
    times: Sequence[Times],
    floor: float = 0.0,
) -> tuple[PairRow, ...]:
    """Return the rows of measurements, with the times of those that can be solved again.

    Errors below the floor, that of the truth, win nothing: the truth itself has none.
    """
    taken = iter(times)
    rows = []
    for one, built in found:
        row = row_of(one, truth)
        rows.append(row if built is None else with_times(row, next(taken)))
    return with_frontiers(rows, floor)


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


def with_times(row: PairRow, times: Times) -> PairRow:
    """Return the row with medians and quartiles of its rounds; a failure in one is its failure."""
    if times.failure:
        return replace(row, verified=False, status="not_repeated", message=times.failure)
    if not times.seconds:
        return row
    found = times.numbers
    evaluate, linear = np.median(times.answers, axis=0) * found["solve"]
    return replace(row, evaluate=float(evaluate), linear=float(linear), **found)


def with_frontiers(rows: Sequence[PairRow], floor: float = 0.0) -> tuple[PairRow, ...]:
    """Mark the rows that are on the frontier of their pair, of their formulation, of all."""
    ranked = [
        (i, max(row.error, floor), row.solve)
        for i, row in enumerate(rows)
        if row.verified and row.error is not None and row.solve is not None
    ]
    marks: dict[int, str] = {}
    for mark, key in ((PAIR, "name"), (OWN, "formulation"), (OVERALL, "verified")):
        groups: dict[Any, list[tuple[int, float, float]]] = {}
        for place in ranked:
            groups.setdefault(getattr(rows[place[0]], key), []).append(place)
        for own in groups.values():
            marks |= {own[k][0]: mark for k in frontier([(e, t) for _, e, t in own])}
    return tuple(replace(row, frontier=marks.get(i, "")) for i, row in enumerate(rows))
