"""What vibrates: the ribbon between its ends, or all of a closed band, which nothing holds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.ends.conditions import Component, Frame
from ribbonopt.mechanics.laws.asymmetry import changed_by_sliding
from ribbonopt.mechanics.planar import PlanarRod
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import Loop
from ribbonopt.solution.solution import Solution

from ..energy_of import Stated, energy_in_plane, energy_of
from ..flip import Flip, at_ends, flip_at
from ..gauss_stages import packed, sampled
from ..topology import ClosedBand, declared
from ..variation import Variation
from .images import whole
from .whole_ends import Clamps, Closing

CLAMP = 4  # conditions: three components of a position, and a frame
IN_PLANE = "in its plane alone"
SYMMETRIC = "with the symmetry of the piece that was solved"
HELD = "with its start held as the scene says, since loads act"


@dataclass(frozen=True, eq=False)
class Vibrating:
    """What vibrates: a solution, its energy, and its conditions.

    `told` says which motions are looked at, where not all; `band` is a closed band that nothing
    holds, or a strip between two clamps, of which the solution is all or a piece; `slides` says
    whether it may slide along itself.
    """

    solution: Solution
    energy: Stated
    told: str = ""
    band: ClosedBand | None = None
    slides: bool = False

    @property
    def posed(self) -> Posed:
        """The scene that is solved."""
        return self.energy.posed

    @property
    def ribbon(self) -> Ribbon:
        """The mechanics."""
        return self.energy.energy.ribbon

    @property
    def pieces(self) -> int:
        """How many times what was solved makes what vibrates."""
        return 1 if self.band is None else self.band.pieces

    @property
    def length(self) -> float:
        """Length of what vibrates, units Dw = L = 1."""
        return self.pieces * self.solution.trajectory.length

    def variation(self, *, again: bool) -> Variation:
        """Return the second variation; `again` for a second opinion on it."""
        energy, theta = self.energy.energy, self.posed.values
        given = sampled(self.solution, again=again)
        if self.pieces > 1:
            assert self.band is not None
            given = whole(self.band, given)
            theta = self._along_all(theta)
        at = packed(self.solution, given, energy.ribbon, theta)
        return energy.at_stages(self.solution, at, theta, self.length)

    def _along_all(self, theta: Array) -> Array:
        """Numbers of the scene with the interval of all pieces."""
        names = list(self.ribbon.theta)
        start, end = (names.index(f"interval.{name}") for name in ("start", "end"))
        theta = theta.copy()
        theta[end] = theta[start] + self.pieces * (theta[end] - theta[start])
        return theta


def stated(solution: Solution, *, planar: bool) -> Vibrating | str:
    """Return what of a solution vibrates or, in words, why nothing does."""
    energy = energy_in_plane(solution) if planar else energy_of(solution)
    if isinstance(energy, str) and not planar:
        # A ribbon that is held in a plane may have an energy there alone.
        inside = energy_in_plane(solution)
        energy = energy if isinstance(inside, str) else inside
    if isinstance(energy, str):
        return energy
    told = [IN_PLANE] if energy.posed.scene.states == "planar" else []
    loop = solution.scene.boundary.loop
    if loop is not None and not _held(energy, loop):
        return _free(solution, energy, loop, "".join(told))
    if loop is None and (flip := _other_half(solution, energy)) is not None:
        clamps = Clamps(isinstance(energy.energy.ribbon.model, PlanarRod))
        ends = replace(energy.energy, conditions=clamps.conditions, bent=clamps.bent)
        strip = ClosedBand(solution, np.zeros(3), 0.0, flip)
        return Vibrating(solution, energy._replace(energy=ends), "".join(told), strip)
    told += [SYMMETRIC] if solution.scene.boundary.repeats else []
    told += [HELD] if loop is not None and loop.piece == "whole" else []
    return Vibrating(solution, energy, ", ".join(told))


def _other_half(solution: Solution, energy: Stated) -> Flip | None:
    """Return the flip that gives the other half of a strip between clamps; None of any other."""
    boundary, posed = solution.scene.boundary, energy.posed
    if boundary.pieces != 2 or boundary.end.support != "flip" or posed.loaded or boundary.also:
        return None
    start = [c for c in posed.conditions if isinstance(c, Component | Frame) and c.end == "start"]
    clamped = len(start) == CLAMP and any(isinstance(c, Frame) for c in start)
    director = boundary.end.axis
    if not clamped or director not in ("d1", "d2") or _alone(energy, odd=False):
        return None
    start_and_end = np.array(solution.scene.interval)
    return flip_at(at_ends(solution), start_and_end, 1, director)


def _alone(energy: Stated, odd: bool) -> bool:
    """Whether what varies along a piece, or its sides of a kink, are known of it alone."""
    law = energy.energy.ribbon.law
    return changed_by_sliding(energy.posed.scene, odd=odd) or bool(law.states) or not law.smooth


def _held(energy: Stated, loop: Loop) -> bool:
    """Whether all of a loop, free, cannot be put together of what is known of it."""
    posed = energy.posed
    # A pressure goes with the band, whatever it does as a whole.
    outside = any(load.name != "loads.pressure" for load in posed.loads)
    if posed.stations or outside or posed.scene.boundary.also:
        return True
    return loop.piece != "whole" and _alone(energy, odd=loop.half_twists % 2 == 1)


def _free(solution: Solution, energy: Stated, loop: Loop, told: str) -> Vibrating:
    """Return all of a closed band, which nothing holds."""
    odd = loop.half_twists % 2 == 1
    closing = Closing(odd, isinstance(energy.energy.ribbon.model, PlanarRod))
    ends = replace(energy.energy, conditions=closing.conditions, bent=closing.bent)
    slides = not changed_by_sliding(energy.posed.scene, odd=odd)
    band = declared(solution, loop)
    return Vibrating(solution, energy._replace(energy=ends), told, band, slides)
