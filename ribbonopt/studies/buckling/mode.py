"""A buckling load with its infinitesimal deflection, and the signs of m2 along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.trajectory import Trajectory

from .infinitesimal import Kinds

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
    kinds : tuple of int
        Signs of m2 in the phases; empty for a law that needs none.
    """

    load: float
    error: float
    trajectory: Trajectory
    kinds: Kinds = ()

    @property
    def admissible(self) -> bool:
        """Whether m2 has the sign in each phase that the phase assumes."""
        m, size = self._moments
        phase = self.trajectory.stages[3]
        signs = np.array(self.kinds or (0,))[phase]
        return bool((signs * m[:, 1] >= -NEGLIGIBLE * size).all())

    @property
    def signs(self) -> tuple[Kinds, Array]:
        """Signs of m2 one after another, and the fractions (k,) of the length where they change."""
        m, size = self._moments
        f, m2 = self.trajectory.stages[1], m[:, 1]
        f, m2 = (v[np.abs(m2) > NEGLIGIBLE * size] for v in (f, m2))
        if not len(m2):
            return (1,), np.empty(0)
        sign = np.sign(m2).astype(int)
        at = np.flatnonzero(sign[1:] != sign[:-1])
        places = f[at] + (f[at + 1] - f[at]) * m2[at] / (m2[at] - m2[at + 1])
        return (int(sign[0]), *(int(sign[i + 1]) for i in at)), places

    @property
    def _moments(self) -> tuple[Array, float]:
        m = self.trajectory.at_stages["m"]
        return m, float(np.abs(m[:, 1:]).max())
