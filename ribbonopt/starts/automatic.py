"""The start that needs no guess.

A shape that fits the ends (a chord with frames by slerp, a twisted circle for a loop); least energy
of the smooth law at delta = 0.3; its equilibrium followed by Newton's method, loads brought on and
delta down to 0.01. The result is the guess for the formulation and the law that a scene asks for.
Where the path is lost the energy is minimised again further down, and other shapes are tried.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import field, replace
from functools import cached_property

import numpy as np

from ribbonopt.attempt.ledger import Ledger
from ribbonopt.attempt.structure import Structure
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess, ShapeGuess
from ribbonopt.guess.shapes import Chord, Shape
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.laws.smooth import (
    ROD,
    first_law,
    first_laws,
    in_family,
    named,
    sharpened,
    sharpness,
)
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import Law, Variational
from ribbonopt.solution.solution import Solution

from .energy import MESH, least_energy_of
from .first_shape import compresses, follower_loads, indeterminate, loaded, shapes_for
from .homotopy import HomotopyPath, follow
from .loops import closed_posed, fundamental_scene, newton_suffices
from .tracking import smooth_of
from .unfold import unfolded

FIRST, LAST = 0.3, 0.01  # delta of the first solve, and of the last unless the scene's is smaller
BLUNT = 0.1  # the last where the law has an energy form of its own to go on with
STRAIGHT = 1e-6  # strains, Dw = L = 1
SAME = 1e-6  # relative, of energies
# Ratio of a rod's stiffnesses: its layers, of about the root, are thinner than the mesh sees.
THINNEST = MESH.intervals**-2
AGAIN, SNAPS = 2, 6  # how often the energy is minimised again where the path is lost; of rods


@dataclass(frozen=True, eq=False)
class Automatic:
    """Everything that is built for the automatic start of one structure of scenes, when needed."""

    posed: Posed
    structure: Structure | None = None
    _energies: dict[tuple[type, bool], Structure] = field(default_factory=dict)
    _homotopies: dict[type, Structure] = field(default_factory=dict)

    def guesses(self, posed: Posed, ledger: Ledger, shape: Shape | None = None) -> Iterator[Guess]:
        """Yield guesses for a scene of this structure, the best first; each is made when asked for.

        What was done is noted in the ledger. `shape` is used instead of the scene's own.
        """
        same = posed.structure == self.posed.structure
        mechanics = (lambda _: self._inverted) if same else Ribbon.of
        follower = follower_loads(posed, mechanics) if shape is None else None
        if follower is not None:
            ledger.note("integrated from the loads of the end", 0.0)
            yield follower
            what = "the ribbon integrated from the loads of its end led nowhere"
            ledger.fall_back("loads", f"{what}; others of the automatic start did")
        if shape is None and self._piece is not None:
            yield from self._unfolded(posed, ledger)
            what = "the band unfolded from its fundamental piece led nowhere"
            ledger.fall_back("piece", f"{what}; it was started from the least energy of the whole")
        # A law that is not smooth may refuse the last point and take an earlier one.
        last = slice(-1, None) if in_family(posed.scene.law) else slice(None)
        straight: list[Solution] = []
        met: list[float] = []
        ribbon = self._spatial if same else None
        for number, start in enumerate([shape] if shape else shapes_for(posed, ribbon)):
            if number:
                what = "shape that fits the ends" if number == 1 else "shapes that fit the ends"
                first = f"the first {'' if number == 1 else f'{number} '}{what} led nowhere"
                ledger.fall_back("shape", f"{first}; the automatic start went on from another")
            for law in first_laws(posed.scene.law, FIRST):
                points = self._points(posed, start, law, ledger, met)
                if not points and not straight and isinstance(start, Chord) and start.straight:
                    # Far from where the energy began: its loads are brought on from none.
                    straight = self._from_straight(posed, replace(start, bow=0.0), ledger)
                    # What stays straight may be the top of a hill: other shapes come first.
                    points = straight if straight and _is_bent(straight[-1]) else []
                yield from reversed(points[last])
        if straight and not _is_bent(straight[-1]):
            yield from reversed(straight[last])

    @cached_property
    def _last(self) -> float:
        """Delta to go down to for a law that is none of the smooth ones."""
        law = capabilities(self.posed.scene)
        return LAST if law.direct() is law else BLUNT

    @cached_property
    def _alone(self) -> bool:
        """Whether the ribbon bends about d2 alone: in its plane its own law is as smooth as any."""
        return capabilities(self.posed.scene).components == (1,)

    def _energy(self, law: Law, quick: bool) -> Structure:
        """Return what finds least energies: the numbers of a law may tell which it begins with."""
        if (type(law), quick) not in self._energies:
            least = least_energy_of(closed_posed(self.posed), law, quick=quick)
            self._energies[type(law), quick] = Structure.least_energy(least)
        return self._energies[type(law), quick]

    def _homotopy(self, law: Law) -> Structure:
        if type(law) not in self._homotopies:
            self._homotopies[type(law)] = Structure.of(smooth_of(self.posed, law), self.structure)
        return self._homotopies[type(law)]

    @cached_property
    def _spatial(self) -> Ribbon:
        """Mechanics in space, by which shapes find their ends."""
        return Ribbon.of(self.posed.under(states="reduced"))

    @cached_property
    def _inverted(self) -> Ribbon:
        """Mechanics by which known loads are integrated."""
        own, plain = self.structure, self.posed.under(formulation="inverted", states="reduced")
        same = plain.equations == self.posed.equations
        return own.ribbon if own is not None and same else Ribbon.of(plain)

    @cached_property
    def _piece(self) -> Automatic | None:
        """The fundamental piece of a band of several half twists, of which this is more."""
        scene = fundamental_scene(self.posed.scene)
        return None if scene is None else Automatic(Posed.of(scene))

    def _unfolded(self, posed: Posed, ledger: Ledger) -> Iterator[Guess]:
        """Yield what unfolds from the fundamental piece: least energy would untwist the band."""
        piece = fundamental_scene(posed.scene)
        assert self._piece is not None and piece is not None
        for guess in self._piece.guesses(Posed.of(piece), ledger):
            if isinstance(guess, Solution):
                yield unfolded(guess, posed)

    def _points(
        self, posed: Posed, shape: Shape, law: Law, ledger: Ledger, met: list[float]
    ) -> list[Solution]:
        """Equilibria on the way down from a smooth law, the nearest to the scene's law last.

        `met` are energies of rods from which others led nowhere; this one's is added.
        """
        own = posed.scene.law
        guess = ShapeGuess(shape)
        last = sharpness(own, self._last)
        if isinstance(shape, Chord) and _fits(posed, shape) and not _bends(posed, shape):
            # At this delta the law is linear: it can be bent from a straight ribbon.
            started = self._from_straight(posed, shape, ledger)
            if not started and not loaded(posed):
                raise indeterminate(posed, shape)
            return started
        if newton_suffices(posed, shape, law):
            followed = self._follow(posed, law, guess, last, ledger, "twisted circle, ")
            if followed.complete:
                return list(followed.points)
        points: list[Solution] = []
        start: Guess = guess
        # Uneven rods snap on their way, from one equilibrium to the next.
        for _ in range(1 + (AGAIN if isinstance(law, Variational) else SNAPS)):
            quick = True
            least = self._least(posed, law, start, ledger, True)
            if not least.status.converged:
                quick, least = False, self._least(posed, law, start, ledger, False)
            if not least.status.converged:
                break
            if not points and not isinstance(law, Variational) and in_family(law):
                if any(abs(least.energy - energy) <= SAME * energy for energy in met):
                    break
                met.append(least.energy)
            ahead = own if self._alone else law
            followed = self._follow(posed, ahead, least, last, ledger)
            if quick and not followed.points:  # on few elements it may be too far from any
                least = self._least(posed, law, least, ledger, False)
                followed = self._follow(posed, ahead, least, last, ledger)
            points += followed.points
            if followed.complete or not followed.points or not in_family(law):
                break
            # The branch has an end here: the energy's minimum goes on elsewhere.
            start = followed.points[-1]
            further = max(last, 0.6 * sharpness(start.scene.law, last))
            if not isinstance(law, Variational) and further < THINNEST:
                break
            what = f"the path of the automatic start was lost at{_delta(start.scene.law)[1:]}"
            ledger.fall_back("path", f"{what}; it went on from the least energy there")
            law = sharpened(law, further)
        return points

    def _from_straight(self, posed: Posed, chord: Chord, ledger: Ledger) -> list[Solution]:
        """Equilibria from a straight ribbon as its loads grow, under the law that is linear."""
        rod = posed.scene.law if self._alone else first_law(posed.scene.law, ROD)
        last = sharpness(posed.scene.law, self._last)
        return list(self._follow(posed, rod, ShapeGuess(chord), last, ledger).points)

    def _least(self, posed: Posed, law: Law, start: Guess, ledger: Ledger, quick: bool) -> Solution:
        """Least energy from a guess, on few elements if `quick`; worth nothing unless converged."""
        special = least_energy_of(closed_posed(posed), law, quick=quick)
        attempt = self._energy(law, quick).attempt(special)
        attempt.run(start, check=False)
        assert attempt.best is not None  # whether converged or not
        (report,) = attempt.ledger.reports
        outcome = "" if report.status.converged else f" ({report.status.name.lower()})"
        step = f"least energy{_delta(law)}{'' if quick else ' on more elements'}, ipopt{outcome}"
        ledger.note(step, report.total, report.iterations)
        return attempt.best

    def _follow(
        self, posed: Posed, law: Law, guess: Guess, last: float, ledger: Ledger, words: str = ""
    ) -> HomotopyPath:
        started = time.perf_counter()
        followed = follow(self._homotopy(law), posed, law, guess, last)
        reached = _delta(followed.points[-1].scene.law) if followed.points else " (lost at once)"
        lost = "" if followed.complete or not followed.points else " (lost there)"
        step = f"{words}newton in {followed.steps} steps{reached}{lost}"
        ledger.note(step, time.perf_counter() - started, followed.iterations)
        return followed


def _fits(posed: Posed, chord: Chord) -> bool:
    """Whether a straight ribbon fits the ends of a chord, stretched if it can be."""
    return chord.straight or (chord.taut and capabilities(posed.scene).stretches)


def _bends(posed: Posed, chord: Chord) -> bool:
    """Whether something bends a straight ribbon between its ends, so that it is no start."""
    natural = capabilities(posed.scene).natural
    return posed.loaded or natural or compresses(posed, chord)


def _is_bent(solution: Solution) -> bool:
    """Whether a ribbon is not straight, as the smallest bow would not be."""
    return bool(np.abs(solution.trajectory.at_stages["u"]).max() > STRAIGHT)


def _delta(law: Law) -> str:
    return f", {named(law)}" if in_family(law) else ""
