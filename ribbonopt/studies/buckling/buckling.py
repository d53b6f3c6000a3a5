"""Buckling loads of straight ribbons whose law has no linearisation at m2 = m3 = 0.

    for found in buckling_loads(scene, "parameters.P", 1, 8):
        print(found.value, found.error)
        solve with guess=found.guess(0.05)

Lateral buckling of a strip by a force along its width, or by its own weight, is such a state: it
bears n and m1, but neither m2 nor m3, until it buckles. See `infinitesimal` for the equations.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.checks.zero_moment import SHORTEST, share_without_moment, unbent_share
from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError, SceneError
from ribbonopt.mechanics.laws.catalogue import relation_of
from ribbonopt.mechanics.laws.law import ConstitutiveLaw
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.problem import Posed, Ribbon, formulate
from ribbonopt.scene import Scene, Variational, validate_scene
from ribbonopt.scene.lens import value_at, with_value
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


def buckling_loads(scene: Scene, parameter: str, start: float, end: float) -> tuple[Buckling, ...]:
    """Return the buckling loads of a straight ribbon as a number of its scene moves.

    Those that are found: each load of a linear rod in the place of the ribbon is followed to the
    ribbon's law.

    Parameters
    ----------
    scene
        The scene; its law is homogeneous of degree one, and the ribbon straight without m2 and m3.
    parameter
        What moves, as in a `continuation`, such as `parameters.P`.
    start, end
        Its range, in the units of the scene.

    Returns
    -------
    tuple of Buckling
        By increasing distance from the start.

    Raises
    ------
    ModelError
        If the ribbon at the start is not such a state, or its law has states of its own.
    """
    # Another formulation has the same straight states; one that minimises may not find them.
    first = with_value(replace(scene, formulation="inverted", continuation=None), parameter, start)
    prepared = prepare(first)
    straight = prepared.solve()
    found = buckling_from(prepared, straight, parameter, start, end)
    bent = float(np.abs(straight.at_nodes["u1"]).max())
    if not found and prepared.ribbon.law.edgewise and bent > 0:
        raise ModelError(
            f"{parameter}: no buckling load was found, but the ribbon is bent in its own plane "
            "before it buckles (membrane.bending), where some may be missed; search a smaller "
            "range, or leave membrane.bending out",
            "membrane.bending",
        )
    return found


def buckling_from(
    prepared: Prepared, straight: Solution, parameter: str, start: float, end: float
) -> tuple[Buckling, ...]:
    """Return what `buckling_loads` does, from a straight solution at any load."""
    if unbent_share(straight, prepared.ribbon.law) < 1 - SHORTEST or not straight.verified:
        raise ModelError(
            f"{parameter}: buckling loads are sought where a ribbon is straight with m2 = m3 = 0 "
            f"all along and its law (found {straight.scene.law.type}) has no linearisation there; "
            "else `continue` finds them as branch points"
        )
    if prepared.ribbon.law.states:
        raise ModelError(
            f"law {straight.scene.law.type}: has states of its own, of which the equations of an "
            "infinitesimal deflection know nothing",
            "law",
        )
    states = _States(prepared, straight, parameter)
    # A ribbon is softer than the rod that has its stiffnesses, at most by two: a rod may buckle
    # beyond the range, as far as there are straight ones.
    low, high = min(start, end), max(start, end)
    found = None
    for share in BEYOND:
        reach = low + min(0.0, share * low), high + max(0.0, share * high)
        found = states.between(*reach)
        if found is not None:
            break
    inside = [one for one in found or () if low <= one.value <= high]
    return tuple(sorted(inside, key=lambda one: abs(one.value - start)))


@dataclass(frozen=True, eq=False)
class _States:
    """Straight states of a scene at any value of a parameter."""

    prepared: Prepared
    straight: Solution
    parameter: str

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
        posed = Posed.of(with_value(self.straight.scene, self.parameter, value))
        states = "planar" if posed.scene.states == "planar" else "reduced"
        return posed.under(formulation="inverted", states=states)

    def at(self, value: float) -> Array | None:
        """Start, constants and parameters (nx + nc + nt,) of the straight state, or None."""
        # Beyond the range that is asked for a number may be none that a scene can have.
        scene = validate_scene(with_value(self.straight.scene, self.parameter, value))
        found = self.prepared.solve(scene, guess=self.straight, fallback=False)
        if not found.verified and self._rod is not None:
            found = self._rod.solve(twin_scene(scene), guess=self.straight, fallback=False)
        if not found.verified or share_without_moment(found, self.ribbon.law) < 1 - SHORTEST:
            return None
        least = self.least(value)
        ends = found.fields(np.array([0.0, 1.0]))
        x, c = self.ribbon.model.pack(ends, least.start[0])
        reactions = self.reactions(found)
        for i, name in enumerate(self.ribbon.constants):
            c[i] = reactions.get(name, c[i])
        return np.concatenate([x[0], c, least.values])

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
        scene = self.least(value_at(self.straight.scene, self.parameter)).scene
        theta = {**self.ribbon.theta, "law.delta": ca.SX(SMOOTH)}
        scene = replace(scene, law=Variational(delta=SMOOTH))
        return relation_of(scene, theta.__getitem__, self.ribbon.position)

    @cached_property
    def _rod(self) -> Prepared | None:
        law, scene = self.prepared.ribbon.law, self.straight.scene
        return twin_of(scene) if has_twin(law, scene, self.parameter) else None

    @cached_property
    def ribbon(self) -> Ribbon:
        """Mechanics with the fewest unknowns."""
        return formulate(self.least(value_at(self.straight.scene, self.parameter)))[0]
