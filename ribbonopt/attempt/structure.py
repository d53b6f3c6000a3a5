"""What is built for one structure of scenes: its equations once, a program for each size."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ModelError
from ribbonopt.problem import BoundaryValueProblem, Ribbon, theta_of
from ribbonopt.scene import Scene
from ribbonopt.scene.units import in_special_units
from ribbonopt.solvers import solver_named
from ribbonopt.transcription import NLP, Mesh

from .attempt import Attempts
from .discretize import transcription_of

if TYPE_CHECKING:
    from ribbonopt.solvers import Solver

Elements = tuple[int, ...]
SAME = ("formulation", "states", "transcription", "solver")


@dataclass(frozen=True, eq=False)
class Built:
    """Mechanics and equations of a scene, in one phase or in several.

    Attributes
    ----------
    scene : Scene
        The scene it was built for.
    ribbon, problem : Ribbon, BoundaryValueProblem
        Mechanics and equations.
    sheets : tuple of int
        Kinds of the phases, see `ribbonopt.problem.switched`; empty for the law as it is.
    """

    scene: Scene
    ribbon: Ribbon
    problem: BoundaryValueProblem
    sheets: tuple[int, ...] = ()

    def on(self, elements: Elements) -> tuple[NLP, Solver]:
        """Return program and solver on numbers of elements in each phase, built once."""
        if elements not in self._sizes:
            nlp = transcription_of(self.scene).transcribe(self.problem, elements)
            options = {
                f.name: getattr(self.scene.solver, f.name) for f in fields(self.scene.solver)
            }
            self._sizes[elements] = nlp, solver_named(options.pop("type"), nlp, options)
        return self._sizes[elements]

    @cached_property
    def _sizes(self) -> dict[Elements, tuple[NLP, Solver]]:
        return {}

    def attempts(
        self, scene: Scene, mesh: Mesh | None = None, switches: Array | None = None
    ) -> Attempts:
        """Return the means to solve a scene of this structure, on its own mesh unless given.

        `switches` are the fractions of the length where the phases of the guesses meet.
        """
        if mesh is None:
            mesh = self._mesh(scene, switches)
        nlp, solver = self.on(mesh.elements)
        p = nlp.layout.parameters(self.theta(scene), mesh.widths)
        return Attempts(scene, p, self.ribbon, self.problem, nlp, solver, self.sheets, switches)

    def theta(self, scene: Scene) -> Array:
        """Parameters (nt,) of a scene; ModelError if it has another structure."""
        values = theta_of(in_special_units(scene))
        same = tuple(values) == self.problem.parameter_names and all(
            getattr(scene, name) == getattr(self.scene, name) for name in SAME
        )
        if not same or scene.law.type != self.scene.law.type:
            raise ModelError("this scene differs from the prepared one in more than its numbers")
        return np.array(list(values.values()))

    def _mesh(self, scene: Scene, switches: Array | None) -> Mesh:
        """Uniform elements; in phases, of about the width they would have without."""
        count = scene.transcription.intervals
        if switches is None or not len(switches):
            return Mesh.uniform(count)
        shares = np.diff(np.concatenate([[0.0], switches, [1.0]]))
        return Mesh.uniform(*(max(4, round(count * float(share))) for share in shares))
