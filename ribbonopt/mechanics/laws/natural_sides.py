"""Phases of a ribbon with natural strains: T = m2 + K11 + K22 stands in the place of m2."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ribbonopt.classes import dataclass

from .law import Stress
from .natural import NaturalStrains
from .parts import Switch
from .relations import norm

WORDS = "T = m2 + K11 + K22"  # what switches, in messages


@dataclass(frozen=True, eq=False)
class NaturalSides:
    """Where a law with natural strains switches, and what holds in phases: T in the place of m2."""

    k: NaturalStrains

    @property
    def name(self) -> str:
        """What switches, in words."""
        return WORDS

    def switching(self, stress: Stress) -> Switch:
        """T, and twice the leap of u2 there: planar strips leap too where K22 is not zero."""
        T, _, c, _ = self.k.combined(stress.m[1], stress.m[2])
        return Switch(T, norm(2 * self.k.K22, c))

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        """Return what holds where phase i begins; see `switched.SwitchedLaw`."""
        zero = {"T = 0": self.switching(stress).value}
        if kinds[i] == 0 and i < len(kinds) - 1:
            return zero | {"n1 + m1 u3 = K'": self.drift(stress)}
        return {} if kinds[i - 1] == 0 and i > 1 else zero

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        """Return what must not be negative along a phase, by what is wrong where it is."""
        T, D, _, R = self.k.combined(stress.m[1], stress.m[2])
        if kind:
            wrong = f"{WORDS} has the wrong sign {{where}}: no equilibrium of this ribbon"
            return {wrong: kind * T}
        return {
            "the mixture {where} is unstable: K < 0": self.stiffness(stress),
            "u2 is not between both sheets {where}: not a mixture": R / 4 - ca.fabs(u[1] - D / 4),
        }

    def zeros(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        """Return what must be zero along a phase, by what is wrong where it is not."""
        if kind:
            return {}
        return {
            f"{WORDS} is not zero {{where}}: not a mixture": self.switching(stress).value,
            "n1 + m1 u3 - K' is not zero {where}: not a mixture": self.drift(stress),
        }

    def drift(self, stress: Stress) -> ca.SX:
        """Minus the rate of T along a mixture, K being K11 + K22: n1 + m1 u3 - K'."""
        n, m, k = stress.n, stress.m, self.k
        if stress.couple is not None:
            return self.drift(stress._replace(couple=None)) + stress.couple[1]
        return n[0] + m[0] * (m[2] + 2 * k.K12) / 4 - k.rate(k.K11 + k.K22)

    def stiffness(self, stress: Stress) -> ca.SX:
        """n3 + m3 u3 - m1^2 / 4 of a mixture, which must not be negative."""
        n, m = stress.n, stress.m
        return n[2] + m[2] * (m[2] + 2 * self.k.K12) / 4 - m[0] ** 2 / 4
