"""The search for a solution of one scene: guess after guess, the law as it is or in phases.

Where m2 changes sign, a law with a kink costs every scheme its order, and with a jump Newton's
method may report success on a wrong answer. Such scenes are posed again in phases that end on the
sign changes (`ribbonopt.problem.switched`). The arcs are read from a solution without phases, or
from those of the smooth law on the way to it; what comes out must have the sign of m2 that each
phase assumes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempts
from ribbonopt.attempt.structure import Built
from ribbonopt.checks.arcs import Arcs, sign_changes, with_mixtures
from ribbonopt.guess import Guess
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

if TYPE_CHECKING:
    from ribbonopt.solvers.protocols import Factors


@dataclass(eq=False)
class Search:
    """What has been tried on one scene.

    Attributes
    ----------
    scene : Scene
        What is asked.
    built, phased : Built, mapping of kinds to Built
        Its structure in one phase, and those in several, made when needed and kept.
    path : list of mappings
        Steps so far, with their cost.
    smooth : list of Solution
        Equilibria of the smooth law met on the way, delta decreasing.
    """

    scene: Scene
    built: Built
    phased: dict[tuple[int, ...], Built]
    path: list[Mapping[str, Any]] = field(default_factory=list)
    smooth: list[Solution] = field(default_factory=list)
    _all: list[Attempts] = field(default_factory=list)

    @cached_property
    def plain(self) -> Attempts:
        """Attempts without phases."""
        return self._kept(self.built.attempts(self.scene))

    def run(self, guess: Guess, *, quick: bool = False) -> bool:
        """Try a guess without phases, and in phases if m2 changes sign in what comes out.

        A guess that has phases itself is tried in these first.
        """
        if isinstance(guess, Solution) and guess.sheets and self.phases_help:
            if self._run_phases(Arcs(guess.sheets, guess.trajectory.ends[1:-1]), guess):
                return True
        if not self.plain.run(guess, quick=quick, check=not self.phases_help):
            return False
        found = self.plain.best
        if found is not None and self._in_given_phases(found):
            return True
        return self.plain.check() and found is not None and not self.jumps(found)

    def run_smooth(self, guess: Solution) -> bool:
        """Try an equilibrium of the smooth law; they come with delta increasing."""
        self.smooth.insert(0, guess)
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

    def changes_sign(self, solution: Solution) -> bool:
        """Whether m2 changes sign along a solution."""
        return len(sign_changes(solution).kinds) > 1

    def jumps(self, solution: Solution) -> bool:
        """Whether the law's strains jump along a solution, so that it needs phases to be right."""
        return self.needs_phases and self.changes_sign(solution)

    @property
    def needs_phases(self) -> bool:
        """Whether no solver can be trusted without phases: the law's strains jump."""
        return self.phases_help and not self.built.ribbon.law.smooth

    @property
    def best(self) -> Solution | None:
        """The solution in phases, or the best without."""
        last = self._all[-1] if self._all else self.plain
        return last.best if last.sheets and last.best and last.best.verified else self.plain.best

    @property
    def factors(self) -> Factors | None:
        """Factors of the Jacobian that the last attempts ended with, if they were kept."""
        return self._all[-1].factors if self._all else None

    @property
    def iterations(self) -> int:
        """Iterations of all attempts."""
        return sum(attempts.iterations for attempts in self._all)

    @property
    def solvers(self) -> tuple[str, ...]:
        """Names of the solvers used, IPOPT of the automatic start among them."""
        named = tuple(name for attempts in self._all for name in attempts.solvers)
        return (*named, "ipopt") if any("ipopt" in step["step"] for step in self.path) else named

    def timings(self, build: float, seconds: float) -> dict[str, float]:
        """Seconds to build, of functions, of linear algebra, the rest of the search, and in all."""
        each = [attempts.seconds for attempts in self._all]
        evaluate, linear = (sum(times[i] for times in each) for i in range(2))
        rest = seconds - evaluate - linear
        spent = {"build": build, "evaluate": evaluate, "linear": linear, "rest": rest}
        return spent | {"total": seconds + build}

    @property
    def phases_help(self) -> bool:
        """Whether phases are of use: not for smooth laws, nor in other formulations."""
        scene = self.scene
        allowed = scene.formulation == "inverted" and scene.switching != "off"
        return allowed and self.built.ribbon.law.kinked

    def on_mesh(
        self, sheets: tuple[int, ...], mesh: Mesh, switches: Array | None = None
    ) -> Attempts:
        """Return the means to solve on a mesh, in the phases of a solution."""
        return self._kept(self.structure(sheets).attempts(self.scene, mesh, switches))

    def structure(self, sheets: tuple[int, ...]) -> Built:
        """Return what is built for phases of these kinds; for none, without phases."""
        if not sheets:
            return self.built
        if sheets not in self.phased:
            from ribbonopt.problem.switched import switched  # most ribbons keep their sign

            problem = switched(self.built.ribbon, sheets)
            built = Built(self.built.scene, self.built.ribbon, problem, sheets)
            self.phased[sheets] = built
        return self.phased[sheets]

    def _in_given_phases(self, source: Solution) -> bool:
        """Try the phases that a solution shows or the scene names; whether that succeeds."""
        if not self.phases_help:
            return False
        if isinstance(self.scene.switching, tuple):
            if self._run_phases(_given(source, self.scene), source):
                return True
        arcs = sign_changes(source)
        return len(arcs.kinds) > 1 and self._run_phases(arcs, source)

    def _run_phases(self, arcs: Arcs, source: Solution) -> bool:
        attempts = self.structure(arcs.kinds).attempts(self.scene, switches=arcs.switches)
        return self._kept(attempts).run(source, quick=True)

    def _kept(self, attempts: Attempts) -> Attempts:
        attempts.path = self.path
        self._all.append(attempts)
        return attempts


def _given(source: Solution, scene: Scene) -> Arcs:
    """Phases that meet where a scene says, of alternating sign; `source` may have other units."""
    assert isinstance(scene.switching, tuple)
    start, end = scene.interval
    switches = (np.array(scene.switching) - start) / (end - start)
    s = source.scene.interval
    middle = s[0] + (s[1] - s[0]) * switches[:1] / 2
    first = 1 if source.outputs(middle)["m2"][0] > 0 else -1
    return Arcs(tuple(first * (-1) ** i for i in range(len(switches) + 1)), switches)
