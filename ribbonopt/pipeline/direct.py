"""Guesses for a law whose energy form is another problem: what minimises that, near a smooth law's.

Wunderlich's equations grow by exp(sqrt(24) s / w) in either sense and are singular where the
curvature changes its sign, so that Newton's method on them needs all states from the first; the
energy form has neither difficulty, and tells how many sign changes there are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cached_property
from typing import Any

import numpy as np

from ribbonopt.attempt.ledger import Ledger
from ribbonopt.attempt.structure import Structure
from ribbonopt.guess import Guess
from ribbonopt.problem import Posed
from ribbonopt.scene import Collocation, Ipopt
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

COUNT = 30  # intervals
MESH = Collocation(scheme="gauss", degree=3, intervals=COUNT)
SOLVER = Ipopt(tolerance=1e-7, max_iterations=150)
ENDS = 2.0  # how much they gather at the ends, where a clamp makes a layer


class Direct:
    """The energy form of a scene, from nearby equilibria of other laws."""

    def __init__(self, posed: Posed, ledger: Ledger) -> None:
        settings = {"formulation": "energy", "states": "reduced", "solver": SOLVER}
        self.posed = posed.under(transcription=MESH, **settings)
        self.ledger = ledger

    @cached_property
    def structure(self) -> Structure:
        """Its equations, without loads that have no potential."""
        return Structure.least_energy(self.posed)

    def guesses(self, others: Callable[..., Iterable[Guess]]) -> Callable[..., Iterator[Guess]]:
        """Return what gives minima near the solutions that others give, and the rest as it is."""

        def found(**shape: Any) -> Iterator[Guess]:
            for guess in others(**shape):
                minimum = self.minimum(guess) if isinstance(guess, Solution) else None
                yield guess if minimum is None else minimum

        return found

    def minimum(self, near: Solution) -> Solution | None:
        """Return a minimum near a solution, if one is found."""
        attempt = self.structure.attempt(self.posed, self.ledger, _mesh())
        attempt.run(near, check=False)
        best = attempt.best
        return best if best is not None and best.status.converged else None


def _mesh() -> Mesh:
    """Return a mesh that gathers at both ends."""
    x = np.linspace(-1, 1, COUNT + 1)
    return Mesh((np.diff(np.tanh(ENDS * x)) / (2 * np.tanh(ENDS)),))
