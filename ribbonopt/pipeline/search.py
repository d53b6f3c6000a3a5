"""The search for a solution of one scene: guess after guess, the law as it is or in phases.

Where m2 changes sign, a law with a kink costs every scheme its order, and with a jump Newton's
method may report success on a wrong answer. Such scenes are posed again in phases that end on the
sign changes (`ribbonopt.problem.switched`). The arcs are read from a solution without phases, or
from those of the smooth law on the way to it; what comes out must have the sign of m2 that each
phase assumes.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.attempt.ledger import Ledger
from ribbonopt.attempt.structure import Structure
from ribbonopt.checks.arcs import Arcs, sign_changes, with_mixtures
from ribbonopt.guess import Guess, ShapeGuess, turning_of
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene, Shooting
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

EACH, FEW_TURNS = 3.0, 20.0  # radians: to an interval; in all, for which any mesh is left alone
COARSER = 3  # intervals of starts, of degree 3, to one of a scene


@dataclass(eq=False)
class Search:
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
        Equilibria of the smooth law met on the way, delta decreasing.
    layered : bool
        Whether these needed a graded mesh, so that what starts from them does.
    wound : bool
        Whether the last guess had so many turns that it needed more intervals.
    """

    posed: Posed
    structure: Structure
    ledger: Ledger = field(default_factory=Ledger)
    smooth: list[Solution] = field(default_factory=list)
    last: Attempt | None = None
    layered: bool = False
    wound: bool = False

    @cached_property
    def plain(self) -> Attempt:
        """The attempt without phases."""
        return self._kept(self.structure.attempt(self.posed, self.ledger))

    def run(self, guess: Guess, *, quick: bool = False) -> bool:
        """Try a guess without phases, and in phases if m2 changes sign in what comes out.

        A guess that has phases itself is tried in these first.
        """
        if isinstance(guess, Solution) and guess.sheets and self.phases_help:
            if self._run_phases(Arcs(guess.sheets, guess.trajectory.ends[1:-1]), guess):
                return True
        wound = self._wound(guess)
        # From shapes of many turns IPOPT takes long, and leads nowhere.
        quick, guess = quick or wound is not None, wound or guess
        if not self.plain.run(guess, quick=quick, check=not self.phases_help):
            return False
        found = self.plain.best
        if found is not None and self._in_given_phases(found):
            return True
        return self.plain.check() and found is not None and not self.jumps(found)

    def run_smooth(self, guess: Solution) -> bool:
        """Try an equilibrium of the smooth law; they come with delta increasing."""
        self.smooth.insert(0, guess)
        if guess.mesh.graded:
            # A layer that a uniform mesh of so few intervals would not see.
            count, self.layered = self.posed.scene.transcription.intervals, True
            count = max(count, len(guess.mesh.widths) // COARSER)
            self._take(guess.mesh.resampled(count, np.empty(0)))
        elif self.wound:
            self._take(None)
            self.wound = False
        if not self.phases_help:
            return self.plain.run(guess, quick=True)
        if len(self.smooth) == 1:
            return self._in_given_phases(guess) or (
                not self.jumps(guess) and self.run(guess, quick=True)
            )
        if len(self.smooth) == 2:
            blunt, sharp = self.smooth
            arcs = with_mixtures(sharp, blunt)
            if 0 in arcs.kinds:
                return self._run_phases(arcs, sharp)
        return self.run(guess, quick=True)

    def run_all(self, guesses: Iterable[Guess]) -> bool:
        """Try the guesses of an automatic start, equilibria of the smooth law among them."""
        first: Guess | None = None
        for guess in guesses:
            if isinstance(guess, Solution):
                done = self.run_smooth(guess)
            else:
                done = self.run(guess, quick=True)
            if done:
                return True
            first = first or guess
        # All that was spared to be quick.
        return first is not None and not self.needs_phases and self.run(first)

    @property
    def smooth_instead(self) -> Solution | None:
        """The smooth law's sharpest equilibrium where none of a law that needs phases was found."""
        best = self.best
        if best is None or not (self.needs_phases and self.smooth):
            return None
        wrong = not best.verified or (self.jumps(best) and not best.sheets)
        return self.smooth[-1] if wrong else None

    def changes_sign(self, solution: Solution) -> bool:
        """Whether m2 changes sign along a solution."""
        return len(sign_changes(solution).kinds) > 1

    def jumps(self, solution: Solution) -> bool:
        """Whether the law's strains jump along a solution, so that it needs phases to be right."""
        return self.needs_phases and self.changes_sign(solution)

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

    def on_mesh(
        self, sheets: tuple[int, ...], mesh: Mesh, switches: Array | None = None
    ) -> Attempt:
        """Return the means to solve on a mesh, in the phases of a solution."""
        structure = self.structure.in_phases(sheets)
        return self._kept(structure.attempt(self.posed, self.ledger, mesh, switches))

    def _take(self, mesh: Mesh | None) -> None:
        """Begin anew without phases, on a mesh or that of the scene."""
        self.plain = self._kept(self.structure.attempt(self.posed, self.ledger, mesh))

    def _wound(self, guess: Guess) -> Guess | None:
        """Take as many intervals as a guess winds, where those of the scene are too few.

        Returns that guess, a shape with the force that balances it; None where they are enough.
        """
        settings = self.posed.scene.transcription
        steps = settings.steps if isinstance(settings, Shooting) else 1
        each = EACH * steps
        enough = max(FEW_TURNS, each * settings.intervals)
        turning = turning_of(guess, enough)
        if turning <= enough:
            return None
        # Finer than just enough: a coarse mesh has equilibria of its own near by.
        self._take(Mesh.uniform(int(np.ceil(2 * turning / each))))
        self.wound = True
        return guess.balanced() if isinstance(guess, ShapeGuess) else guess

    def _in_given_phases(self, source: Solution) -> bool:
        """Try the phases that a solution shows or the scene names; whether that succeeds."""
        if not self.phases_help:
            return False
        if isinstance(self.posed.scene.switching, tuple):
            if self._run_phases(_given(source, self.posed.scene), source):
                return True
        arcs = sign_changes(source)
        return len(arcs.kinds) > 1 and self._run_phases(arcs, source)

    def _run_phases(self, arcs: Arcs, source: Solution) -> bool:
        structure = self.structure.in_phases(arcs.kinds)
        graded = source.mesh.graded and len(source.mesh.phases) == 1 and len(arcs.kinds) > 1
        mesh = source.mesh if graded and self.layered else None
        attempt = structure.attempt(self.posed, self.ledger, mesh, arcs.switches)
        return self._kept(attempt).run(source, quick=True)

    def _kept(self, attempt: Attempt) -> Attempt:
        self.last = attempt
        return attempt


def _given(source: Solution, scene: Scene) -> Arcs:
    """Phases that meet where a scene says, of alternating sign; `source` may have other units."""
    assert isinstance(scene.switching, tuple)
    start, end = scene.interval
    switches = (np.array(scene.switching) - start) / (end - start)
    s = source.scene.interval
    middle = s[0] + (s[1] - s[0]) * switches[:1] / 2
    first = 1 if source.outputs(middle)["m2"][0] > 0 else -1
    return Arcs(tuple(first * (-1) ** i for i in range(len(switches) + 1)), switches)
