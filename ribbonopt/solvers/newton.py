"""Newton's method for square systems: damped by the natural monotonicity test, factors kept.

A step dx is judged by the simplified step that the same factors give at its end (Deuflhard's
natural test, invariant under linear changes of the equations). While these contract by `KEEP` or
better the factors are kept, at the price of one residual a step. (Broyden's updates of the kept
factors were tried: two steps fewer, no time gained.)
"""

from __future__ import annotations

import time
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription import NLP
from ribbonopt.transcription.collocation.compiled import CompiledChain, CompiledFactors

from .status import SolveReport, Status
from .systems import ElementSystem, RelaxedSystem, SparseSystem

if TYPE_CHECKING:
    from .protocols import Factors, System

KEEP = 0.1
INHERIT = 0.3  # contraction with which factors of other equations are kept: they cost nothing
SMALLEST_DAMPING = 1e-4
ROUNDING = 1e3 * np.finfo(float).eps
#: what the kernel's Newton method ended with, in the order of its numbers
COMPILED_STATUS = (
    Status.CONVERGED,
    Status.MAX_ITERATIONS,
    Status.SINGULAR,
    Status.INVALID_NUMBER,
    Status.STALLED,
)


@dataclass(frozen=True, eq=False)
class NewtonSolver:
    """Newton's method on one square NLP; `tolerance` is relative to 1 + |w|, entry by entry.

    Where a direction may be `neutral`, which leads from solution to solution, steps leave it alone.
    """

    nlp: NLP
    tolerance: float = 1e-13
    max_iterations: int = 50
    neutral: bool = False

    @cached_property
    def system(self) -> System:
        """How this NLP is evaluated and factored, built at first use and kept."""
        structure = self.nlp.structure
        return (
            SparseSystem(self.nlp) if structure is None else ElementSystem(structure, self.neutral)
        )

    def build(self) -> None:
        """Build the system now rather than at the first solve."""
        self.system.build()

    def solve(
        self,
        w: Array,
        p: Array,
        relaxed: Array | None = None,
        enough: float = 0.0,
        system: System | None = None,
        factors: Factors | None = None,
        most: int | None = None,
    ) -> SolveReport:
        """Solve from the guess w (nw,) for the parameters p (np,).

        `relaxed` (nb,) are residuals that the conditions shall have instead of zero; `enough` is a
        tolerance that will do, where it is larger than the solver's own; `system` is solved instead
        of the program's own equations; `factors` are those of equations nearby, of the same sizes,
        which are used as long as they contract by `INHERIT`; `most` iterations, if that is fewer.
        """
        if not self.nlp.square:
            return _Run(self, w, p).report(Status.NOT_SQUARE)
        run = _Run(self, np.array(w, dtype=float), np.asarray(p, dtype=float))
        run.tolerance = max(self.tolerance, enough)
        run.system = system or run.system
        run.factors = factors
        run.most = min(self.max_iterations, most or self.max_iterations)
        if relaxed is not None:
            if not isinstance(self.system, ElementSystem):
                raise TypeError("conditions can be relaxed where the program has element blocks")
            run.system = RelaxedSystem(self.system, relaxed)
        with np.errstate(all="ignore"):
            return run.report(run.iterate())


