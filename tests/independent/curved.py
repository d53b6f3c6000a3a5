"""Laws of ribbons that are curved when free, of variable width, and of rods with finite B1.

Typed anew from the plate: Sadowsky's law by the eigenvectors of N = [[m2 + K11, m3/2 + K12],
[m3/2 + K12, K22]], smooth laws as derivatives of their energies by steps along the imaginary axis,
which are exact. Units Dw = L = 1; what depends on s is a number or a function of arrays of s.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .plates import Plate
from .rod import Array, Law

Along = float | Callable[[Array], Array]
TINY = 1e-120  # squares of it are still numbers
IMAGINARY = 1e-30
EITHER = 2  # kind of an arc in the plane: whichever sheet


def value(of: Along, s: Array) -> Array:
    """Values at arclengths s (k,)."""
    found = of(np.asarray(s, float)) if callable(of) else of
    return np.broadcast_to(np.asarray(found, float), np.shape(s))


@dataclass(frozen=True)
class Natural:
    """Curvatures along, twist and curvature across of the free ribbon; Poisson's ratio."""

    curvature: Along = 0.0
    twist: Along = 0.0
    across: Along = 0.0
    poisson_ratio: float = 0.0

    def moments(self, s: Array) -> tuple[Array, Array, Array, Array]:
        """K11, K12, K22 and the constant C of the energy at arclengths s (k,)."""
        nu = self.poisson_ratio
        along, twist, across = (value(k, s) for k in (self.curvature, self.twist, self.across))
        squares = along**2 + 2 * twist**2 + across**2
        constant = ((1 - nu) * squares + nu * (along + across) ** 2) / 2
        return along + nu * across, (1 - nu) * twist, across + nu * along, constant


@dataclass(frozen=True)
class Material:
    """A law: sadowsky, variational (delta), kirchhoff or rod (B1, B2, B3 and natural strains).

    Or that of a `plate`, extensible or sano; or regularized (epsilon), of a ribbon straight when
    free, on whichever sheet m2 says: it has a kink there only.

    Sadowsky's law is taken by sheets as in `Law`: the kind is the sign of T = m2 + K11 + K22 (in
    units of the width); EITHER is the larger one, in the plane.
    """

    name: str
    delta: float = 0.0
    B: tuple[float, float, float] = (np.inf, 1.0, 2.0)
    strains_of_rod: tuple[float, float, float] = (0.0, 0.0, 0.0)
    natural: Natural = Natural()
    width: Along = 1.0
    plate: Plate | None = None
    epsilon: float = 0.0

    @property
    def switched(self) -> bool:
        """Whether it has two sheets."""
        return self.name == "sadowsky"

    def strains(self, kind: int, m: Array, s: Array) -> tuple[Array, Array]:
        """Strains (3, k) and energy per length (k,) at moments m (3, k) along the directors."""
        w = value(self.width, s)
        m = m / w
        if self.name == "rod":
            B, k = (np.array(v)[:, None] for v in (self.B, self.strains_of_rod))
            u = m / B + k
            return u, w * (m**2 / (2 * B)).sum(axis=0)
        K11, K12, K22, constant = self.natural.moments(s)
        a, b = m[1] + K11, m[2] + 2 * K12
        if self.name == "kirchhoff":
            if np.any(K22):
                raise ValueError("a rod has no curvature across")
            u2, u3 = a / self.B[1], b / self.B[2]
            legendre = (a * u2 + b * u3) / 2
        elif self.plate is not None:
            if np.any(K22):
                raise ValueError("natural strains across are not known of this law")
            u2, u3 = self.plate.strains(a, b)
            energy = self.plate.unit**2 * self.plate.energy(
                u2 / self.plate.unit, u3 / self.plate.unit
            )
            legendre = a * u2 + b * u3 - energy
        elif self.name == "sadowsky":
            N = np.array([[a, b / 2], [b / 2, K22]]).transpose(2, 0, 1)
            values, vectors = np.linalg.eigh(N)
            which = np.where(np.broadcast_to(kind, len(N)) > 0, 1, 0)  # they ascend
            if kind == EITHER:
                which = np.abs(values).argmax(axis=1)
            columns = np.arange(len(N))
            largest, (t1, t2) = values[columns, which], vectors[columns, :, which].T
            u2, u3, legendre = largest * t1 * t1, largest * t1 * t2, largest**2 / 2
        elif self.name == "regularized":
            if any(np.any(K) for K in (K11, K12, K22)):
                raise ValueError("natural strains are not known of this law")
            law = Law("regularized", self.epsilon)
            u2, u3 = law.strains(np.where(a < 0, -1, 1), m, 0 * m)
            legendre = (a * u2 + b * u3) / 2  # of degree two
        else:
            h = IMAGINARY
            legendre = self._smooth(a, b, K22).real
            u2 = self._smooth(a + 1j * h, b, K22).imag / h
            u3 = self._smooth(a, b + 1j * h, K22).imag / h
        # W = m . u - W_Leg, where W_Leg is short of the constant.
        return np.stack([0 * u2, u2, u3]), w * (m[1] * u2 + m[2] * u3 - legendre + constant)

    def _smooth(self, a: Array, b: Array, K22: Array) -> Array:
        """(|T| + R)^2 / 8, both blunted by delta: by c, and by K22, at which planar strips leap."""
        dull = (2 * self.delta * K22) ** 2 + TINY
        q = np.sqrt((a + K22) ** 2 + (self.delta * b) ** 2 + dull)
        R = np.sqrt((a - K22) ** 2 + b**2 + dull)
        return (q + R) ** 2 / 8

    def switch(self, m: Array, s: Array) -> Array:
        """T times the width (k,) at moments m (3, k) along the directors."""
        K11, _, K22, _ = self.natural.moments(s)
        return m[1] + value(self.width, s) * (K11 + K22)

    def mixing(self, s: Array) -> Array:
        """Width w, G of w T = m2 + G, and K12 (3, k)."""
        K11, K12, K22, _ = self.natural.moments(s)
        w = value(self.width, s)
        return np.stack([w, w * (K11 + K22), K12])

    def mixed(self, m: Array, u2: Array, u3: Array, s: Array) -> Array:
        """Energy per length (k,) of a mixture of both sheets, in which T = 0: W_Leg = R^2 / 8."""
        K11, K12, K22, constant = self.natural.moments(s)
        w = value(self.width, s)
        squares = (m[1] / w + K11 - K22) ** 2 + (m[2] / w + 2 * K12) ** 2
        return m[1] * u2 + m[2] * u3 - w * (squares / 8 - constant)
