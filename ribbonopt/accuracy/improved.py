"""A solution put into the next better scheme, and the Newton step of that: what the estimate reads.

Who has factored that scheme already, as continuation does for its tangent, leaves the step with the
trajectory (`found`), and the estimate takes it from there.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.condense import factored
from ribbonopt.solvers.protocols import Factors
from ribbonopt.transcription.residuals import Derivatives, Residuals
from ribbonopt.transcription.structure import Output

from .spin import spins


@dataclass(frozen=True, eq=False)
class Improved:
    """The Newton step of the next better scheme from a solution.

    Attributes
    ----------
    finer, split : Output, int
        The solution on the better scheme, and the parts of each of its elements there.
    residuals : Residuals
        Of the better scheme: local errors.
    step : (nw,) array
        Newton's step from there, in the layout of `finer`.
    growth : (N,) array
        Exponents of the solution's elements by which neighbouring solutions part.
    factors : Factors or None
        Factors of the better scheme, if they are to be kept.
    """

    finer: Output
    split: int
    residuals: Residuals
    step: Array
    growth: Array
    factors: Factors | None = None


def improved(solution: Solution, near: Factors | None = None, *, keep: bool = False) -> Improved:
    """Return the step of the better scheme; LinAlgError if its equations are singular.

    `near` are factors kept from a solution near by; see `ribbonopt.accuracy.estimate.analyse`.
    """
    known = solution.trajectory.found
    if near is None and not keep and Improved in known:
        left: Improved = known.pop(Improved)
        return left
    dense = solution.trajectory.dense
    finer, split = dense.refined()
    blocks, w, p = finer.blocks, finer.w, finer.p
    if near is not None:
        residuals = blocks.residuals(w, p)
        return Improved(finer, split, residuals, near.solve(residuals), dense.growth, near)
    residuals, derivatives = blocks.linearize(w, p)
    only, neutral = None if keep else residuals, spins(solution)
    factors = factored(blocks, derivatives, p, only, neutral)
    growth = growth_of(finer, split, derivatives)
    step = factors.solve(residuals)
    return Improved(finer, split, residuals, step, growth, factors if keep else None)


def growth_of(finer: Output, split: int, derivatives: Derivatives) -> Array:
    """Exponents (N,) of a solution's elements, from derivatives on the better scheme."""
    parts = finer.blocks.growth(derivatives, finer.p)
    return np.asarray(parts.reshape(-1, split).sum(axis=1))
