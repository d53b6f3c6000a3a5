"""Compare ways to solve one scene: formulations, states and transcriptions by time and true error.

Every pair climbs a ladder of meshes until it meets the tightest tolerance. Errors are taken from a
reference where one is given, else from the most accurate solution of all by its own estimate; a
fine solve of the inverted form is among the candidates.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from typing import Any

from ribbonopt.classes import dataclass
from ribbonopt.output.summary import versions
from ribbonopt.scene import Scene
from ribbonopt.studies.machine import machine

from .findings import Cheapest, cheapest, sentences_of
from .measure import Measurement, Repeated, measure
from .pairs import Pair, pairs_of
from .profile import errors_of
from .rows import PairRow, rows_of
from .timing import Conditions, Contender, interleaved
from .truth import UNKNOWN, SourcedLoads, Truth, fine_solves, reference_of, truth_of

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
# Seconds of the processor after which a pair climbs no further, and unverified solves in a row
# after which it gives up: coarse meshes may fail where finer ones do not.
PATIENCE = 3.0
FAILURES = 4
ROUNDS = 7


@dataclass(frozen=True)
class Comparison:
    """All rows, from cheap to fine for each pair, and what they say.

    Attributes
    ----------
    name : str
        Of the scene.
    truth : str
        What errors were measured against.
    truth_error : float
        Relative error of the truth itself, as far as is known.
    tolerances : tuple of float
        Relative errors of n(0), m(0) that were wanted.
    rows : tuple of PairRow
        One for each solve.
    timing : Conditions
        How times were taken.
    """

    name: str
    truth: str
    truth_error: float
    tolerances: tuple[float, ...]
    rows: tuple[PairRow, ...]
    timing: Conditions = Conditions()

    @property
    def cheapest(self) -> tuple[Cheapest, ...]:
        """The cheapest pair at each tolerance."""
        return tuple(cheapest(self.rows, tolerance) for tolerance in self.tolerances)

    @property
    def sentences(self) -> tuple[str, ...]:
        """What the rows say, in plain words."""
        return sentences_of(self.cheapest, self.truth_error)

    @property
    def solved(self) -> bool:
        """Whether any pair gave a verified solution."""
        return any(row.verified for row in self.rows)

    def plain(self) -> dict[str, Any]:
        """Everything as plain data for JSON."""
        return {
            "name": self.name,
            "truth": self.truth,
            "truth_error": self.truth_error,
            "tolerances": list(self.tolerances),
            "rows": [row.plain() for row in self.rows],
            "cheapest": [found.plain() for found in self.cheapest],
            "sentences": list(self.sentences),
            "timing": self.timing.plain(),
            "machine": machine(),
            "versions": versions(),
        }


def compare(
    scene: Scene,
    formulations: Iterable[str] | None = None,
    transcriptions: Iterable[str] | None = None,
    tolerances: Iterable[float] | None = None,
    reference: SourcedLoads | None = None,
) -> Comparison:
    """Solve a scene by all pairs of formulation, states and transcription.

    Parameters
    ----------
    scene
        What to solve; its formulation, states and transcription are not used.
    formulations, transcriptions
        Names of `FORMULATIONS` and `TRANSCRIPTIONS`; None for all.
    tolerances
        Relative errors of n(0), m(0) wanted; the tightest ends every ladder.
    reference
        The truth, if known better than by the best solution; else the scene's own reference, if it
        has one.

    Raises
    ------
    SceneError
        If a name is not known. What a pair refuses or fails to solve is a row.
    """
    pairs = pairs_of(formulations, transcriptions)
    reference = reference or reference_of(scene)
    wanted = tuple(sorted(TOLERANCES if tolerances is None else tolerances, reverse=True))
    fine = fine_solves(scene, wanted[-1])
    provisional = truth_of(fine, reference)
    found = [one for pair in pairs for one in _climb(pair, scene, provisional, wanted[-1])]
    truth = truth_of([*fine, *(measurement for measurement, _ in found)], reference)
    profile = truth.profile if truth else None
    source, error = (truth.source, truth.error) if truth else (UNKNOWN, 0.0)
    times, timing = interleaved([Contender(built) for _, built in found if built], ROUNDS)
    rows = rows_of(found, profile, times, error)
    return Comparison(scene.name, source, error, wanted, rows, timing)


def _climb(
    pair: Pair, scene: Scene, truth: Truth | None, wanted: float
) -> Iterator[tuple[Measurement, Repeated | None]]:
    """Measure from cheap to fine meshes until the error is met."""
    # Time on the processor: what else a machine does shall not decide where a ladder ends.
    started, failures = time.process_time(), 0
    for mesh in pair.family.ladder:
        found, prepared = measure(pair, scene, mesh)
        yield found, prepared
        failures = 0 if found.verified else failures + 1
        spent = time.process_time() - started
        if found.refused or failures >= FAILURES or spent > PATIENCE or _met(found, truth, wanted):
            return


def _met(found: Measurement, truth: Truth | None, wanted: float) -> bool:
    if truth is None or not found.verified or found.profile is None:
        return False
    errors = errors_of(found.profile, truth.profile)
    return max(errors["error_n0"], errors["error_m0"]) <= wanted
