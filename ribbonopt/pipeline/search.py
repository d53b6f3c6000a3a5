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

from ribbonopt.arrays import Array
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
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

from .intervals import intervals_for
from .poles import toward_poles
from .shown import crosses, phases_shown, side_shown
from .tried import Tried, bluntness

# Elements beside the end of a phase where strains fade away: to a millionth of one.
LEVELS, RATIO = 7, 0.15
FEW = 25  # iterations in phases that a guess shows before anything is solved
SETTLED = 1e-3  # last step of Newton's method, relative, by which signs of m2 are settled
COARSER = 3  # intervals of starts, of degree 3, to one of a scene


@dataclass(eq=False)
class Search(Tried):
    """The search on one scene: guess after guess."""

    def run(self, guess: Guess, *, quick: bool = False, shown: bool = True) -> bool:
        """Try a guess without phases, and in phases if m2 changes sign in what comes out.

        A guess that has phases itself is tried in these first, and in those that it shows, unless
        the phases `shown` by a solution have been tried.
        """
        if isinstance(guess, Solution) and guess.sheets and self.phases_help:
            if self.run_in(arcs_of(guess), guess):
                return self.in_phases_at_once("the guess has phases")
        if self.needs_phases and not isinstance(guess, Solution) and is_mixture(guess):
            if self.run_in(MIXTURE, Balanced(guess)):
                return True
        count = intervals_for(guess, self.posed.scene)
        if count is not None:
            self._take(Mesh.uniform(count))
            # From shapes of many turns IPOPT takes long, and leads nowhere.
            self.wound = quick = True
            guess = guess.balanced() if isinstance(guess, ShapeGuess) else guess
        known = isinstance(guess, Solution) and (bool(guess.sheets) or not shown)
        w, signs = self.plain.unknowns(guess), not known and self.has_signs
        led, factors = True, None
        if signs and crosses(self.plain, w):
            arcs = phases_shown(self.plain, w)
            if arcs is not None and self.run_in(arcs, self.plain.restored(w), most=FEW):
                return self.in_phases_at_once("the guess shows them")
            # Without phases until they show, no further: the rest would be solved again in them.
            first = self.structure.attempt(self.posed, self.ledger, self.plain.mesh)
            led = first.run_from(w, quick=True, check=False, loose=SETTLED)
            if led and first.best is not None:
                if self._in_given_phases(first.best):
                    return True
                w, factors = first.best.dense.w, first.factors
            else:
                self.plain = self._kept(first)
        check = not (self.phases_help or self.later)
        if not (led and self.plain.run_from(w, quick=True, check=check, factors=factors)):
            return (signs and self._on_one_side(w)) or (not quick and self.run_slowly(guess))
        return self._in_shown_phases()

    def run_slowly(self, guess: Guess) -> bool:
        """Try a guess from which Newton's method led nowhere by what the solver has beside that."""
        if intervals_for(guess, self.posed.scene) is not None:
            return False
        attempt, before = self.structure.attempt(self.posed, self.ledger), self.plain.best
        led = attempt.run_slowly(guess, check=not (self.phases_help or self.later))
        if led or (attempt.best is not None and not (before and before.status.converged)):
            self.plain = self._kept(attempt)
        return led and self._in_shown_phases()

    def _in_shown_phases(self) -> bool:
        """Try the phases of what was found without any; whether there is a solution now."""
        found = self.flattened(self.plain.best)
        if found is not None and self._in_given_phases(found):
            return True
        sound = self.later or self.plain.check()
        return sound and found is not None and not self.jumps(found)

    def _on_one_side(self, w: Array) -> bool:
        """Try unknowns w (nw,) on the side of the law's switch on which they are, but for noise.

        Newton's method sees no kink there. What comes out solves the law itself if it keeps to that
        side, as verification tells.
        """
        side, source = side_shown(self.plain, w), self.plain.restored(w)
        if side is None:
            return False
        attempt = self.structure.in_phases((side,)).attempt(
            self.posed, self.ledger, self.plain.mesh
        )
        if not attempt.run(source, quick=True) or attempt.best is None:
            return False
        if not self.plain.run(attempt.best, quick=True):
            self._kept(attempt)
        return True

    def run_in(self, arcs: Arcs, source: Guess, least: int = 0, most: int | None = None) -> bool:
        """Try a guess in phases, on `least` intervals or more; whether that succeeds.

        In `most` iterations, where it may be another guess that is better.
        """
        if self.posed.stations:
            arcs = cut_at(arcs, self.posed.places)
        structure = self.structure.in_phases(arcs.kinds)
        layers = self.layers_of(source, arcs)
        mesh = structure.mesh(arcs.switches, least, layers)
        attempt = structure.attempt(self.posed, self.ledger, mesh, arcs.switches)
        w = attempt.unknowns(source)
        near = self.posed.scene.tolerance is not None and layers is None
        graded = toward_poles(attempt, w) if near else None
        if graded is not None:
            attempt = structure.attempt(self.posed, self.ledger, graded, arcs.switches)
            w = attempt.unknowns(source)
        done = self._kept(attempt).run_from(w, quick=True, most=most)
        found = attempt.best
        if found is None or not found.status.converged:
            return False
        fewer = without_empty(found)
        if fewer is not None and self.run_in(fewer, found, least):
            return True
        if done and self.leaps_nowhere(found) and self.plain.run(found, quick=True):
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
            return self.plain.run(guess, quick=True, check=not self.later)
        if sharpest is None:
            return self._in_given_phases(guess) or (
                not self.jumps(guess) and self.run(guess, quick=True, shown=False)
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
        return sharp is not guess and self.run(guess, quick=True, shown=False)

    def run_minimum(self, guess: Solution) -> bool:
        """Try what minimises the energy of the law itself, in the phases that it shows."""
        if self.phases_help and self.changes_sign(guess):
            if self.run_in(sign_changes(guess), guess):
                return True
        # In one phase it is less exact, but need not know where the sign changes.
        return self.run(guess, quick=True, shown=False)

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
        return first is not None and not self.needs_phases and self.run_slowly(first)

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
