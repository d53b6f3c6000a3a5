"""What vibrates: the ribbon between its ends, or all of a closed band or strip, free or held."""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.solution.solution import Solution

from ..energy_of import Stated, energy_in_plane, energy_of
from ..variation import Variation

IN_PLANE = "in its plane alone"
SYMMETRIC = "with the symmetry of the piece that was solved"


@dataclass(frozen=True, eq=False)
class Vibrating:
    """What vibrates: a solution, its energy, and its conditions.

    `length` is that of all of it, units Dw = L = 1, of which the solution is one of `pieces`;
    `told` says which motions are looked at, where not all; `free` whether it is a closed band that
    nothing holds.
    """

    solution: Solution
    energy: Stated
    length: float
    pieces: int = 1
    told: str = ""
    free: bool = False

    @property
    def posed(self) -> Posed:
        """The scene that is solved."""
        return self.energy.posed

    @property
    def ribbon(self) -> Ribbon:
        """The mechanics."""
        return self.energy.energy.ribbon

    def variation(self, *, again: bool) -> Variation:
        """Return the second variation; `again` for a second opinion on it."""
        return self.energy.energy.variation(self.solution, self.posed.values, again=again)


def stated(solution: Solution, *, planar: bool) -> Vibrating | str:
    """Return what of a solution vibrates or, in words, why nothing does."""
    energy = energy_in_plane(solution) if planar else energy_of(solution)
    if isinstance(energy, str):
        return energy
    told = [IN_PLANE] if energy.posed.scene.states == "planar" else []
    told += [SYMMETRIC] if solution.scene.boundary.repeats else []
    return Vibrating(solution, energy, solution.trajectory.length, told=" and ".join(told))
