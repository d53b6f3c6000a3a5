"""The start that needs no guess.

A shape that fits the ends (a chord with frames by slerp, a twisted circle for a loop); least energy
of the smooth law at delta = 0.3; its equilibrium followed by Newton's method, loads brought on and
delta down to 0.01. The result is the guess for the formulation and the law that a scene asks for.
Where the path is lost the energy is minimised again further down, and other shapes are tried.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import Guess, ShapeGuess
from ribbonopt.guess.shapes import Chord, Shape
from ribbonopt.scene import Kirchhoff, Law, Scene, Variational
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import SolveReport

from .energy import LeastEnergy
from .first_shape import compresses, follower_loads, loaded, shapes_for, start_place
from .homotopy import HomotopyPath, SmoothHomotopy
from .loops import closed_scene, fundamental_scene
from .unfold import Unfolded

FIRST, LAST = 0.3, 0.01  # delta of the first solve, and of the last unless the scene's is smaller
ROD = 1.0  # delta at which the law is linear: a straight ribbon without stress can be bent from it
AGAIN = 2  # how often the energy is minimised again where the path is lost
Path = list[Mapping[str, Any]]


@dataclass(frozen=True, eq=False)
class Automatic:
    """Everything that is built for the automatic start of one structure of scenes, when needed."""

    scene: Scene

    def guesses(self, scene: Scene, path: Path, shape: Shape | None = None) -> Iterator[Guess]:
        """Yield guesses for a scene of this structure, the best first; each is made when asked for.

        `path` is told what was done, with its cost. `shape` is used instead of the scene's own.
        """
        follower = follower_loads(scene) if shape is None else None
        if follower is not None:
            path.append({"step": "integrated from the loads of the end", "seconds": 0.0})
            yield follower
        if shape is None and self._piece is not None:
            yield from self._unfolded(scene, path)
        for start in [shape] if shape else shapes_for(scene):
            points = self._points(scene, start, path)
            # A law that is not smooth may refuse the last point and take an earlier one.
            yield from reversed(points if not isinstance(scene.law, Variational) else points[-1:])

    @cached_property
    def _energy(self) -> LeastEnergy:
        return LeastEnergy.of(closed_scene(self.scene), _first_law(self.scene.law))

    @cached_property
    def _homotopy(self) -> SmoothHomotopy:
        return SmoothHomotopy.of(self.scene, _first_law(self.scene.law))

    @cached_property
    def _piece(self) -> Automatic | None:
        """The fundamental piece of a band of several half twists, of which this is more."""
        scene = fundamental_scene(self.scene)
        return None if scene is None else Automatic(scene)

    def _unfolded(self, scene: Scene, path: Path) -> Iterator[Guess]:
        """Yield what unfolds from the fundamental piece: least energy would untwist the band."""
        piece, loop = fundamental_scene(scene), scene.boundary.loop
        assert self._piece is not None and piece is not None and loop is not None
        count = loop.fundamental.pieces // loop.pieces
        place = start_place(scene)
        for guess in self._piece.guesses(piece, path):
            if isinstance(guess, Solution):
                yield Unfolded(guess, loop.half_twists, count, *place)

    def _points(self, scene: Scene, shape: Shape, path: Path) -> list[Solution]:
        """Equilibria on the way down, the nearest to the scene's law last."""
        law, guess = _first_law(scene.law), ShapeGuess(shape)
        last = scene.law.delta if isinstance(scene.law, Variational) else LAST
        if isinstance(shape, Chord) and shape.straight and not compresses(scene, shape):
            rod = law if isinstance(law, Kirchhoff) else Variational(delta=ROD)
            followed = self._follow(scene, rod, guess, last, path)
            if not followed.points and not loaded(scene):
                raise ConvergenceError(
                    "the ribbon is straight and without stress: it cannot bend in its own plane, "
                    "so that the loads of its ends there are not determined; shorten or turn it, "
                    "if only a little",
                    "indeterminate",
                )
            return list(followed.points)
        points: list[Solution] = []
        start: Guess = guess
        for _ in range(1 + AGAIN):
            report, least = self._energy.solve(closed_scene(scene), law, start)
            path.append(_solver_step(f"least energy{_delta(law)}, ipopt", report))
            if not report.status.converged:
                break
            followed = self._follow(scene, law, least, last, path)
            points += followed.points
            if followed.complete or not followed.points or not isinstance(law, Variational):
                break
            # The branch has an end here: the energy's minimum goes on elsewhere.
            reached = followed.points[-1].scene.law
            assert isinstance(reached, Variational)
            law, start = Variational(delta=max(last, 0.6 * reached.delta)), followed.points[-1]
        return points

    def _follow(
        self, scene: Scene, law: Law, guess: Guess, last: float, path: Path
    ) -> HomotopyPath:
        started = time.perf_counter()
        followed = self._homotopy.follow(scene, law, guess, last)
        reached = _delta(followed.points[-1].scene.law) if followed.points else " (lost at once)"
        lost = "" if followed.complete or not followed.points else " (lost there)"
        path.append(
            {
                "step": f"newton in {followed.steps} steps{reached}{lost}",
                "iterations": followed.iterations,
                "seconds": time.perf_counter() - started,
            }
        )
        return followed


def _first_law(law: Law) -> Law:
    """Return the smooth law of the first solve."""
    if isinstance(law, Kirchhoff):
        return law
    return Variational(delta=max(FIRST, law.delta if isinstance(law, Variational) else 0.0))


def _solver_step(step: str, report: SolveReport) -> Mapping[str, Any]:
    outcome = "" if report.status.converged else f" ({report.status.name.lower()})"
    return {
        "step": step + outcome,
        "iterations": report.iterations,
        "seconds": report.total,
    }


def _delta(law: Law) -> str:
    return f", delta = {law.delta:.3g}" if isinstance(law, Variational) else ""
