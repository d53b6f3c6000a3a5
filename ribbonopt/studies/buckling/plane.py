"""Buckling loads where two numbers of a scene move: a curve in the plane of the two.

Neither of them need be the load: along any straight line in the plane the straight states are all
but affine in the way p along it, so that the problem of `infinitesimal` finds the p at which the
curve crosses the line. With lines across the curve it is followed wherever it turns. A point of it
leads to the next with the mode as the guess, and Newton's method on that one's mesh; the curve
goes where the straight state can move and p stays, from the factors of the same problem:

    F(w, base) = 0,    dw = -F_w^-1 (dF/dbase) d(base),    p is one of the unknowns w.
"""

from __future__ import annotations

from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import Ribbon
from ribbonopt.scene import Scene
from ribbonopt.scene.lens import with_value
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.condense import factored
from ribbonopt.transcription.residuals import Residuals

from .infinitesimal import Deflected
from .mode import Mode
from .modes import Search
from .rod import RodBuckling
from .straight import AFFINE, BEYOND, NEARER, SETTLED, TURNS, StraightStates

REACH = 0.02  # of the sizes that count as one: half a line across the curve
SAME = 1e-6  # of the line: crossings this near are one, found twice
SHIFT = 1e-5  # of the sizes: half the distance that derivatives along the curve are taken over


@dataclass(frozen=True, eq=False)
class Crossing:
    """Where the curve of buckling loads crosses a line.

    Attributes
    ----------
    place : (2,) array
        Both numbers.
    span : (2,) array
        From p = 0 to p = 1 on the line.
    error : float
        Bound of the error of p.
    mode : Mode
        The infinitesimal deflection; its load is p.
    """

    place: Array
    span: Array
    error: float
    mode: Mode


