"""What is built for one structure of scenes: its equations once, a program for each size."""

from __future__ import annotations

from dataclasses import field, fields
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.problem import BoundaryValueProblem, Posed, Ribbon, formulate
from ribbonopt.scene import Ipopt
from ribbonopt.solvers import solver_named
from ribbonopt.transcription import NLP, Mesh

from .afford import refuse_unaffordable
from .attempt import Attempt
from .discretize import transcription_of
from .ledger import Ledger

if TYPE_CHECKING:
    from ribbonopt.solvers import Solver

Elements = tuple[int, ...]
Kinds = tuple[int, ...]

LEAST_IN_PHASE = 4  # elements


@dataclass(frozen=True, eq=False)
class Structure:
    """Mechanics and equations of scenes that differ in numbers only, in one phase or in several.

    Attributes
    ----------
    posed : Posed
        A scene that has this structure.
    ribbon, problem : Ribbon, BoundaryValueProblem
        Mechanics and equations.
    sheets : tuple of int
        Kinds of the phases, see `ribbonopt.problem.switched`; empty for the law as it is.
    """

    posed: Posed
    ribbon: Ribbon
    problem: BoundaryValueProblem
    sheets: Kinds = ()
    _programs: dict[Elements, tuple[NLP, Solver]] = field(default_factory=dict)
    _phased: dict[tuple[Kinds, bool], Structure] = field(default_factory=dict)

    @classmethod
    def of(cls, posed: Posed, known: Structure | None = None) -> Structure:
        """Build the equations of a posed scene in its formulation, if none `known` has them."""
        if known is not None and known.posed.equations == posed.equations:
            return cls(posed, known.ribbon, known.problem)
        return cls(posed, *formulate(posed))

    @classmethod
    def least_energy(cls, posed: Posed) -> Structure:
        """Build the problem of least energy at the ends of a posed scene, loads there left out."""
        from ribbonopt.problem.energy import minimum  # only where there is no guess

        ribbon = Ribbon.of(posed)
        if posed.scene.states == "planar":
            from ribbonopt.problem.wellposed.plane import in_plane  # few scenes are held in one

            ribbon = in_plane(ribbon, posed)
        return cls(posed, ribbon, minimum(ribbon))

    def in_phases(self, kinds: Kinds, *, free: bool = False) -> Structure:
        """Return the same in phases of these kinds, built once; for none, this.

        `free` leaves out conditions that are to spare, see `ribbonopt.problem.switched`.
        """
        if not kinds:
            return self
        if (kinds, free) not in self._phased:
            from ribbonopt.problem.switched import switched  # most ribbons keep their sign

            problem = switched(self.ribbon, kinds, free=free)
            self._phased[kinds, free] = Structure(self.posed, self.ribbon, problem, kinds)
        return self._phased[kinds, free]

    def on(self, elements: Elements) -> tuple[NLP, Solver]:
        """Return program and solver on numbers of elements in each phase, built once."""
        if elements not in self._programs:
            scene = self.posed.scene
            nlp = transcription_of(scene).transcribe(self.problem, elements)
            refuse_unaffordable(nlp, sparse=not nlp.square or isinstance(scene.solver, Ipopt))
            options = {f.name: getattr(scene.solver, f.name) for f in fields(scene.solver)}
            self._programs[elements] = (
                nlp,
                solver_named(options.pop("type"), nlp, options, neutral=self.problem.neutral),
            )
        return self._programs[elements]

    def build(self, *, now: bool = True) -> None:
        """Make program and solver for the scene's own number of intervals, their functions `now`.

        Else these are built when something is solved.
        """
        solver = self.on(self.mesh(None).elements)[1]
        if now:
            solver.build()

    def attempt(
        self,
        posed: Posed,
        ledger: Ledger | None = None,
        mesh: Mesh | None = None,
        switches: Array | None = None,
    ) -> Attempt:
        """Return the means to solve a scene of this structure, on its own mesh unless given.

        What it costs is entered in a ledger. `switches` are the fractions of the length where the
        phases of the guesses meet.

        Raises
        ------
        ModelError
            If the scene has another structure.
        """
        if posed is not self.posed and posed.structure != self.posed.structure:
            raise ModelError("this scene differs from the prepared one in more than its numbers")
        if self.problem.stations and not self.sheets:
            switches = posed.places
        if mesh is None:
            mesh = self.mesh(switches, places=posed.places)
        elif len(mesh.phases) < len(self.problem.phases) == len(posed.places) + 1:
            mesh = mesh.resampled(sum(mesh.elements), posed.places)
        nlp, solver = self.on(mesh.elements)
        p = nlp.layout.parameters(posed.values, mesh.widths)
        parts = self.ribbon, self.problem, nlp, solver, self.sheets, switches
        return Attempt(posed, p, *parts, ledger or Ledger())

    def mesh(
        self,
        switches: Array | None,
        least: int = 0,
        graded_as: Mesh | None = None,
        places: Array | None = None,
    ) -> Mesh:
        """Uniform elements, `least` or more; in phases, of about the width they would have without.

        `switches` are the fractions of the length where phases meet. `graded_as` is a mesh of one
        phase whose elements are as wide where these should be. `places` are the fractions at which
        something acts or holds: nodes are there.
        """
        count = max(self.posed.scene.transcription.intervals, least)
        places = self.posed.places if places is None else places
        if len(places) and not self.sheets:
            pieces = Mesh.uniform(*_shared(count, places, 1))
            return pieces if self.problem.stations else pieces.joined(places)
        if graded_as is not None:
            inner = np.empty(0) if switches is None else switches
            return graded_as.resampled(count, inner, LEAST_IN_PHASE)
        if switches is None or not len(switches):
            return Mesh.uniform(count)
        return Mesh.uniform(*_shared(count, switches, LEAST_IN_PHASE))


def _shared(count: int, switches: Array, least: int) -> list[int]:
    """Return numbers of elements of the phases that meet at fractions, by their lengths."""
    shares = np.diff(np.concatenate([[0.0], switches, [1.0]]))
    return [max(least, round(count * float(share))) for share in shares]
