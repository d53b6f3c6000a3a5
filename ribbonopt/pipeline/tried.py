"""What has been tried on one scene, and what is to be thought of it."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.attempt.ledger import Ledger
from ribbonopt.attempt.structure import Structure
from ribbonopt.checks.arcs import Arcs, sign_changes
from ribbonopt.checks.one_sided import ends_on_switch
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess
from ribbonopt.guess.flat import Flattened, nearly_flat
from ribbonopt.mechanics.laws.smooth import sharpness
from ribbonopt.problem import Posed
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

LABELLED = 1e-3  # delta of the sharpest smooth law that is shown in place of another


@dataclass(eq=False)
class Tried:
    """What has been tried on one scene.

    Attributes
    ----------
    posed : Posed
        What is asked.
    structure : Structure
        Its structure, which keeps those in several phases.
    ledger : Ledger
        Steps so far, with their cost.
    smooth : list of Solution
        Equilibria of the smooth law met on the way.
    tried : set of tuples of int
        Kinds of phases that sharper ones of these showed, and that led nowhere.
    layered : bool
        Whether these needed a graded mesh, so that what starts from them does.
    wound : bool
        Whether the last guess had so many turns that it needed more intervals.
    later : bool
        Whether what converges without phases is verified when it is refined, and not before.
    """

    posed: Posed
    structure: Structure
    ledger: Ledger = field(default_factory=Ledger)
    smooth: list[Solution] = field(default_factory=list)
    tried: set[tuple[int, ...]] = field(default_factory=set)
    last: Attempt | None = None
    layered: bool = False
    wound: bool = False
    later: bool = False

    @cached_property
    def plain(self) -> Attempt:
        """The attempt without phases."""
        return self._kept(self.structure.attempt(self.posed, self.ledger))

    @property
    def settled(self) -> bool:
        """Whether there is a solution of the law that is asked for."""
        best = self.best
        return best is not None and best.verified and not self.smooth_instead

    @property
    def energy(self) -> float:
        """Energy of the best solution (Dw = L = 1)."""
        return np.inf if self.best is None else self.best.trajectory.energy

    @property
    def smooth_instead(self) -> list[Solution]:
        """Equilibria of the smooth law, sharpest first, where none was found of one with phases."""
        best = self.best
        if best is None or not (self.smooth and self.needs_phases):
            return []
        wrong = not best.verified or (self.jumps(best) and not best.sheets)
        found = sorted(self.smooth, key=bluntness) if wrong else []
        return [smooth for smooth in found if bluntness(smooth) >= LABELLED]

    @property
    def sharpest(self) -> Solution | None:
        """The sharpest equilibrium of the smooth law that was met."""
        return min(self.smooth, key=bluntness, default=None)

    def changes_sign(self, solution: Solution) -> bool:
        """Whether m2 changes sign along a solution."""
        return len(sign_changes(solution).kinds) > 1

    def better_in_phases(self, solution: Solution) -> bool:
        """Whether phases tell strains that rounding would choose: at a sign change, or an end."""
        told = self.needs_phases and not self.structure.ribbon.law.fades
        return (told and ends_on_switch(solution)) or self.changes_sign(solution)

    def jumps(self, solution: Solution) -> bool:
        """Whether the law's strains jump along a solution, so that it needs phases to be right."""
        return self.needs_phases and self.changes_sign(solution)

    def leaps_nowhere(self, found: Solution) -> bool:
        """Whether phases end where the law asked for leaps nowhere, as those of a smooth law may.

        A mixture has m2 = 0, and shows no sign of it.
        """
        several = len(set(found.sheets)) > 1 and 0 not in found.sheets
        return several and self.needs_phases and not self.changes_sign(found)

    @property
    def needs_phases(self) -> bool:
        """Whether no solver can be trusted without phases: the law's strains jump."""
        return self.phases_help and not self.structure.ribbon.law.smooth

    @property
    def best(self) -> Solution | None:
        """The solution in phases, or the best without."""
        last = self.last or self.plain
        return last.best if last.sheets and last.best and last.best.verified else self.plain.best

    @property
    def phases_help(self) -> bool:
        """Whether phases are of use: not for smooth laws, nor in other formulations."""
        scene = self.posed.scene
        allowed = scene.formulation == "inverted" and scene.switching != "off"
        return allowed and self.structure.ribbon.law.kinked

    @property
    def refined_alone(self) -> bool:
        """Whether a solution without phases is refined before anything else is made of it."""
        scene = self.posed.scene
        square = self.structure.problem.square and not self.structure.problem.recovered
        return scene.tolerance is not None and square and not self.phases_help

    @property
    def has_signs(self) -> bool:
        """Whether sides of the switch in a guess may tell the phases of a solution."""
        return self.phases_help and not self.posed.stations

    def in_phases_at_once(self, why: str) -> bool:
        """Say why nothing was solved without phases first; True."""
        self.ledger.spare(f"a pass without phases ({why})")
        return True

    def on_mesh(
        self, sheets: tuple[int, ...], mesh: Mesh, switches: Array | None = None
    ) -> Attempt:
        """Return the means to solve on a mesh, in the phases of a solution."""
        structure = self.structure.in_phases(sheets)
        return self._kept(structure.attempt(self.posed, self.ledger, mesh, switches))

    def layers_of(self, source: Guess, arcs: Arcs) -> Mesh | None:
        """Mesh of a source that was graded to layers, where phases need that too."""
        if not (self.layered and isinstance(source, Solution)) or len(arcs.kinds) == 1:
            return None
        graded = source.mesh.graded and not source.sheets
        return source.mesh.joined(source.trajectory.ends[1:-1]) if graded else None

    def flattened(self, found: Solution | None) -> Solution | None:
        """Return what lies in a plane but for a little within it, if there it is a solution."""
        if found is None or not self.needs_phases or not nearly_flat(found):
            return found
        attempt = self.structure.attempt(self.posed, self.ledger)
        if attempt.run(Flattened(found), quick=True) and attempt.best is not None:
            if not self.jumps(attempt.best):
                self.plain = self._kept(attempt)
        return self.plain.best

    def _take(self, mesh: Mesh | None) -> None:
        """Begin anew without phases, on a mesh or that of the scene."""
        self.plain = self._kept(self.structure.attempt(self.posed, self.ledger, mesh))

    def _kept(self, attempt: Attempt) -> Attempt:
        self.last = attempt
        return attempt


def bluntness(solution: Solution) -> float:
    """Return delta of the smooth law of a solution, 1 for any other law."""
    return sharpness(solution.posed.scene.law, 1.0)
