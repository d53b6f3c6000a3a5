"""A solution: the frozen result of one solve, to sample, summarise, verify, or use as a guess."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import BoundaryValueProblem, Posed
from ribbonopt.scene import Scene
from ribbonopt.scene.units import Units
from ribbonopt.solvers import Status
from ribbonopt.transcription import Mesh

from .as_guess import unknowns_of
from .at_home import AtHome
from .named import Each
from .sought import Sought
from .trajectory import Trajectory
from .verification import Verification

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Output


@dataclass(frozen=True, eq=False)
class Solution(AtHome):
    """Equilibrium of one ribbon.

    Lab-frame vectors, arclength s as in the scene's interval. What is sampled is in the units of
    the scene, SI or Dw = L = 1; the numbers behind it (`dense`, `constants`, `fields`) are in units
    Dw = L = 1 always.

    Attributes
    ----------
    posed : Posed
        What was asked.
    trajectory : Trajectory
        The equations that were solved and the numbers, all phases read as one.
    status, message : Status, str
        How it ended.
    multipliers : (ng,) array
        Lagrange multipliers of the discretised equations.
    iterations : int
        Iterations of the solver.
    timings : mapping of str to float
        Seconds by kind of work.
    steps : tuple of mappings
        The steps that led here, with their cost.
    skipped, given_up, fell_back : tuples of str
        What it did not need; what it asked for and did not lead here; what was tried before.
    verification : Verification
        What was checked afterwards.
    others : tuple of Solution
        Other equilibria of the scene, of several starts, by increasing energy; `times` is how many
        of those led here.
    sheets : tuple of int
        Kinds of the phases: sign of m2, or 0 for a mixture of both sheets; empty for one phase.
    coarser : Trajectory or None
        Of a minimum, that on elements twice as wide, if it has one: its bars.
    sought : Sought or None
        What a search for all equilibria tells of it, if that has found it.
    """

    posed: Posed
    trajectory: Trajectory
    status: Status
    message: str
    iterations: int
    verification: Verification
    multipliers: Array = field(default_factory=lambda: np.empty(0))
    timings: Mapping[str, float] = field(default_factory=dict)
    steps: tuple[Mapping[str, Any], ...] = ()
    skipped: tuple[str, ...] = ()
    given_up: tuple[str, ...] = ()
    fell_back: tuple[str, ...] = ()
    others: tuple[Solution, ...] = ()
    times: int = 1
    sheets: tuple[int, ...] = ()
    coarser: Trajectory | None = None
    sought: Sought | None = None

    @property
    def scene(self) -> Scene:
        """The scene as it was given."""
        return self.posed.given

    @property
    def problem(self) -> BoundaryValueProblem:
        """The equations that were solved."""
        return self.trajectory.problem

    @property
    def dense(self) -> Output:
        """The numbers."""
        return self.trajectory.dense

    @property
    def verified(self) -> bool:
        """Whether the solve converged and everything checked is as the scene asked."""
        return self.status is Status.CONVERGED

    @property
    def units(self) -> Units:
        """Units of everything that is sampled."""
        return self.posed.units

    @cached_property
    def nodes(self) -> Array:
        """Arclengths (N + 1,) of the mesh nodes."""
        start, end = self.scene.interval
        return start + (end - start) * self.trajectory.nodes

    @property
    def mesh(self) -> Mesh:
        """Relative widths of the elements of every phase."""
        blocks = self.dense.blocks
        widths = blocks.widths(self.dense.p)
        return Mesh(tuple(widths[part] for part in blocks.layout.phase_slices))

    @property
    def switch_points(self) -> Array:
        """Arclengths (k,) where the law switches from one phase to the next."""
        start, end = self.scene.interval
        return start + (end - start) * self.trajectory.ends[list(self.trajectory.turns)]

    def sample(self, s: Any, expression: str) -> Array:
        """Return a named output, or a formula of named outputs, at arclengths s.

        Parameters
        ----------
        s
            Arclength or array (k,) of arclengths inside the scene's interval.
        expression
            A name (`r`, `d1`, `d2`, `d3`, `n`, `m` in the lab frame; `u` along the directors;
            `u2`, `u3`, `eta`, `n1` ... `m3`, `energy`, `H`) or a formula such as "m2 / m3" or
            "dot(d1, ex)".

        Returns
        -------
        array
            (k,) for scalars, (k, 3) for vectors; without the first axis for a single arclength.

        Raises
        ------
        FormulaError
            If the expression does not parse; a ValueError.
        ValueError
            If an arclength is outside the interval.
        """
        values = self.outputs(np.atleast_1d(np.asarray(s, dtype=float)))
        result = values.get(expression)
        if result is None:
            from .sampling import evaluate_formula  # plain names need no parser

            result = evaluate_formula(expression, values)
        return np.asarray(result[0] if np.ndim(s) == 0 else result)

    def outputs(self, s: Array) -> dict[str, Array]:
        """All named outputs at arclengths s (k,): (k,) for scalars, (k, 3) for vectors."""
        start, end = self.scene.interval
        sigma = (s - start) / (end - start)
        if not ((sigma >= -1e-12) & (sigma <= 1 + 1e-12)).all():
            raise ValueError(f"arclengths are expected in [{start}, {end}], found {s}")
        if len(s) == 0:
            return {name: value[:0] for name, value in self.outputs(np.array([start])).items()}
        return dict(self._in_own_units(self.trajectory.outputs(sigma)))

    def integral(self, name: str) -> float:
        """Integral over s of a scalar named output, by the scheme's own quadrature."""
        return self.trajectory.integral(name) * self.units.length * self.units.of(name)

    @cached_property
    def at_stages(self) -> Mapping[str, Array]:
        """All named outputs at the stages, where the solver itself evaluated the equations."""
        return self._in_own_units(self.trajectory.at_stages)

    @cached_property
    def at_nodes(self) -> Mapping[str, Array]:
        """All named outputs at the nodes; where two phases meet, those of the later one."""
        return self._in_own_units(self.trajectory.at_nodes)

    def unknowns_for(
        self, problem: BoundaryValueProblem, theta: Array, fraction: Array
    ) -> tuple[Array, Array] | None:
        """Unknowns v (k, nv) and constants of another problem of the same kind, at fractions.

        None where they cannot be taken as they are; lengths of phases and slack are not among them.
        """
        return unknowns_of(self.trajectory, problem, theta, fraction)

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, units Dw = L = 1: a solution is a guess."""
        return self.trajectory.fields(fraction)

    @cached_property
    def start(self) -> Mapping[str, Array]:
        """Named outputs at the start of the ribbon."""
        return Each(self.at_nodes, lambda _, values: values[0])

    @property
    def constants(self) -> Array:
        """Constants of the rod: unknowns of the problem, or recovered from its costates."""
        if not self.problem.recovered:
            return self.dense.constants
        names = self.problem.parameter_names
        return self.dense.theta[[names.index(name) for name in self.problem.recovered]]

    @property
    def n0(self) -> Array:
        """Force (3,) at the start, lab frame."""
        return self.start["n"]

    @property
    def m0(self) -> Array:
        """Moment (3,) at the start, lab frame."""
        return self.start["m"]

    @property
    def u0(self) -> Array:
        """Strains (u1, u2, u3) at the start, along the directors."""
        return self.start["u"]

    @property
    def energy(self) -> float:
        """Strain energy of the ribbon."""
        return self.trajectory.energy * self.units.moment

    @property
    def twist(self) -> float:
        """Twist of the directors about the centre line, in turns."""
        found = self.trajectory
        return float(found.length * found.stages[2] @ found.at_stages["u"][:, 2]) / (2 * np.pi)

    __repr__ = AtHome.__repr__  # or else the one of dataclasses, of all numbers

    def _in_own_units(self, values: Mapping[str, Array]) -> Mapping[str, Array]:
        same, unit_of = self.posed.given is self.posed.scene, self.units.of
        return values if same else Each(values, lambda name, value: value * unit_of(name))
