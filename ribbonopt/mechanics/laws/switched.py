"""Laws whose strains jump or kink at m2 = 0, in phases of one side or a mixture of both."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import casadi as ca

from .law import ConstitutiveLaw, RibbonLaw, Stress
from .mixture import MixtureLaw


class SwitchedLaw(RibbonLaw):
    """A law with two sides, by the sign of m2."""

    kinked = True

    @abstractmethod
    def sheet(self, chi: int) -> ConstitutiveLaw:
        """Return the law of the side chi = sign(m2), continued analytically beyond m2 = 0."""

    @property
    @abstractmethod
    def mixture(self) -> MixtureLaw:
        """The mixture of both sides."""

    @abstractmethod
    def on_sheet(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        """Return the margins of a side."""

    @abstractmethod
    def between(self, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        """Return what must not be negative where strains are between those of both sides."""

    def branch(self, kind: int) -> ConstitutiveLaw:
        return self.sheet(kind) if kind else self.mixture

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        zero = {"m2 = 0": stress.m[1]}
        # What a mixture demands where it begins it keeps to its end, so that one end will do. At an
        # end of the ribbon none of it is asked, and `zeros` tell whether the ends allow it: those
        # of a symmetric band do, those of a clamp only by design, as for a helix.
        if kinds[i] == 0 and i < len(kinds) - 1:
            return zero | {"n1 + m1 u3 = 0": self.mixture.drift(stress)}
        return {} if kinds[i - 1] == 0 and i > 1 else zero

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        if kind:
            return self.on_sheet(kind, stress)
        unstable = "the mixture {where} is unstable: K < 0"
        return {unstable: self.mixture.stiffness(stress), **self.between(stress, u)}

    def zeros(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        if kind:
            return {}
        return {
            "m2 is not zero {where}: not a mixture": stress.m[1],
            "n1 + m1 u3 is not zero {where}: not a mixture": self.mixture.drift(stress),
        }