class _Run:
    """One solve: the iterate, its counters and its clock."""

    def __init__(self, settings: NewtonSolver, w: Array, p: Array) -> None:
        self.settings, self.w, self.p = settings, w, p
        self.most = settings.max_iterations
        self.system: System = settings.system
        self.factors: Factors | None = None
        self.residuals: Array | None = None
        self.tolerance = settings.tolerance
        self.iterations = self.factorizations = 0
        self.evaluate = self.linear = 0.0
        self.started = time.perf_counter()

    def iterate(self) -> Status:
        """Iterate until an end is reached."""
        if isinstance(self.system, ElementSystem | RelaxedSystem) and self.system.compiled:
            given = self.factors
            if given is None or isinstance(given, CompiledFactors):
                return self._compiled(self.system.compiled, given)
        if self.factors is not None and self._with_inherited_factors():
            return Status.CONVERGED
        damping = 1.0
        while self.iterations < self.most:
            try:
                step = self._newton_step()
            except np.linalg.LinAlgError:
                return Status.SINGULAR
            if not np.isfinite(step).all():
                return Status.INVALID_NUMBER
            damping = min(1.0, 4 * damping)
            status, damping = self._with_these_factors(step, damping)
            if status is not None:
                return status
        return Status.MAX_ITERATIONS

    def _compiled(self, chain: CompiledChain, given: CompiledFactors | None) -> Status:
        """Iterate in the compiled kernel: the same steps."""
        relaxed = self.system.conditions if isinstance(self.system, RelaxedSystem) else None
        settings = self.tolerance, KEEP, INHERIT, SMALLEST_DAMPING, ROUNDING, self.most
        counts, self.residuals, self.factors = chain.newton(
            self.w, self.p, relaxed, given, settings
        )
        status, self.iterations, self.factorizations, self.evaluate, self.linear = counts
        return COMPILED_STATUS[status]

    def _with_inherited_factors(self) -> bool:
        """Iterate as long as factors of other equations contract; whether that was enough."""
        step = self._simplified_step(self.w)
        while self.iterations < self.most:
            size = self._size(step)
            if not size < np.inf:
                return False
            if size <= self.tolerance:
                self.w = self.w + step
                return True
            self.iterations += 1
            trial = self.w + step
            step = self._simplified_step(trial)
            if not self._size(step) <= INHERIT * size:
                return False
            self.w = trial
        return False

    def _with_these_factors(self, step: Array, damping: float) -> tuple[Status | None, float]:
        """Iterate while the factors are good enough: the end reached, or None; and the damping."""
        while self.iterations < self.most:
            size = self._size(step)
            if size <= self.tolerance:
                self.w = self.w + step
                return Status.CONVERGED, damping
            self.iterations += 1
            trial = self.w + damping * step
            following = self._simplified_step(trial)
            contraction = self._size(following) / size
            if not contraction <= 1 - damping / 4:  # also where it is not a number
                if damping < SMALLEST_DAMPING:
                    return self._stalled(), damping
                damping /= 4
                continue
            self.w = trial
            if damping < 1:
                break
            step = following
            if contraction > KEEP and self._size(step) > self.tolerance:
                break
        return None, damping

    def _stalled(self) -> Status:
        # At the limit of rounding no step contracts any more; the iterate is as good as it gets.
        residuals = self.system.vector(self.w, self.p)
        attainable = ROUNDING * (1 + np.abs(self.w).max())
        return Status.CONVERGED if np.abs(residuals).max() <= attainable else Status.STALLED

    def _size(self, step: Array) -> float:
        return float((np.abs(step) / (1 + np.abs(self.w))).max(initial=0.0))

    def _newton_step(self) -> Array:
        start = time.perf_counter()
        residuals, derivatives = self.system.linearize(self.w, self.p)
        middle = time.perf_counter()
        factors = self.system.factor(derivatives, self.p)
        step = factors.solve(residuals)
        self.factors = factors
        self.evaluate += middle - start
        self.linear += time.perf_counter() - middle
        self.factorizations += 1
        return step

    def _simplified_step(self, w: Array) -> Array:
        start = time.perf_counter()
        residuals = self.system.residuals(w, self.p)
        middle = time.perf_counter()
        assert self.factors is not None
        step = self.factors.solve(residuals)
        self.evaluate += middle - start
        self.linear += time.perf_counter() - middle
        return step

    def report(self, status: Status) -> SolveReport:
        """Return what happened."""
        own = self.residuals
        return SolveReport(
            status=status,
            w=self.w,
            multipliers=np.zeros(len(self.w)),
            residuals=self.system.vector(self.w, self.p) if own is None else own,
            iterations=self.iterations,
            factorizations=self.factorizations,
            evaluate=self.evaluate,
            linear=self.linear,
            total=time.perf_counter() - self.started,
            solver="newton",
            factors=self.factors,
        )
