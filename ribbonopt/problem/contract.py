"""The contract between mechanics and transcription: a multi-phase boundary-value problem.

Semi-explicit differential-algebraic optimal control: states x(s), algebraic variables or controls
z(s), unknown constants c, numeric parameters theta,

    x' = f(s, x, z, c, theta)      0 = g(s, x, z, c, theta)      h(s, x, z, c, theta) <= 0
    b(x at the ends of all phases, c, theta) = 0                 minimise  integral of l(...)

on consecutive phases. States are continuous from one phase to the next; a phase's length may hold
unknown constants. No cost and as many conditions as unknowns is a square problem. Every formulation
is an instance, every transcription consumes it, none asks which it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import casadi as ca

from ribbonopt.errors import ModelError


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
    """

    dynamics: ca.SX
    length: ca.SX
    outputs: Mapping[str, ca.SX]
    algebraic: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    path: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    cost: ca.SX | None = None


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
        Where to start solving the algebraic equations, from states, constants and parameters.
    costate, recovered : SX symbols (nx,), mapping of str to SX
        Costates at the start, and parameters whose values follow from them once a problem with a
        cost is solved; until then they enter outputs only.
    kept : dict
        What others have built for this problem, by who did; it goes with it.
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
    kept: dict[object, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse a problem whose parts do not fit together."""
        if len(self.points) != len(self.phases) + 1:
            raise ModelError(
                f"{len(self.phases)} phases need {len(self.phases) + 1} points, "
                f"found {len(self.points)}"
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

    @cached_property
    def extent_function(self) -> ca.Function:
        """Function (c, theta) of the arclength where the first phase starts and all lengths."""
        extent = ca.vertcat(self.start, *(phase.length for phase in self.phases))
        return ca.Function("extent", [self.constants, self.parameters], [extent])

    @cached_property
    def output_functions(self) -> tuple[tuple[ca.Function, dict[str, int]], ...]:
        """For each phase: function (v, c, theta, s) of its outputs in one column, and sizes."""
        v = ca.vertcat(self.state, self.algebraic)
        inputs = [v, self.constants, self.parameters, self.position]
        result = []
        for phase in self.phases:
            column = ca.densify(ca.vertcat(*phase.outputs.values()))
            sizes = {name: int(value.numel()) for name, value in phase.outputs.items()}
            result.append((ca.Function("outputs", inputs, [column]), sizes))
        return tuple(result)
