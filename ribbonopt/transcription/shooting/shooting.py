"""Multiple shooting: nodes and constants are the only unknowns, elements are integrated.

With Phi the one-step method of `steps` equal steps over an element of relative width h,

    x_{e+1} - Phi(x_e, c, theta, sigma_e, h) = 0,      b(x at the ends of all phases, c, theta) = 0.

One element is single shooting. There are no unknowns inside an element on which a cost, a control
or a path inequality could act.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import TranscriptionError
from ribbonopt.problem.contract import BoundaryValueProblem
from ribbonopt.transcription.functions import condition_functions, stage_functions
from ribbonopt.transcription.known import Known
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.nlp import NLP, NLPFunctions
from ribbonopt.transcription.points import Conditions
from ribbonopt.transcription.tableaus import gauss

from .blocks import Flow, ShootingBlocks
from .implicit import ImplicitStep, algebraic_function
from .output import ShootingOutput
from .runge_kutta import rk4, rk8
from .steps import Explicit, Method

METHODS: dict[str, Callable[[int], Method]] = {
    "rk4": lambda _: Explicit(rk4()),
    "rk8": lambda _: Explicit(rk8()),
    "gauss": lambda degree: ImplicitStep(gauss(degree)),
}


@dataclass(frozen=True, eq=False)
class MultipleShooting:
    """Multiple shooting by `steps` equal steps of one method in every element."""

    method: Method
    steps: int = 1

    def __post_init__(self) -> None:
        """Refuse less than one step."""
        if self.steps < 1:
            raise TranscriptionError(f"steps of an interval: found {self.steps}, expected >= 1")

    @classmethod
    def named(cls, scheme: str, degree: int = 3, steps: int = 1) -> MultipleShooting:
        """Return shooting by a named scheme; `degree` is that of "gauss"."""
        if scheme not in METHODS:
            raise TranscriptionError(
                f"shooting scheme: found {scheme!r}, expected one of {', '.join(METHODS)}"
            )
        return cls(METHODS[scheme](degree), steps)

    @property
    def name(self) -> str:
        """Method and steps in each interval, such as "rk8 x 2"."""
        return f"{self.method.name} x {self.steps}"

    def transcribe(self, bvp: BoundaryValueProblem, elements: tuple[int, ...]) -> NLP:
        """NLP of `bvp` with `elements[i]` elements in phase i.

        Raises
        ------
        TranscriptionError
            If shooting, or this method, does not serve the problem.
        """
        if len(elements) != len(bvp.phases):
            raise TranscriptionError(
                f"the mesh has {len(elements)} phases, the problem has {len(bvp.phases)}"
            )
        self._refuse(bvp)
        conditions = condition_functions(bvp)
        layout = Layout(
            nx=bvp.state.numel(),
            nz=bvp.algebraic.numel(),
            nc=bvp.constants.numel(),
            ng=bvp.algebraic.numel(),
            nh=0,
            stages=0,
            elements=elements,
            conditions=len(bvp.conditions),
            known=bvp.known.numel(),
            places=self._places,
        )
        flows = self._flows(bvp)
        n_theta = bvp.parameters.numel()

        def build() -> NLPFunctions:
            # Imported here: Newton on element blocks never needs the sparse functions.
            from .assembly import shooting_functions

            return shooting_functions(layout, flows, conditions, n_theta)

        blocks = ShootingBlocks(
            layout, self.method, self.name, flows, Conditions(layout, conditions)
        )

        def read(w: Array, p: Array, known: Known | None) -> ShootingOutput:
            return ShootingOutput(blocks, w, p, known)

        return NLP(
            unknowns=layout.unknowns,
            equations=layout.equations,
            parameters=n_theta + sum(layout.parameter_sizes),
            inequality=layout.is_inequality(),
            has_cost=False,
            build=build,
            read=read,
            layout=layout,
            structure=blocks,
        )

    @property
    def _places(self) -> tuple[float, ...]:
        """Positions in an element where its steps read known fields."""
        steps = range(self.steps)
        return tuple((i + place) / self.steps for i in steps for place in self.method.places)

    def _flows(self, bvp: BoundaryValueProblem) -> tuple[Flow, ...]:
        nx, nz = bvp.state.numel(), bvp.algebraic.numel()
        given = bvp.algebraic_start if bvp.algebraic_start.numel() else ca.SX.zeros(nz)
        result, begin = [], bvp.start
        for phase, stage in zip(bvp.phases, stage_functions(bvp), strict=True):
            position = begin + stage.inputs[3][0] * phase.length
            start = ca.substitute(given, bvp.position, position)
            step = self.method.step(stage, nx, start).repeated(self.steps)
            result.append(Flow(stage, step, algebraic_function(stage, nx, start), self.steps))
            begin = begin + phase.length
        return tuple(result)

    def _refuse(self, bvp: BoundaryValueProblem) -> None:
        """Raise TranscriptionError for a problem that shooting or this method does not serve."""
        nz = bvp.algebraic.numel()
        if any(phase.cost is not None for phase in bvp.phases):
            raise TranscriptionError(
                "shooting solves equations and cannot minimise a cost; use collocation"
            )
        if any(phase.algebraic.numel() != nz for phase in bvp.phases):
            raise TranscriptionError(
                f"shooting determines {nz} algebraic variables from as many equations, found "
                f"{bvp.phases[0].algebraic.numel()}, and cannot choose controls; use collocation"
            )
        if any(phase.path.numel() for phase in bvp.phases):
            raise TranscriptionError(
                "shooting has no unknowns inside the intervals on which path inequalities could "
                "act; use collocation, or leave the inequalities out"
            )
        if nz and self.method.explicit:
            raise TranscriptionError(
                f"{self.method.name} is explicit and integrates ordinary differential equations "
                f"only, found {nz} algebraic variables; use shooting with scheme gauss, or "
                "collocation"
            )
