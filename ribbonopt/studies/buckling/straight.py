"""Straight states with m2 = m3 = 0 along a line of scenes, and the loads on it that buckle them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.checks.zero_moment import SHORTEST, share_without_moment
from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.mechanics.laws.catalogue import relation_of
from ribbonopt.mechanics.laws.law import ConstitutiveLaw
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import Posed, Ribbon, formulate
from ribbonopt.scene import Scene, Variational, validate_scene
from ribbonopt.solution.solution import Solution

from .found import Buckling
from .infinitesimal import Deflected
from .mode import Mode
from .modes import Search
from .rod import RodBuckling, pure_compliances
from .twin import has_twin, twin_of, twin_scene

AFFINE = 1e-10  # of the straight state's numbers: how far from affine in the load they may be
NEARER = 1e-3  # of the distance of two loads that an affine line is drawn through, the next time
SMOOTH = 0.03  # delta of the smooth law that stands for one with a kink
SETTLED = 1e-11  # change of the load, relative to the range, that ends this
TURNS = 8
BEYOND = (1.0, 1 / 4, 1 / 16, 0.0)  # of an end of the range: how far beyond it rods are looked at


@dataclass(frozen=True, eq=False)
class StraightStates:
    """Straight states along a line of scenes.

    Attributes
    ----------
    prepared : Prepared
        The structure.
    straight : Solution
        A straight state of any of the scenes.
    place : function of a float
        The scene at a value.
    known : Ribbon or None
        Mechanics with the fewest unknowns, where the same are at hand for another line.
    """

    prepared: Prepared
    straight: Solution
    place: Callable[[float], Scene]
    known: Ribbon | None = None

    def between(self, low: float, high: float) -> list[Buckling] | None:
        """Buckling loads whose rod buckles between two values; None where there is no state."""
        try:
            a, b = self.at(low), self.at(high)
        except SceneError:
            return None
        if a is None or b is None:
            return None
        compliances = pure_compliances(self.ribbon, self.least(low).values)
        rod = RodBuckling(Deflected(self.ribbon), compliances, a, b)
        if not rod.sound:
            return None
        search, result = Search(rod, self.smooth), []
        for load, start in rod.loads():
            mode = search.mode(load, start)
            found = None if mode is None else self.settled(search, mode, low, high)
            result += [] if found is None else [found]
        return result

    def settled(self, search: Search, mode: Mode, low: float, high: float) -> Buckling | None:
        """Return a load where the straight state is what it is taken for, affine or not."""
        whole = abs(high - low)
        for _ in range(TURNS):
            value = low + mode.load * (high - low)
            exact, taken = self.at(value), search.at(mode.load)
            if exact is None:
                return None
            off = float(np.abs(exact - taken).max()) / max(1.0, float(np.abs(exact).max()))
            if off <= AFFINE:
                error = mode.error * abs(high - low) + SETTLED * whole
                return Buckling(value, error, self.least(value), self.ribbon, mode)
            low, high = (value + sign * NEARER * (high - low) for sign in (-1, 1))
            a, b = self.at(low), self.at(high)
            if a is None or b is None:
                return None
            search = replace(search, rod=replace(search.rod, a=a, b=b))
            again = search.moved(mode, taken)
            if again is None:
                return None
            mode = again
        return None

    def least(self, value: float) -> Posed:
        """Return the scene at a value, in the states with the fewest unknowns."""
        return _least(self.place(value))

    def at(self, value: float, beside: bool = False) -> Array | None:
        """Start, constants and parameters (nx + nc + nt,) of the straight state, or None.

        `beside` says that the value is one beside a valid one, to take differences.
        """
        # Beyond the range that is asked for a number may be none that a scene can have.
        scene = self.place(value) if beside else validate_scene(self.place(value))
        found = self.prepared.solve(scene, guess=self.straight, fallback=False)
        if not self._is_straight(found) and self._rod is not None:
            found = self._rod.solve(twin_scene(scene), guess=self.straight, fallback=False)
        if not self._is_straight(found):
            return None
        least = self.least(value)
        ends = found.fields(np.array([0.0, 1.0]))
        x, c = self.ribbon.model.pack(ends, least.start[0])
        reactions = self.reactions(found)
        for i, name in enumerate(self.ribbon.constants):
            c[i] = reactions.get(name, c[i])
        return np.concatenate([x[0], c, least.values])

    def _is_straight(self, found: Solution) -> bool:
        law = self.ribbon.law
        return found.verified and share_without_moment(found, law) >= 1 - SHORTEST

    def reactions(self, solution: Solution) -> dict[str, float]:
        """Unknown constants of the stations of a solution, by name."""
        problem, dense = solution.problem, solution.dense
        known = dict(zip(problem.constant_names, dense.constants, strict=False))
        for name, value in zip(problem.parameter_names, dense.theta, strict=True):
            known[name.removeprefix("recovered.")] = float(value)
        return {name: known[name] for st in self.ribbon.stations for name in st.unknown}

    @cached_property
    def smooth(self) -> ConstitutiveLaw:
        """The law of the ribbon, or a smooth one that stands for one with a kink."""
        if not self.ribbon.law.kinked:
            return self.ribbon.law
        theta = {**self.ribbon.theta, "law.delta": ca.SX(SMOOTH)}
        scene = replace(self._own.scene, law=Variational(delta=SMOOTH))
        return relation_of(scene, theta.__getitem__, self.ribbon.position)

    @cached_property
    def _rod(self) -> Prepared | None:
        law, scene = self.prepared.ribbon.law, self.straight.scene
        return twin_of(scene) if has_twin(law, scene) else None

    @cached_property
    def ribbon(self) -> Ribbon:
        """Mechanics with the fewest unknowns."""
        return self.known or formulate(self._own)[0]

    @cached_property
    def _own(self) -> Posed:
        """The scene of the straight state that is known, in the states with the fewest unknowns."""
        return _least(self.straight.scene)


def _least(scene: Scene) -> Posed:
    posed = Posed.of(scene)
    states = "planar" if posed.scene.states == "planar" else "reduced"
    return posed.under(formulation="inverted", states=states)
