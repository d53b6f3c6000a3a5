"""What stays constant along a ribbon under its loads, and by how much it does not.

n' = -f, m' = n x d3 - c and H' = -f . d3 - c . u for a law that is the same all along, so that

- H + f . r under dead forces that are the same all along, H itself under pressure;
- e . (m + r x n) and e x n where all forces are along one direction e, however they vary with s;
- n and e x (m + r x n) where there are couples alone, all about one direction e;
- |n|^2 / 2 - p m2 in a plane, under a uniform pressure alone.

Without loads n, n . m and H are constant, which is verified at once (`verify`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.loads.load import Load, line_of
from ribbonopt.solution.solution import Solution

PLANAR = 1e-9  # of the largest moment and force: what is out of the plane counts as nothing
H_LOADED, IN_PLANE = "H + f.r", "n^2/2 - p m2"


class Conserved(NamedTuple):
    """A quantity (k,) or (k, 3) at the nodes, units Dw = L = 1, and what its drift is relative to.

    That is the size of its parts, which may cancel. `length` and `force` are the exponents of its
    dimension.
    """

    values: Array
    size: float
    length: int
    force: int

    @property
    def drift(self) -> float:
        """Largest change along the ribbon, relative."""
        change = float(np.abs(self.values - self.values[0]).max())
        return change / self.size if self.size > 0 else change


def conserved(solution: Solution, uniform: bool) -> Mapping[str, Conserved]:
    """Return what stays constant, by name; `uniform` says whether the law is the same all along."""
    nodes, loads = solution.trajectory.at_nodes, solution.posed.loads
    r, n, m = nodes["r"], nodes["n"], nodes["m"]
    force = float(np.abs(n).max())
    about, moment = m + np.cross(r, n), float(np.abs(m).max())
    moment = max(moment, force * float(np.abs(r).max()))
    found: dict[str, Conserved] = {}
    levels = [load.level(r) for load in loads]
    known = [level for level in levels if level is not None]
    if uniform and len(known) == len(levels):
        work = np.sum(known, axis=0)
        name = H_LOADED if work.any() else "H"
        size = max(float(np.abs(part).max()) for part in (nodes["H"], nodes["n3"], work))
        found[name] = Conserved(nodes["H"] + work, size, 0, 1)
    forces, couples = (_common([load.lines_of_action()[i] for load in loads]) for i in (0, 1))
    if forces is not None and couples is not None:
        if not forces.any():
            found["n"] = Conserved(n, force, 0, 1)
            found["e x (m + r x n)"] = Conserved(np.cross(couples, about), moment, 1, 1)
        elif not couples.any():
            found["e.(m + r x n)"] = Conserved(about @ forces, moment, 1, 1)
            found["e x n"] = Conserved(np.cross(forces, n), force, 0, 1)
    if len(loads) == 1 and (level := _in_plane(nodes, loads[0])) is not None:
        found[IN_PLANE] = Conserved(level, force**2, 0, 2)
    return found


def _common(lines: list[Array | None]) -> Array | None:
    """Return the direction (3,) that all share, zero if none has any; None if they differ."""
    known = [line for line in lines if line is not None]
    return line_of(np.array(known)) if len(known) == len(lines) else None


def _in_plane(nodes: Mapping[str, Array], load: Load) -> Array | None:
    """Return what a load alone leaves constant (k,) if the ribbon stays in a plane."""
    small = PLANAR * (1 + max(float(np.abs(nodes[name]).max()) for name in "nm"))
    across = max(float(np.abs(nodes[name]).max()) for name in ("n2", "m1", "m3"))
    return load.level_in_plane(nodes["n"], nodes["m2"]) if across < small else None
