"""What a law says of itself where energy is minimised: a part of `laws.law.ConstitutiveLaw`.

By default the controls are the moments of the strains that it leaves free, u = dW_Leg/dm.
"""

from __future__ import annotations

import casadi as ca

from .parts import Relaxed, Stress


class EnergyForm:
    """What a law leaves free, its own states, and the controls that stand for them."""

    #: strains that are not zero by themselves, by index
    components: tuple[int, ...] = (1, 2)
    #: names of states of its own along the ribbon, with `rates`, `end_conditions`, `own_guess`
    states: tuple[str, ...] = ()
    #: names of the controls of its energy form, where their guess is not of n and m alone
    controls: tuple[str, ...] = ()

    def whole(self, free: ca.SX) -> ca.SX:
        """Return the vector (3,) whose `components` are given, all others zero."""
        values = dict(zip(self.components, ca.vertsplit(free), strict=True))
        return ca.vertcat(*(values.get(i, ca.SX(0)) for i in range(3)))

    def controls_at(self, stress: Stress) -> ca.SX:
        """Return the controls at a stress with all own states: loads by default."""
        return stress.m[list(self.components)]

    def stress_of(self, z: ca.SX, own: ca.SX) -> Stress:
        """Return the stress that these controls stand for."""
        return Stress(ca.SX.zeros(3), self.whole(z), own)

    def relaxed(self, stress: Stress) -> Relaxed | None:
        """Return the program of the energy where that is no function of the moments, or None."""
        return None

    def most_rate(self) -> ca.SX:
        """Return the largest rate of its own states, (k,), where its energy form bounds it."""
        return ca.inf * ca.SX.ones(len(self.states))

    def controls_for(self, stress: Stress, rates: ca.SX) -> ca.SX:
        """Return what controls of its energy form, `controls` by name, give its states rates."""
        return ca.SX(0, 1)
