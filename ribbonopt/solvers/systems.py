"""Two ways to evaluate and factor a square NLP: by its element blocks, or as a sparse matrix."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription import NLP
from ribbonopt.transcription.residuals import Derivatives, Residuals

from .condense import factored

if TYPE_CHECKING:
    from ribbonopt.transcription.collocation.compiled import CompiledChain
    from ribbonopt.transcription.structure import Blocks

    from .protocols import Factors


@dataclass(frozen=True, eq=False)
class ElementSystem:
    """A chain of elements, factored element by element (`ribbonopt.solvers.condense`)."""

    blocks: Blocks
    neutral: bool = False

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""
        self.blocks.build()

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Residuals at w."""
        return self.blocks.residuals(w, p)

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Residuals and derivatives at w."""
        return self.blocks.linearize(w, p)

    @property
    def compiled(self) -> CompiledChain | None:
        """The same in the compiled kernel; with a neutral direction numpy does it."""
        return None if self.neutral else self.blocks.compiled

    def factor(self, derivatives: Derivatives, p: Array) -> Factors:
        """Factors of the Jacobian; LinAlgError where it is singular."""
        return factored(self.blocks, derivatives, p, neutral=self.neutral)

    def vector(self, w: Array, p: Array) -> Array:
        """Residuals in the order of the NLP's constraints."""
        return self.blocks.residuals(w, p).vector()


@dataclass(frozen=True, eq=False)
class RelaxedSystem:
    """A chain of elements whose conditions need only be met up to given values (nb,)."""

    system: ElementSystem
    conditions: Array

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""
        self.system.build()

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Residuals at w."""
        return self._relaxed(self.system.residuals(w, p))

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Residuals and derivatives at w."""
        residuals, derivatives = self.system.linearize(w, p)
        return self._relaxed(residuals), derivatives

    @property
    def compiled(self) -> CompiledChain | None:
        """The system in the compiled kernel; with a neutral direction numpy does it."""
        return self.system.compiled

    def factor(self, derivatives: Derivatives, p: Array) -> Factors:
        """Factors of the Jacobian; LinAlgError where it is singular."""
        return self.system.factor(derivatives, p)

    def vector(self, w: Array, p: Array) -> Array:
        """Residuals in the order of the NLP's constraints."""
        return self.residuals(w, p).vector()

    def _relaxed(self, residuals: Residuals) -> Residuals:
        return replace(residuals, conditions=residuals.conditions - self.conditions)


@dataclass(frozen=True, eq=False)
class SparseFactors:
    """Sparse QR factors of one Jacobian."""

    solver: ca.Linsol
    matrix: ca.DM

    def solve(self, residuals: Array) -> Array:
        """Newton step (nw,)."""
        return np.array(self.solver.solve(self.matrix, ca.DM(-residuals))).ravel()


@dataclass(frozen=True, eq=False)
class SparseSystem:
    """Any square NLP, by CasADi's sparse QR on its whole Jacobian."""

    nlp: NLP

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""
        _ = self.nlp.functions

    def residuals(self, w: Array, p: Array) -> Array:
        """Constraint values at w."""
        return np.array(self.nlp.functions.constraints(w, p)).ravel()

    def linearize(self, w: Array, p: Array) -> tuple[Array, ca.DM]:
        """Constraint values and sparse Jacobian at w."""
        values, jacobian = self.nlp.functions.jacobian(w, p)
        return np.array(values).ravel(), jacobian

    def factor(self, derivatives: ca.DM, p: Array) -> SparseFactors:
        """Factors of the Jacobian; LinAlgError where it is singular."""
        solver = ca.Linsol("newton", "qr", derivatives.sparsity())
        try:
            solver.nfact(derivatives)
        except RuntimeError as error:  # the only way CasADi has to say singular
            raise np.linalg.LinAlgError("singular Jacobian") from error
        return SparseFactors(solver, derivatives)

    def vector(self, w: Array, p: Array) -> Array:
        """Constraint values at w."""
        return self.residuals(w, p)
