"""What was checked on a solution."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ribbonopt.classes import dataclass

NO_LENGTH = 1e-9  # of the ribbon: a phase that is shorter is not there


@dataclass(frozen=True, eq=False)
class Verification:
    """What was checked on the dense output after the solve.

    Attributes
    ----------
    problems : tuple of str
        One sentence for each thing that is not as the scene asked; empty if verified.
    worst_condition : float
        Largest departure from a prescribed condition, in units Dw = L = 1; loads relative.
    residual_between_nodes : float
        Largest relative defect of the differential equations between the stages.
    law_residual : float
        Largest difference at the stages between the strains and those that the inverse law gives
        for the moments, relative to the largest strain.
    drift : mapping
        Drift of the invariants `n`, `n_dot_m`, `H` (relative) and `orthonormality` at the nodes;
        under loads of those that they leave, by name, such as `H + f.r`.
    """

    problems: tuple[str, ...]
    worst_condition: float
    residual_between_nodes: float
    law_residual: float
    drift: Mapping[str, float]

    @property
    def known(self) -> bool:
        """Whether anything was checked."""
        return not math.isnan(self.worst_condition) or bool(self.problems)

    @property
    def invariant(self) -> float:
        """Drift of H or, under dead loads, of what is constant in its place."""
        return self.drift.get("H + f.r", self.drift["H"])


def unverified() -> Verification:
    """Return the verification of a solve that did not converge: nothing is known."""
    nan = float("nan")
    drift = {name: nan for name in ("n", "n_dot_m", "H", "orthonormality")}
    return Verification((), nan, nan, nan, drift)