@dataclass(frozen=True, eq=False)
class LoadsInPlane:
    """The buckling loads of a scene in the plane of two of its numbers.

    Attributes
    ----------
    prepared : Prepared
        The structure.
    straight : Solution
        A straight state, at any place.
    paths : pair of str
        The numbers l1 and l2, in the units of the scene.
    sizes : (2,) array
        Changes of them that count as one.
    log : bool
        Whether the second is given by its logarithm to base 10.
    """

    prepared: Prepared
    straight: Solution
    paths: tuple[str, str]
    sizes: Array
    log: bool = False

    def scene(self, place: Array) -> Scene:
        """Return the scene at a place (2,)."""
        second = 10.0 ** float(place[1]) if self.log else float(place[1])
        scene = with_value(self.straight.scene, self.paths[0], float(place[0]))
        return with_value(scene, self.paths[1], second)

    def found(self, line: Array) -> list[Crossing]:
        """Return where the curve crosses a line (2, 2), searched by way of a linear rod.

        By increasing way from its first end; empty where there is no straight state.
        """
        states, way = self._states(line), line[1] - line[0]
        # A rod may buckle beyond the line, as a ribbon is softer than the rod with its stiffnesses;
        # but the further the ends, the less what is between them is straight in the load.
        loads = [load for share in BEYOND for load in states.between(-share, 1 + share) or ()]
        result: list[Crossing] = []
        last = -np.inf
        for load in sorted(loads, key=lambda one: one.value):
            if 0 <= load.value <= 1 and load.value - last > SAME:
                last, place = load.value, line[0] + load.value * way
                found = self.crossed(load.mode, self.across(place, way))
                result += [] if found is None else [found]
        return result

    def crossed(self, known: Mode, line: Array) -> Crossing | None:
        """Return where the curve crosses a line (2, 2), from a mode near by.

        None where Newton's method does not find it, or where m2 of the mode changes its sign
        elsewhere than in the phases that are known.
        """
        whole = float(np.linalg.norm((line[1] - line[0]) / self.sizes))
        mode = known
        for _ in range(TURNS):
            states, span = self._states(line), line[1] - line[0]
            a, b = _at(states, 0.0), _at(states, 1.0)
            if a is None or b is None:
                # A number that a scene cannot have, perhaps: not so next to the middle.
                line = np.array([middle(line) - NEARER * span, middle(line) + NEARER * span])
                continue
            if float(np.abs(b - a).max()) <= AFFINE * float(np.abs(a).max()):
                return None  # nothing moves along the line
            search = self._search(a, b)
            found = search.moved(mode, (a + b) / 2)
            if found is None or not found.admissible:
                return None
            mode = search.refined(found, found.trajectory.problem)
            place = line[0] + mode.load * span
            exact, taken = _at(states, mode.load), search.at(mode.load)
            if exact is None:
                return None
            off = float(np.abs(exact - taken).max()) / max(1.0, float(np.abs(exact).max()))
            if off <= AFFINE:
                settled = SETTLED * whole / float(np.linalg.norm(span / self.sizes))
                return Crossing(place, span, mode.error + settled, mode)
            line = np.array([place - NEARER * span, place + NEARER * span])
        return None

    def across(self, place: Array, way: Array) -> Array:
        """Return the line (2, 2) of a direction (2,) through a place (2,), which is its middle."""
        half = REACH * way / np.linalg.norm(way / self.sizes)
        return np.array([place - half, place + half])

    def tangent(self, one: Crossing) -> Array:
        """Return the direction (2,) of the curve at a crossing, of unit size.

        LinAlgError where the line that it is found on does not cross the curve there.
        """
        along = one.span / self.sizes / np.linalg.norm(one.span / self.sizes)
        ways = along * self.sizes, np.array([-along[1], along[0]]) * self.sizes
        output = one.mode.trajectory.dense
        _, derivatives = output.blocks.linearize(output.w, output.p)
        factors = factored(output.blocks, derivatives, output.p)
        rates = []
        for way in ways:
            step = factors.solve(self._slope(one, SHIFT * way))
            _, _, constants = output.blocks.layout.unpack(step)
            rates.append(float(constants[self._deflected.sizes[1]]))
        # Where the mode's own p need not move.
        found = rates[0] * ways[1] - rates[1] * ways[0]
        return np.asarray(found / np.linalg.norm(found / self.sizes))

    def _slope(self, one: Crossing, step: Array) -> Residuals:
        """Return the derivative of the mode's residuals as its straight state moves by a step."""
        states = self._states(np.array([one.place - step, one.place + step]))
        before, after = states.at(0.0, beside=True), states.at(1.0, beside=True)
        if before is None or after is None:
            raise np.linalg.LinAlgError("no straight state beside a buckling load")
        output = one.mode.trajectory.dense
        blocks, count = output.blocks, len(after)
        change = np.zeros_like(output.theta)
        change[:count] = change[count : 2 * count] = (after - before) / 2
        layout, widths = blocks.layout, blocks.widths(output.p)
        ahead, behind = (
            blocks.residuals(output.w, layout.parameters(output.theta + sign * change, widths))
            for sign in (1, -1)
        )
        return Residuals(
            (ahead.stages - behind.stages) / 2,
            (ahead.nodes - behind.nodes) / 2,
            (ahead.conditions - behind.conditions) / 2,
        )

    def _states(self, line: Array) -> StraightStates:
        def place(p: float) -> Scene:
            return self.scene(line[0] + p * (line[1] - line[0]))

        return StraightStates(self.prepared, self.straight, place, self._own.ribbon)

    def _search(self, a: Array, b: Array) -> Search:
        compliances = ca.SX.zeros(3)  # only a search from the rod asks for them
        return Search(RodBuckling(self._deflected, compliances, a, b), self._own.smooth)

    @cached_property
    def _own(self) -> StraightStates:
        return StraightStates(self.prepared, self.straight, lambda _: self.straight.scene)

    @cached_property
    def _deflected(self) -> Deflected:
        return Deflected(self.ribbon)

    @cached_property
    def ribbon(self) -> Ribbon:
        """Mechanics with the fewest unknowns."""
        return self._own.ribbon


def middle(line: Array) -> Array:
    """Return the middle (2,) of a line (2, 2)."""
    return np.asarray((line[0] + line[1]) / 2)


def _at(states: StraightStates, value: float) -> Array | None:
    """Start, constants and parameters of a straight state; None where there is no such scene."""
    try:
        return states.at(value)
    except SceneError:
        return None
