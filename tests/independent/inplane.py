"""How a ribbon gives in its own plane: u1 = m1 / B1 and r' = (1 + e) d3 with e = n3 / EA.

A pressure acts on the length as it is stretched, dead loads on that as it was.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .rod import Array, cross, dot


@dataclass(frozen=True)
class InPlane:
    """Stiffnesses at width 1: edgewise bending B1, as the cube of the width, and stretch EA."""

    bending: float = np.inf
    stretching: float = np.inf

    @property
    def rigid(self) -> bool:
        """Whether it does not give at all."""
        return bool(np.isinf(self.bending) and np.isinf(self.stretching))

    def strains(self, n: Array, m: Array, frame: Array, width: Array | float) -> Array:
        """Return u1, e and the energy per length (3, ...) at forces and moments (3, ...)."""
        m1, n3 = dot(frame[0], m), dot(frame[2], n)
        u1, e = m1 / (self.bending * width**3), n3 / (self.stretching * width)
        return np.stack([u1, e, (m1 * u1 + n3 * e) / 2])

    def give(self, out: Array, y: Array, pressed: Array, width: Array | float = 1.0) -> None:
        """Change rates `out` of states y, in which the ribbon does not give.

        `pressed` is the pressure (...).
        """
        if self.rigid:
            return
        frame = y[3:12].reshape(3, 3, *y.shape[1:])
        u1, e, energy = self.strains(y[12:15], y[15:18], frame, width)
        out[:3] += e * frame[2]
        out[6:9] += u1 * frame[2]
        out[9:12] -= u1 * frame[1]
        out[12:15] -= pressed * e * frame[0]
        out[15:18] += e * cross(y[12:15], frame[2])
        out[18] += energy
