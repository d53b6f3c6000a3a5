"""What `source/` offers; arrays are C-contiguous, of float64, and of exactly the sizes wanted.

They may have any shape: sizes are checked, and ValueError names what does not fit.
"""

from collections.abc import Sequence

from ribbonopt.arrays import Array

#: what `ribbonopt.kernel` must have been written for
INTERFACE: int
#: numbers of the operations that programs know, by CasADi's names
OPERATIONS: dict[str, int]

def writhe(count: int, points: Array, /) -> float:
    """Writhe of the closed polygon through points (count, 3)."""

class Program:
    """An SX instruction list: rows of code (count, 5) are operation, out, a, b and a value."""

    def __new__(
        cls, code: Array, count: int, work: int, sizes_in: Sequence[int], sizes_out: Sequence[int]
    ) -> Program: ...
    def map(self, count: int, shared: int, /, *arrays: Array) -> None:
        """Run at `count` points: inputs, then outputs; bits of `shared` tell inputs of all."""

    def accumulate(self, count: int, shared: int, /, *arrays: Array) -> None:
        """Run `count` steps, each from what the one before put out: inputs, then the output.

        The first input is where the first step begins.
        """

class Factors:
    """Factors of a chain's Newton matrix."""

    @property
    def determinant(self) -> tuple[float, float]:
        """Sign and logarithm, all nodes but the first eliminated."""

    def solve(self, residuals: Array, step: Array) -> None:
        """Fill the Newton step (nw,) for residuals (nw,) in the order of the layout."""

class Chain:
    """A collocation system; sizes are (K, nx, nz, nc, nb, nk, nt).

    `ends` are the numbers of elements before each phase, and of all; the tableau is [A, b, c]; `q`
    are the unknowns of a stage to factor, algebraic ones last, `apart` the other states; programs
    are two of each phase (values, with Jacobian), and two of the conditions; or none.
    """

    def __new__(
        cls,
        ends: Sequence[int],
        sizes: tuple[int, ...],
        tableau: Array,
        q: Sequence[int],
        apart: Sequence[int],
        programs: tuple[Program, ...],
    ) -> Chain: ...
    def residuals(self, w: Array, p: Array, residuals: Array) -> None:
        """Fill the residuals (nw,)."""

    def linearize(
        self, w: Array, p: Array, residuals: Array, jacobians: Array, conditions: Array
    ) -> None:
        """Fill residuals, Jacobians (N, K, nv + nc, ne) and ((P + 1) nx + nc, nb), by columns."""

    def factor(
        self, jacobians: Array, conditions: Array, widths: Array, only: Array | None
    ) -> Factors | None:
        """Factor, maybe for the stages of residuals `only`; None where the matrix is singular."""

    def newton(
        self,
        w: Array,
        p: Array,
        relaxed: Array | None,
        factors: Factors | None,
        residuals: Array,
        settings: tuple[float, float, float, float, float, int],
    ) -> tuple[int, int, int, float, float, Factors | None]:
        """Iterate from w, in place; fill the residuals at its end.

        `settings` are tolerance, contractions that keep and inherit factors, smallest damping,
        rounding, and most iterations. Returns number of the status, iterations, factorizations,
        seconds of evaluations and linear algebra, and the last factors.
        """
