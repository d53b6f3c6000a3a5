"""The nonlinear program that solvers see: numbers in, numbers out, no meaning.

    minimise f(w, p)   subject to   g(w, p) = 0, or <= 0 where `inequality` says so

A square program (as many equations as unknowns, no cost, no inequality) may expose its element
blocks; Newton then eliminates element by element, and the sparse functions are never built.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import TranscriptionError

from .known import Known
from .layout import Layout

if TYPE_CHECKING:
    from .structure import Blocks, Output


@dataclass(frozen=True, eq=False)
class NLPFunctions:
    """CasADi functions of the sparse program.

    `cost` (w, p) -> f; `constraints` (w, p) -> g; `jacobian` (w, p) -> (g, dg/dw);
    `hessian` (w, p, lam_f, lam_g) -> upper triangle of the Hessian of the Lagrangian.
    """

    cost: ca.Function
    constraints: ca.Function
    jacobian: ca.Function
    hessian: ca.Function


@dataclass(frozen=True, eq=False)
class NLP:
    """One program.

    `build` makes its sparse functions when a solver first asks for them, `read` the output of
    unknowns w and parameters p.
    """

    unknowns: int
    equations: int
    parameters: int
    inequality: NDArray[np.bool_]
    has_cost: bool
    build: Callable[[], NLPFunctions]
    read: Callable[[Array, Array, Known | None], Output]
    layout: Layout
    structure: Blocks | None

    @property
    def blocks(self) -> Blocks:
        """Element blocks; TranscriptionError where the transcription has no such structure."""
        if self.structure is None:
            raise TranscriptionError("this transcription is not made of collocation elements")
        return self.structure

    @property
    def square(self) -> bool:
        """Whether the program is a system of equations with as many unknowns."""
        unconstrained = not self.has_cost and not self.inequality.any()
        return unconstrained and self.unknowns == self.equations

    def output(self, w: Array, p: Array, known: Known | None = None) -> Output:
        """Return a solution w (nw,) for p (np,) to be read anywhere; `known` are its fields."""
        return self.read(w, p, known)

    @cached_property
    def functions(self) -> NLPFunctions:
        """The sparse functions, built at first use."""
        return self.build()
