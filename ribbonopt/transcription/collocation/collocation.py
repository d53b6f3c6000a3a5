"""Collocation: a boundary-value problem on a mesh as an NLP, and its dense output.

Integral form: with F_j the derivatives at the K stages of an element of width h that starts at x_0,

    X_i = x_0 + h sum_j a_ij F_j,        x_1 = x_0 + h sum_j b_j F_j.

Between the nodes x is the polynomial x_0 + h sum_j F_j integral(l_j), z interpolates the stages.
"""

from __future__ import annotations

from collections.abc import Callable

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import TranscriptionError
from ribbonopt.problem.contract import BoundaryValueProblem
from ribbonopt.transcription.functions import condition_functions, stage_functions
from ribbonopt.transcription.known import Known
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.nlp import NLP, NLPFunctions
from ribbonopt.transcription.points import Conditions
from ribbonopt.transcription.tableaus import Tableau, gauss, lobatto, radau

from .blocks import ElementBlocks
from .output import DenseOutput

SCHEMES: dict[str, Callable[[int], Tableau]] = {"gauss": gauss, "radau": radau, "lobatto": lobatto}


@dataclass(frozen=True, eq=False)
class CollocationMethod:
    """Collocation by one tableau, the same in every phase."""

    tableau: Tableau

    @classmethod
    def named(cls, scheme: str, degree: int) -> CollocationMethod:
        """Return the collocation of a named scheme; raises TranscriptionError for others."""
        if scheme not in SCHEMES:
            raise TranscriptionError(
                f"collocation scheme: found {scheme!r}, expected one of {', '.join(SCHEMES)}"
            )
        return cls(SCHEMES[scheme](degree))

    @property
    def name(self) -> str:
        """Name of the tableau, such as "gauss 6"."""
        return self.tableau.name

    def transcribe(self, bvp: BoundaryValueProblem, elements: tuple[int, ...]) -> NLP:
        """NLP of `bvp` with `elements[i]` elements in phase i."""
        if len(elements) != len(bvp.phases):
            raise TranscriptionError(
                f"the mesh has {len(elements)} phases, the problem has {len(bvp.phases)}"
            )
        phases, conditions = stage_functions(bvp), condition_functions(bvp)
        layout = Layout(
            nx=bvp.state.numel(),
            nz=bvp.algebraic.numel(),
            nc=bvp.constants.numel(),
            ng=bvp.phases[0].algebraic.numel(),
            nh=bvp.phases[0].path.numel(),
            stages=self.tableau.degree,
            elements=elements,
            conditions=len(bvp.conditions),
            known=bvp.known.numel(),
            places=tuple(self.tableau.nodes.tolist()),
        )
        n_theta = bvp.parameters.numel()

        def build() -> NLPFunctions:
            # Imported here: Newton on element blocks never needs the sparse functions.
            from .assembly import Assembler

            return Assembler(layout, self.tableau, phases, conditions, n_theta).functions()

        blocks = ElementBlocks(layout, self.tableau, phases, Conditions(layout, conditions))

        def read(w: Array, p: Array, known: Known | None) -> DenseOutput:
            return DenseOutput(blocks, w, p, known)

        return NLP(
            unknowns=layout.unknowns,
            equations=layout.equations,
            parameters=n_theta + sum(layout.parameter_sizes),
            inequality=layout.is_inequality(),
            has_cost=any(p.cost is not None for p in bvp.phases),
            build=build,
            read=read,
            layout=layout,
            structure=blocks,
        )
