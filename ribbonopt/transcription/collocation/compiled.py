"""The compiled kernel's twin of a collocation system: the same numbers as `blocks`, in C.

What it takes: no path inequalities, as many algebraic variables as equations, a square system, and
functions whose instructions the kernel knows. For all else there is no twin, and numpy does it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.kernel import COMPILED
from ribbonopt.transcription.buffered import plain
from ribbonopt.transcription.functions import StageFunctions
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.points import Conditions
from ribbonopt.transcription.residuals import Derivatives, Residuals
from ribbonopt.transcription.tableaus import Tableau

from .splitting import integrated_states

if TYPE_CHECKING:
    from ribbonopt.kernel._compiled import Chain, Factors, Program

Counts = tuple[int, int, int, float, float]


@dataclass(frozen=True, eq=False)
class CompiledFactors:
    """Factors of a Newton matrix, maybe for the stages' part of one residual only."""

    chain: CompiledChain
    factors: Factors
    only: Residuals | None = None

    def solve(self, residuals: Residuals) -> Array:
        """Newton step (nw,): minus the inverse of the Jacobian times the residuals."""
        if self.only is not None and residuals.stages is not self.only.stages:
            raise ValueError("these factors are for other residuals of the stages")
        step = np.empty(self.chain.layout.unknowns)
        self.factors.solve(residuals.vector(), step)
        return step

    @property
    def determinant(self) -> tuple[float, float]:
        """Sign and logarithm of the determinant, all nodes but the first eliminated."""
        sign, log = self.factors.determinant
        return sign, log


@dataclass(frozen=True, eq=False)
class CompiledChain:
    """Evaluates and factors a collocation system, and iterates on it; shapes as in `structure`."""

    layout: Layout
    twin: Chain

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Residuals at the unknowns w for the parameters p."""
        found = np.empty(self.layout.equations)
        self.twin.residuals(plain(w), plain(p), found)
        return self._parts(found)

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Residuals and derivative blocks at w for p."""
        lay = self.layout
        found = np.empty(lay.equations)
        stages = np.empty((lay.element_count, lay.stages, lay.nv + lay.nc, lay.stage_equations))
        conditions = np.empty(((len(lay.elements) + 1) * lay.nx + lay.nc, lay.conditions))
        self.twin.linearize(plain(w), plain(p), found, stages, conditions)
        return self._parts(found), Derivatives(stages.swapaxes(2, 3), conditions.T)

    def factor(
        self, derivatives: Derivatives, p: Array, only: Residuals | None = None
    ) -> CompiledFactors:
        """Factors of the Jacobian, maybe for some residuals only; LinAlgError if singular."""
        factors = self.twin.factor(
            plain(derivatives.stages.swapaxes(2, 3)),
            plain(derivatives.conditions.T),
            plain(self.layout.widths(p)),
            None if only is None else only.vector(),
        )
        if factors is None:
            raise np.linalg.LinAlgError("singular Jacobian")
        return CompiledFactors(self, factors, only)

    def newton(
        self,
        w: Array,
        p: Array,
        relaxed: Array | None,
        factors: CompiledFactors | None,
        settings: tuple[float, float, float, float, float, int],
    ) -> tuple[Counts, Array, CompiledFactors | None]:
        """Iterate from w (nw,), in place, as `ribbonopt.solvers.newton` does.

        Returns
        -------
        tuple, array, CompiledFactors or None
            Number of the status, iterations, factorizations, seconds of evaluations and of linear
            algebra; residuals (nw,) at the end; the last factors.
        """
        residuals = np.empty(self.layout.equations)
        given = None if factors is None else factors.factors
        relaxed = None if relaxed is None else plain(relaxed)
        found = self.twin.newton(w, plain(p), relaxed, given, residuals, settings)
        kept = None if found[5] is None else CompiledFactors(self, found[5])
        return found[:5], residuals, kept

    def _parts(self, found: Array) -> Residuals:
        lay = self.layout
        elements = found[: lay.conditions_at].reshape(lay.element_count, -1)
        stages = elements[:, : -lay.nx].reshape(lay.element_count, lay.stages, -1)
        return Residuals(stages, elements[:, -lay.nx :], found[lay.conditions_at :])


def compiled_chain(
    layout: Layout, tableau: Tableau, phases: Sequence[StageFunctions], conditions: Conditions
) -> CompiledChain | None:
    """Return the twin of a collocation system, or None where there is none.

    Where the layout has another number of conditions than there are functions for, it is only to
    be eliminated.
    """
    lay, ends = layout, conditions.functions
    square = lay.ng == lay.nz and lay.conditions == lay.nx + lay.nc
    if COMPILED is None or lay.nh or not square:
        return None
    programs: list[Program] = []
    if lay.conditions == ends.conditions.numel():
        found = [p for f in phases for p in (f.mapped_values.program, f.mapped_dense.program)]
        found += [ends.buffered_values.program, ends.buffered_dense.program]
        programs = [program for program in found if program is not None]
        if len(programs) < len(found):
            return None
    apart = integrated_states(phases, lay.nx).tolist()
    others = [i for i in range(lay.nv) if i not in apart]
    n_theta = phases[0].inputs[2].numel()
    sizes = lay.stages, lay.nx, lay.nz, lay.nc, lay.conditions, lay.known, n_theta
    numbers = np.concatenate([tableau.matrix.ravel(), tableau.weights, tableau.nodes])
    points = list(lay.point_elements)
    twin = COMPILED.Chain(points, sizes, numbers, others, apart, tuple(programs))
    return CompiledChain(layout, twin)
