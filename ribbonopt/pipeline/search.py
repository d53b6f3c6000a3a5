"""The search for a solution of one scene: guess after guess, the law as it is or in phases.

Where m2 changes sign, a law with a kink costs every scheme its order, and with a jump Newton's
method may report success on a wrong answer. Such scenes are posed again in phases that end on the
sign changes (`ribbonopt.problem.switched`). The arcs are read from a solution without phases, or
from those of the smooth law on the way to it; what comes out must have the sign of m2 that each
phase assumes.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ribbonopt.checks.arcs import (
    MIXTURE,
    Arcs,
    arcs_of,
    cut_at,
    given_arcs,
    is_mixture,
    leaps_at_ends,
    sign_changes,
    with_mixtures,
    without_empty,
)
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess, ShapeGuess
from ribbonopt.guess.balanced import Balanced
from ribbonopt.guess.flat import Flattened, nearly_flat
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

from .intervals import intervals_for
from .tried import Tried, bluntness

# Elements beside the end of a phase where strains fade away: to a millionth of one.
LEVELS, RATIO = 7, 0.15
COARSER = 3  # intervals of starts, of degree 3, to one of a scene


@dataclass(eq=False)
class Search(Tried):
    """The search on one scene: guess after guess."""

    def run(self, guess: Guess, *, quick: bool = False) -> bool:
        """Try a guess without phases, and in phases if m2 changes sign in what comes out.

        A guess that has phases itself is tried in these first.
        """
        if isinstance(guess, Solution) and guess.sheets and self.phases_help:
            if self.run_in(arcs_of(guess), guess):
                return True
        if self.needs_phases and not isinstance(guess, Solution) and is_mixture(guess):
            if self.run_in(MIXTURE, Balanced(guess)):
                return True
        count = intervals_for(guess, self.posed.scene)
        if count is not None:
            self._take(Mesh.uniform(count))
            # From shapes of many turns IPOPT takes long, and leads nowhere.
            self.wound = quick = True
            guess = guess.balanced() if isinstance(guess, ShapeGuess) else guess
        if not self.plain.run(guess, quick=quick, check=not self.phases_help):
            return False
        found = self._flattened(self.plain.best)
        if found is not None and self._in_given_phases(found):
            return True
        return self.plain.check() and found is not None and not self.jumps(found)

    def run_in(self, arcs: Arcs, source: Guess, least: int = 0) -> bool:
        """Try a guess in phases, on `least` intervals or more; whether that succeeds."""
        if self.posed.stations:
            arcs = cut_at(arcs, self.posed.places)
        structure = self.structure.in_phases(arcs.kinds)
        mesh = structure.mesh(arcs.switches, least, self._layers_of(source, arcs))
        attempt = structure.attempt(self.posed, self.ledger, mesh, arcs.switches)
        done = self._kept(attempt).run(source, quick=True)
        found = attempt.best
        if found is None or not found.status.converged:
            return False
        fewer = without_empty(found)
        if fewer is not None and self.run_in(fewer, found, least):
            return True
        if done and self._leaps_nowhere(found) and self.plain.run(found, quick=True):
            self._kept(self.plain)
            return True
        if done and self.structure.ribbon.law.fades:
            # A start on small elements leads nowhere before it is known where phases meet.
            gathered = found.mesh.gathered(LEVELS, RATIO, leaps_at_ends(found))
            finer = structure.attempt(
                self.posed, self.ledger, gathered, found.trajectory.ends[1:-1]
            )
            if finer.run(found, quick=True):
                attempt = finer
        self._kept(attempt)
        return done

    def run_smooth(self, guess: Solution) -> bool:
        """Try an equilibrium of the smooth law.

        The first one is sharp; sharper ones may follow, then blunter ones.
        """
        sharpest = self.sharpest
        self.smooth.append(guess)
        sharper = sharpest is not None and bluntness(guess) < bluntness(sharpest)
        if guess.mesh.graded and not sharper:
            # A layer that a uniform mesh of so few intervals would not see.
            count, self.layered = self.posed.scene.transcription.intervals, True
            count = max(count, len(guess.mesh.widths) // COARSER)
            whole = guess.mesh.joined(guess.trajectory.ends[1:-1])
            self._take(whole.resampled(count, np.empty(0)))
        elif self.wound:
            self._take(None)
            self.wound = False
        if not self.phases_help:
            return self.plain.run(guess, quick=True)
        if sharpest is None:
            return self._in_given_phases(guess) or (
                not self.jumps(guess) and self.run(guess, quick=True)
            )
        sharp, blunt = sorted((guess, sharpest), key=bluntness)
        if sharp is guess or len(self.smooth) == 2:
            every = list(with_mixtures(sharp, blunt))
            if sharp is guess and self.jumps(sharp):
                every.append(sign_changes(sharp))
            for arcs in every:
                if arcs.kinds not in self.tried and self.run_in(*self._freed(arcs, sharp)):
                    return True
                if 0 not in arcs.kinds:  # mixtures are nearer from sharper laws
                    self.tried.add(arcs.kinds)
        return sharp is not guess and self.run(guess, quick=True)

    def run_minimum(self, guess: Solution) -> bool:
        """Try what minimises the energy of the law itself, in the phases that it shows."""
        if self.phases_help and self.changes_sign(guess):
            if self.run_in(sign_changes(guess), guess):
                return True
        # In one phase it is less exact, but need not know where the sign changes.
        return self.run(guess, quick=True)

    def run_all(self, guesses: Iterable[Guess]) -> bool:
        """Try the guesses of an automatic start, equilibria of the smooth law among them."""
        first: Guess | None = None
        for guess in guesses:
            if isinstance(guess, Solution):
                minimum = bool(guess.problem.recovered)
                done = self.run_minimum(guess) if minimum else self.run_smooth(guess)
            else:
                done = self.run(guess, quick=True)
            if done:
                return True
            first = first or guess
        # All that was spared to be quick.
        return first is not None and not self.needs_phases and self.run(first)

    def _in_given_phases(self, source: Solution) -> bool:
        """Try the phases that a solution shows or the scene names; whether that succeeds."""
        if not self.phases_help:
            return False
        if isinstance(self.posed.scene.switching, tuple):
            if self.run_in(given_arcs(source, self.posed.scene), source):
                return True
        return self.better_in_phases(source) and self.run_in(sign_changes(source), source)

    def _freed(self, arcs: Arcs, source: Guess) -> tuple[Arcs, Guess]:
        """Return arcs and a guess: nearer, for a mixture from end to end, by leaving m2 free."""
        if arcs.kinds != MIXTURE.kinds or self.posed.stations:
            return arcs, source
        attempt = self.structure.in_phases(arcs.kinds, free=True).attempt(self.posed, self.ledger)
        attempt.run(source, quick=True, check=False)
        found = attempt.best
        return arcs, source if found is None or not found.status.converged else found

    def _leaps_nowhere(self, found: Solution) -> bool:
        """Whether phases end where the law asked for leaps nowhere, as those of a smooth law may.

        A mixture has m2 = 0, and shows no sign of it.
        """
        several = len(set(found.sheets)) > 1 and 0 not in found.sheets
        return several and self.needs_phases and not self.changes_sign(found)

    def _flattened(self, found: Solution | None) -> Solution | None:
        """Return what lies in a plane but for a little within it, if there it is a solution."""
        if found is None or not self.needs_phases or not nearly_flat(found):
            return found
        attempt = self.structure.attempt(self.posed, self.ledger)
        if attempt.run(Flattened(found), quick=True) and attempt.best is not None:
            if not self.jumps(attempt.best):
                self.plain = self._kept(attempt)
        return self.plain.best

    def _layers_of(self, source: Guess, arcs: Arcs) -> Mesh | None:
        """Mesh of a source that was graded to layers, where phases need that too."""
        if not (self.layered and isinstance(source, Solution)) or len(arcs.kinds) == 1:
            return None
        graded = source.mesh.graded and not source.sheets
        return source.mesh.joined(source.trajectory.ends[1:-1]) if graded else None
