"""What solvers and accuracy checks may ask of a discretised problem, whatever the transcription.

A square problem falls into elements, chained by their nodes: `Blocks` evaluate residuals and
derivatives element by element, an `Elimination` reduces an element to one relation between its two
nodes, an `Output` reads a solution between the nodes. Collocation (`ElementBlocks`, `DenseOutput`)
and shooting (`ShootingBlocks`, `ShootingOutput`) fulfil these interfaces.

These interfaces are for the type checker; nothing imports them when it runs.

Shapes: N elements, K stages (none in shooting), nx states, nv = nx + nz unknowns of a stage, ne =
nx + ng + nh equations of a stage, nc constants, P + 1 points.
"""

from __future__ import annotations

from typing import Protocol

from ribbonopt.arrays import Array

from .collocation.compiled import CompiledChain
from .known import Known
from .layout import Layout
from .residuals import Derivatives, Residuals, Share


class Elimination(Protocol):
    """Elements reduced to their nodes: A_e x_e + B_e x_{e+1} + C_e c = d_e."""

    @property
    def relations(self) -> tuple[Array, Array, Array]:
        """A (N, nx, nx), B (N, nx, nx) and C (N, nx, nc)."""

    def reduce(self, residuals: Residuals) -> tuple[Array, Share]:
        """Right-hand sides d (N, nx), and the stages' share of them for `expand`."""

    def expand(self, nodes: Array, constants: Array, share: Share) -> Array:
        """Newton steps of the stages (N, K nv) from those of nodes (N+1, nx) and constants."""


class Blocks(Protocol):
    """A square problem, evaluated element by element; the layout makes the parameters p."""

    @property
    def layout(self) -> Layout:
        """Places of unknowns and equations."""

    @property
    def name(self) -> str:
        """Transcription, as reports call it."""

    @property
    def degree(self) -> int:
        """Number of stages of the method, eliminated or not."""

    @property
    def order(self) -> int:
        """Order of the error at the nodes."""

    @property
    def symplectic(self) -> bool:
        """Whether quadratic invariants are kept to rounding."""

    def build(self) -> None:
        """Build all functions now rather than at the first evaluation."""

    @property
    def bordered(self) -> Blocks:
        """The same with one more constant and one more condition: to eliminate, not to evaluate."""

    def values(self, w: Array, p: Array) -> tuple[Array, Array]:
        """Return what `linearize` derives: (N, K, ne), or (N, 1, nx) without stages; conditions."""

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Return the residuals at the unknowns w."""

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Return residuals and derivative blocks at w."""

    @property
    def compiled(self) -> CompiledChain | None:
        """The same in the compiled kernel, where that is there and takes it."""

    def eliminate(
        self, derivatives: Derivatives, p: Array, only: Residuals | None = None
    ) -> Elimination:
        """Reduce the elements to their nodes; LinAlgError where an element is singular.

        Quicker where it is for the stages' part of the residuals `only`.
        """

    def growth(self, derivatives: Derivatives, p: Array) -> Array:
        """Exponents (N,) by which neighbouring solutions part in each element, or meet."""

    def widths(self, p: Array) -> Array:
        """Relative widths (N,) of the elements."""

    def stage_positions(self, p: Array) -> Array:
        """Relative position (N, K) of every stage in its phase."""

    @property
    def finer(self) -> tuple[Blocks, int]:
        """The same equations on a better scheme, and the parts of each element."""

    def sampled(self, output: Output, p: Array) -> Array:
        """Unknowns w that stand for an output of the same problem, on any elements."""

    def of_finer(self, w: Array) -> Array:
        """Unknowns (nw,) that stand for such of `finer`, or for their derivatives: linear in w."""


class Output(Protocol):
    """A solution anywhere; positions are relative to their phase."""

    @property
    def blocks(self) -> Blocks:
        """The discretised equations."""

    @property
    def w(self) -> Array:
        """Unknowns (nw,)."""

    @property
    def p(self) -> Array:
        """Parameters (np,), as the layout packs them."""

    @property
    def known(self) -> Known | None:
        """The known fields that p was sampled from, if the problem has any."""

    @property
    def order(self) -> int:
        """Order of the error of `states` between the nodes."""

    @property
    def theta(self) -> Array:
        """Parameters of the problem."""

    @property
    def constants(self) -> Array:
        """Unknown constants c."""

    @property
    def at_nodes(self) -> Array:
        """States (N + 1, nx) at the nodes of all phases."""

    def nodes(self, phase: int) -> Array:
        """Relative positions (n + 1,) of the nodes of a phase."""

    def moved(self, step: Array) -> Output:
        """Return the output of the unknowns w + step (nw,)."""

    def refined(self) -> tuple[Output, int]:
        """Return this output on the next better scheme, and the parts of each element."""

    def approximate(self, phase: int, sigma: Array) -> Array:
        """Unknowns v (k, nv) at relative positions sigma (k,): quick, fit to start Newton on."""

    def states(self, phase: int, sigma: Array) -> Array:
        """States x (k, nx) at the relative positions sigma (k,)."""

    def many(self, phase: int, sigma: Array) -> Array:
        """States x (k, nx) as `states`, to rounding or errors of its order; soon at many places."""

    def algebraic(self, phase: int, sigma: Array) -> Array:
        """Algebraic variables z (k, nz) at the relative positions sigma (k,)."""

    def stages(self, phase: int) -> tuple[Array, Array, Array]:
        """Values v (k, nv), relative positions (k,) and weights (k,) of a quadrature."""

    @property
    def growth(self) -> Array:
        """Exponents (N,) of elements: where large, less is known between nodes than at them."""

    def decay(self) -> Array:
        """Sizes (N, K) of the Legendre coefficients of x' in every element; (N, 0) if unknown."""

    def residual_between_nodes(self) -> Array:
        """Relative defects (N, k) of the differential equations inside every element."""
