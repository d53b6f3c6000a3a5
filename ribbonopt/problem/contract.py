"""The contract between mechanics and transcription: a multi-phase boundary-value problem.

Semi-explicit differential-algebraic optimal control: states x(s), algebraic variables or controls
z(s), unknown constants c, numeric parameters theta, known fields k(s),

    x' = f(s, x, z, c, theta, k)   0 = g(s, x, z, c, theta, k)   h(s, x, z, c, theta, k) <= 0
    b(x and k at the ends of all phases, c, theta) = 0           minimise  integral of l(...)

on consecutive phases. States are continuous from one phase to the next; a phase's length may hold
unknown constants. No cost and as many conditions as unknowns is a square problem. Every formulation
is an instance, every transcription consumes it, none asks which it is.

Known fields are data along s (a measured width, a load from a file, the time step before). They are
numbers as theta is: a program is built once and evaluated with any of them, see
`ribbonopt.transcription.known`. A field belongs to relative positions in its phase: where a length
is unknown it stretches with the phase (`ribbonopt.transcription.fields` has fields of s).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import Any, TypeVar

import casadi as ca

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Phase:
    """One interval with its own equations.

    Attributes
    ----------
    dynamics : SX (nx,)
        f, derivatives of the states with respect to arclength.
    algebraic : SX (ng,)
        g, zero along the phase.
    path : SX (nh,)
        h, not positive along the phase.
    cost : SX scalar or None
        l, density of the cost per length.
    length : SX scalar
        Length of the phase, from constants and parameters.
    outputs : mapping of str to SX
        Expressions to sample on a solution.
    singular : SX (k, 4)
        Rows (a, b, size, fades): where a + ib is zero at complex s, equations are singular, by as
        much as size says. Of use to meshes and error bars.
    """

    dynamics: ca.SX
    length: ca.SX
    outputs: Mapping[str, ca.SX]
    algebraic: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    path: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    cost: ca.SX | None = None
    singular: ca.SX = field(default_factory=lambda: ca.SX(0, 4))


@dataclass(frozen=True, eq=False)
class BoundaryValueProblem:
    """Symbols, equations and names of one problem; see the module for the mathematics.

    Attributes
    ----------
    position : SX scalar symbol
        Arclength s.
    state, algebraic, constants, parameters : SX column symbols
        x, z, c and theta; `*_names` name their entries in order.
    start : SX scalar
        Arclength of the start of the first phase, from constants and parameters.
    points : tuple of SX symbols
        States at the start, at the interior phase boundaries and at the end.
    conditions : mapping of str to SX scalar
        b, by the name a user knows the condition under.
    local, estimate : SX symbols, SX
        What any guess knows at a point, and from it the last states and the algebraic variables.
    algebraic_start : SX (nz,)
        Where to start solving the algebraic equations, from states, constants, parameters and k.
    costate, recovered : SX symbols (nx,), mapping of str to SX
        Costates at the start, and parameters whose values follow from them once a problem with a
        cost is solved; until then they enter outputs only.
    completed : SX (nx,) or None
        States with what was recovered, from states and parameters, where they hold any of it.
    slack : int
        How many constants, the last, relax conditions that are too many: zero where these agree.
    known : SX column symbol (nk,)
        k, in dynamics, algebraic equations, inequalities, costs and outputs of the phases.
    known_at : tuple of SX symbols (nk,)
        k at each of the points, for conditions; empty if no condition contains it.
    conserved : tuple of str
        Outputs that are constant along the solution, and yet not by construction.
    neutral : bool
        Whether one direction may lead from solution to solution, so that they are not isolated.
    stations : tuple of int
        Which of the points are at known places, where something acts or holds.
    """

    position: ca.SX
    state: ca.SX
    algebraic: ca.SX
    constants: ca.SX
    parameters: ca.SX
    start: ca.SX
    phases: tuple[Phase, ...]
    points: tuple[ca.SX, ...]
    conditions: Mapping[str, ca.SX]
    state_names: tuple[str, ...]
    constant_names: tuple[str, ...]
    parameter_names: tuple[str, ...]
    local: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    estimate: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    algebraic_start: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    costate: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    recovered: Mapping[str, ca.SX] = field(default_factory=dict)
    completed: ca.SX | None = None
    slack: int = 0
    known: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    known_at: tuple[ca.SX, ...] = ()
    known_names: tuple[str, ...] = ()
    conserved: tuple[str, ...] = ()
    neutral: bool = False
    stations: tuple[int, ...] = ()
    _kept: dict[Callable[..., Any], Any] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        """Refuse a problem whose parts do not fit together."""
        if len(self.points) != len(self.phases) + 1:
            raise ModelError(
                f"{len(self.phases)} phases need {len(self.phases) + 1} points, "
                f"found {len(self.points)}"
            )
        if self.known_at and len(self.known_at) != len(self.points):
            raise ModelError(
                f"known fields at the points: {len(self.points)} points, expected as many symbols, "
                f"found {len(self.known_at)}"
            )
        if any(part.shape != self.known.shape for part in self.known_at):
            raise ModelError(
                f"known fields at the points are expected to have shape {self.known.shape} each"
            )
        for i, phase in enumerate(self.phases):
            if phase.dynamics.shape != self.state.shape:
                raise ModelError(
                    f"phase {i}: dynamics are expected to have shape {self.state.shape}, "
                    f"found {phase.dynamics.shape}"
                )
            counts = [(p.algebraic.numel(), p.path.numel()) for p in (phase, self.phases[0])]
            if counts[0] != counts[1]:
                raise ModelError(
                    f"phase {i}: {counts[0]} algebraic equations and path inequalities, expected "
                    f"as many as in phase 0, {counts[1]}"
                )
            if self.square and phase.algebraic.numel() != self.algebraic.numel():
                raise ModelError(
                    f"phase {i}: {self.algebraic.numel()} algebraic variables need as many "
                    f"algebraic equations, found {phase.algebraic.numel()}"
                )

    @property
    def square(self) -> bool:
        """Whether there is nothing to minimise and no inequality: equations only."""
        return all(p.cost is None and p.path.numel() == 0 for p in self.phases)

    @cached_property
    def lengths(self) -> int:
        """How many constants, before any slack, are lengths of phases: none if they are known."""
        lengths = ca.vertcat(*(phase.length for phase in self.phases))
        return len(self.phases) - 1 if ca.depends_on(lengths, self.constants) else 0

    @property
    def unknown_count(self) -> int:
        """Numbers that the conditions must determine: states at one point and constants."""
        return int(self.state.numel() + self.constants.numel())

    def contains(self, parameter: int) -> bool:
        """Whether any equation, condition or length contains a parameter, by its place."""
        parts = [self.start, *self.conditions.values()]
        for phase in self.phases:
            parts += [phase.dynamics, phase.algebraic, phase.path, phase.length]
            parts += [] if phase.cost is None else [phase.cost]
        return bool(ca.depends_on(ca.vertcat(*parts), self.parameters[parameter]))

    def kept(self, make: Callable[[BoundaryValueProblem], T]) -> T:
        """Return what is made of this problem, such as its functions: made once, kept with it."""
        if make not in self._kept:
            self._kept[make] = make(self)
        found: T = self._kept[make]
        return found

    @cached_property
    def extent_function(self) -> ca.Function:
        """Function (c, theta) of the arclength where the first phase starts and all lengths."""
        extent = ca.vertcat(self.start, *(phase.length for phase in self.phases))
        return ca.Function("extent", [self.constants, self.parameters], [extent])

    @cached_property
    def output_sizes(self) -> Mapping[str, int]:
        """How many numbers each output is, by name."""
        return {name: int(value.numel()) for name, value in self.phases[0].outputs.items()}

    def output_functions(self, names: Sequence[str]) -> tuple[ca.Function, ...]:
        """For each phase: function (v, c, theta, [s; k]) of these outputs, in a column."""
        chosen = ([phase.outputs[name] for name in names] for phase in self.phases)
        columns = (ca.densify(ca.vertcat(*outputs)) for outputs in chosen)
        return tuple(ca.Function("outputs", self._along, [column]) for column in columns)

    @property
    def placed(self) -> bool:
        """Whether outputs or singularities depend on the place by itself, or on known fields."""
        every = [
            ca.vertcat(*phase.outputs.values(), ca.vec(phase.singular)) for phase in self.phases
        ]
        return bool(ca.depends_on(ca.vertcat(*every), ca.vertcat(self.position, self.known)))

    @cached_property
    def singular_functions(self) -> tuple[ca.Function, ...]:
        """For each phase: function (v, c, theta, [s; k]) of its singularities, row after row."""
        rows = (ca.densify(ca.vec(phase.singular.T)) for phase in self.phases)
        return tuple(ca.Function("singular", self._along, [column]) for column in rows)

    @property
    def _along(self) -> list[ca.SX]:
        """Inputs of functions of one place of a phase."""
        v, place = ca.vertcat(self.state, self.algebraic), ca.vertcat(self.position, self.known)
        return [v, self.constants, self.parameters, place]
