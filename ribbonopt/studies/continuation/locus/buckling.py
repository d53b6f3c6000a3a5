"""Loci of buckling loads, as equations that the walk follows: straight states and their modes.

At m2 = m3 = 0 a law that is homogeneous has no linearisation, and its surface of equilibria no
tangent out of the straight states. So the locus is no curve of test functions on it, but that of
`LoadsInPlane`: of (l1, l2) alone, while the straight state at a place follows from these.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import verified
from ribbonopt.classes import dataclass
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import Posed
from ribbonopt.scene.lens import value_at
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.buckling.plane import Crossing, LoadsInPlane
from ribbonopt.studies.buckling.twin import has_twin, twin_of, twin_scene

from ..trials import checked
from ..walk.metric import Metric
from ..walk.points import TURN, Point, Special
from ..walk.protocol import Trial
from ..walk.special import special_points
from .alone import Alone
from .laid import Laid
from .surface import Surface

AT = 1e-6  # of the spans: how far a load that is found anew may be from where it is known to be
WIDTHS = (1.0, 0.3, 0.05)  # of the range of l1, within which it is looked for
NOT_FOUND_AGAIN = "the buckling load was not found again from the one before"


class Buckled(NamedTuple):
    """The buckling load that the straight state of a trajectory is at."""

    load: Crossing


@dataclass(frozen=True, eq=False)
class Slope:
    """Where a locus of buckling loads goes; nothing crosses it that its mode could tell."""

    direction: Array
    sign: float = 1.0
    log: float = 0.0

    def kernel(self) -> Array:
        """Raise LinAlgError: there is no null direction."""
        raise np.linalg.LinAlgError("a buckling load has no null direction")


@dataclass(frozen=True, eq=False)
class BucklingEquations(Alone):
    """Equations of one locus of buckling loads; unknowns [w, l1, l2], w of the straight state.

    Attributes
    ----------
    prepared : Prepared
        The structure.
    surface : Surface
        The scenes by (l1, l2).
    straight : Solution
        A straight state.
    """

    prepared: Prepared
    surface: Surface
    straight: Solution

    @cached_property
    def metric(self) -> Metric:
        """Arclength in the plane of the parameters."""
        return Metric(np.array(self.surface.spans))

    @cached_property
    def plane(self) -> LoadsInPlane:
        """The buckling loads by place."""
        log = self.surface.stage.scale == "log"
        paths = self.surface.other, self.surface.name
        return LoadsInPlane(self.prepared, self.straight, paths, self.metric.sizes, log)

    def measured(self, solution: Solution) -> BucklingEquations:
        """Return the same: its arclength is the same everywhere."""
        return self

    def reduced(self, solution: Solution, vector: Array) -> Array:
        """Return (l1, l2) of a vector [w, l1, l2]."""
        return vector[-2:]

    def load(self, solution: Solution) -> Crossing:
        """Return the buckling load that a straight state is at; LinAlgError if it is at none."""
        known = solution.trajectory.found
        if Buckled not in known:
            known[Buckled] = Buckled(self._searched(solution))
        load: Crossing = known[Buckled].load
        return load

    def linearise(self, solution: Solution, unknowns: Array, ahead: Array) -> Slope:
        """Return where the locus goes."""
        tangent = self.plane.tangent(self.load(solution))
        direction = np.zeros_like(unknowns)
        direction[-2:] = tangent
        return Slope(direction)

    def heading(self, solution: Solution, unknowns: Array, ahead: Array) -> Slope:
        """Return the same."""
        return self.linearise(solution, unknowns, ahead)

    def correct_at(self, origin: Solution, guess: Array) -> Trial[Solution]:
        """Find the load l1 at a given l2."""
        return self._on(origin, self.plane.across(guess[-2:], np.array([1.0, 0.0])), guess)

    def correct_along(
        self,
        origin: Point[Solution],
        direction: Array,
        arc: float,
        guess: Array,
        enough: float = 0.0,
    ) -> Trial[Solution]:
        """Find the load on the line across a direction at an arclength."""
        sizes = self.metric.sizes
        ahead = direction[-2:] / sizes
        ahead /= np.linalg.norm(ahead)
        across = np.array([-ahead[1], ahead[0]])
        begin = origin.unknowns[-2:] / sizes
        aside = (guess[-2:] / sizes - begin) @ across
        place = (begin + arc * ahead + aside * across) * sizes
        return self._on(origin.solution, self.plane.across(place, across * sizes), guess)

    def special(self, a: Point[Solution], b: Point[Solution]) -> Special[Solution]:
        """Return where the locus turns in l2."""
        found = special_points(self, a, b)
        return replace(found, points=[self._turned(point) for point in found.points])

    def restored(self, origin: Solution, unknowns: Array) -> Solution:
        """Return the straight state at a place, on the mesh of another."""
        return self._straight(origin, unknowns[-2:])

    def verified(self, trial: Trial[Solution]) -> Trial[Solution]:
        """Return a trial after the checks of a solution."""
        found = checked(trial, verified(trial.solution, self.prepared.ribbon))
        return replace(found, unknowns=trial.unknowns)

    def finished(self, origin: Point[Solution], trial: Trial[Solution]) -> Trial[Solution]:
        """Return a trial verified: its load is as exact already as it will be."""
        return self.verified(trial)

    def _on(self, origin: Solution, line: Array, guess: Array) -> Trial[Solution]:
        """Find the load on a line from that of an origin."""
        try:
            load = self.plane.crossed(self.load(origin).mode, line)
        except np.linalg.LinAlgError as lost:
            return Trial(origin, guess, False, str(lost))
        if load is None:
            return Trial(origin, guess, False, NOT_FOUND_AGAIN)
        found = self._straight(origin, load.place)
        found.trajectory.found[Buckled] = Buckled(load)
        unknowns = np.concatenate([found.dense.w, load.place])
        found.trajectory.found[Laid] = self._laid(load, unknowns)
        return Trial(found, unknowns, found.status.converged, found.message)

    def _laid(self, load: Crossing, unknowns: Array) -> Laid:
        """Return the bar of l1 at the given l2, among what is known of a point."""
        tangent, across = np.zeros_like(unknowns), np.zeros_like(unknowns)
        tangent[-2:], across[-2:] = self.plane.tangent(load), load.span
        (t1, t2), off = tangent[-2:], load.error * load.span
        aside = abs(float(off[0] * t2 - off[1] * t1))
        return Laid(tangent, across, error=aside / abs(t2) if t2 else None)

    def _turned(self, point: Point[Solution]) -> Point[Solution]:
        """Return a point where l2 turns as the buckling load that it is."""
        guess = point.unknowns
        trial = self.correct_along(point, point.tangent, 0.0, guess)
        solution, unknowns = trial.solution, trial.unknowns
        return replace(point, kind=TURN, solution=solution, unknowns=unknowns)

    def _searched(self, solution: Solution) -> Crossing:
        """Return the load at a straight state that comes without, as one from a file."""
        scene, surface = solution.scene, self.surface
        l2 = surface.position(value_at(scene, surface.name))
        place = np.array([value_at(scene, surface.other), l2])
        low, high = surface.between
        for share in WIDTHS:
            ends = (
                max(low, place[0] - share * (high - low)),
                min(high, place[0] + share * (high - low)),
            )
            found = self.plane.found(np.array([[l1, l2] for l1 in ends]))
            near = [one for one in found if self.metric.length(one.place - place) <= AT]
            if near:
                return min(near, key=lambda one: self.metric.length(one.place - place))
        raise np.linalg.LinAlgError(NOT_FOUND_AGAIN)

    def _straight(self, origin: Solution, place: Array) -> Solution:
        """Return the straight state at a place, on the mesh of another."""
        posed = self.surface.posed_at(*place)
        parts = origin.sheets, origin.mesh, origin.trajectory.ends[1:-1]
        attempt = self.prepared.search(posed).on_mesh(*parts)
        rod = self._rod
        if rod is None:
            attempt.run_from(origin.dense.w, quick=True, check=False)
            assert attempt.best is not None
            return attempt.best
        stiff = Posed.of(twin_scene(posed.given), self.surface.units)
        twin = rod.search(stiff).on_mesh(*parts)
        twin.run_from(origin.dense.w, quick=True, check=False)
        assert twin.best is not None
        found = attempt.restored(twin.best.dense.w)
        return replace(found, status=twin.best.status, message=twin.best.message)

    @cached_property
    def _rod(self) -> Prepared | None:
        """A linear rod in the place of a law that has no linearisation."""
        law, scene = self.prepared.ribbon.law, self.straight.scene
        return twin_of(scene) if has_twin(law, scene) else None
