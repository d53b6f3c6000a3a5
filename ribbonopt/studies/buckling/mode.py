"""A buckling load with its infinitesimal deflection, and the signs of m2 along it."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.trajectory import Trajectory

from .square import Pieces

NEGLIGIBLE = 1e-7  # m2 over the largest moment of the mode that has no sign


@dataclass(frozen=True, eq=False)
class Mode:
    """A buckling load and its infinitesimal deflection.

    Attributes
    ----------
    load : float
        p, from 0 at the load a to 1 at b.
    error : float
        Estimated error of p.
    trajectory : Trajectory
        States [x; xi] along the ribbon; m is that of the deflection, along the directors.
    pieces : Pieces or None
        Signs of m2 in the phases; None for a law that needs none.
    """

    load: float
    error: float
    trajectory: Trajectory
    pieces: Pieces | None = None

    @property
    def admissible(self) -> bool:
        """Whether m2 has the sign in each phase that the phase assumes."""
        if self.pieces is None:
            return True
        m, size = self._moments
        signs = np.array(self.pieces.kinds)[self.trajectory.stages[3]]
        return bool((signs * m[:, 1] >= -NEGLIGIBLE * size).all())

    @property
    def signs(self) -> tuple[Pieces, Array]:
        """Signs of m2 between stations, and the fractions (k,) of the length where phases meet.

        Of a mode whose phases meet at stations only.
        """
        m, size = self._moments
        _, f, _, phase = self.trajectory.stages
        kinds, places, stations = [1], list[float](), list[int]()
        for i, begin in enumerate(self.trajectory.ends[:-1]):
            rows = (phase == i) & (np.abs(m[:, 1]) > NEGLIGIBLE * size)
            m2, at = m[rows, 1], f[rows]
            sign = np.sign(m2).astype(int).tolist()
            # Where there is no moment either side will do.
            first = sign[0] if sign else kinds[-1]
            if i:
                stations.append(len(kinds))
                places.append(float(begin))
                kinds.append(first)
            else:
                kinds = [first]
            for k in np.flatnonzero(np.diff(sign)):
                places.append(float(at[k] + (at[k + 1] - at[k]) * m2[k] / (m2[k] - m2[k + 1])))
                kinds.append(sign[k + 1])
        return Pieces(tuple(kinds), tuple(stations)), np.array(places)

    @property
    def _moments(self) -> tuple[Array, float]:
        m = self.trajectory.at_stages["m"]
        return m, float(np.abs(m[:, 1:]).max())
