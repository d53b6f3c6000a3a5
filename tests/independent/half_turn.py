"""Where arches that are symmetric under half a turn about x lose that symmetry: shooting of halves.

Clamps at (0, 0, 0) and (0, y, 1 - d), both with directors x, y, z. n_x = 0 by symmetry; unknown are
n_y, n_z and m(0), and at the middle r_y = y/2, r_z = (1 - d)/2, d2_x = d3_x = 0, m_x = 0. What
breaks the symmetry moves n_x and m(0), and has r_x, the turn about x, m_y and m_z zero at the
middle: four by four, singular at the branch points. Slopes by imaginary parts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .marched import TINY, Numbers, marched, newton
from .vibrating import Ribbon


@dataclass(frozen=True)
class Sheared:
    """An arch of a law (see `Ribbon`), shortened by d, in so many steps to its middle."""

    law: tuple[float, float] | float
    d: float
    steps: int = 40

    def middle(self, n: Numbers, m: Numbers) -> tuple[Numbers, Numbers]:
        """State (18,) at the middle, and its slopes (18, 6) by n and m(0), (3,) each."""
        y = np.zeros((18, 6), complex)
        y[3:12] = np.eye(3).reshape(9, 1)
        y[12:] = np.append(n, m)[:, None] + 1j * TINY * np.eye(6)
        rates, still = Ribbon(self.law).rates, np.zeros(1)
        y = marched(lambda s, y: rates(s, y, still), y, (0.0, 0.5), self.steps)
        return y[:, 0].real, y.imag / TINY

    def symmetric(self, q: Numbers, height: float) -> tuple[Numbers, Numbers, Numbers]:
        """What is to vanish (5,), its slopes (5, 5) by q = (n_y, n_z, m), and slopes (4, 4)."""
        y, J = self.middle(np.append(0.0, q[:2]), q[2:])
        d = y[3:12].reshape(3, 3)
        values = np.array([y[1] - height / 2, y[2] - (1 - self.d) / 2, d[1, 0], d[2, 0], y[15]])
        turn = sum(np.cross(d[i], J[3 + 3 * i : 6 + 3 * i], axis=0) for i in range(3)) / 2
        broken = np.stack([J[0], turn[0], J[16], J[17]])[:, [0, 3, 4, 5]]
        return values, J[[1, 2, 6, 9, 15]][:, 1:], broken

    def solved(self, q: Numbers, height: float) -> Numbers:
        """Loads (n_y, n_z, m(0)) (5,) of the symmetric arch near some."""
        return newton(
            lambda q: self.symmetric(q, height)[0], q, lambda q: self.symmetric(q, height)[1]
        )

    def determinant(self, q: Numbers, height: float) -> float:
        """What vanishes at a branch point."""
        broken = self.symmetric(q, height)[2]
        return float(np.linalg.det(broken / np.abs(broken).max(1, keepdims=True)))

    def branch_point(self, q: Numbers, height: float) -> tuple[float, Numbers]:
        """Height y and loads (5,) of the branch point near some."""

        def equations(z: Numbers) -> Numbers:
            values, _, broken = self.symmetric(z[:5], float(z[5]))
            scale = np.array([1.0, 1e-1, 1e-2, 1e-2])
            return np.append(values, np.linalg.det(scale[:, None] * broken))

        z = newton(equations, np.append(q, height))
        return float(z[5]), z[:5]


def crossings(
    arch: Sheared, q: Numbers, heights: Numbers, tell: Callable[[str], None] | None = None
) -> list[tuple[float, Numbers]]:
    """Branch points on the symmetric branch from loads near those at the first height."""
    found, before = [], None
    for height in heights:
        q = arch.solved(q, float(height))
        here = arch.determinant(q, float(height))
        if before is not None and here * before < 0:
            found.append(arch.branch_point(q, float(height)))
            if tell:
                tell(f"{found[-1]}")
        before = here
    return found
