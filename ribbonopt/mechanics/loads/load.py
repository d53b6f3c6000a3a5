"""What a load along the ribbon says: force and couple per length at a section.

A class in a file beside this one, named in `catalogue`; or one of a user's own, an instance of
which stands in a scene built in Python: `Scene(..., loads=Loads(own=(...,)))`.

Lab frame; units D w / L^3 and D w / L^2. Numbers are parameters of the problem by name, the paths
of the scene; `theta` gives their symbols.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping

import casadi as ca

from ribbonopt.arrays import Array
from ribbonopt.mechanics.section import Section

Theta = Callable[[str], ca.SX]


class Load(ABC):
    """Force and couple per length."""

    #: path in the scene, for messages
    name: str = "loads"
    #: it does not depend on the shape, so that it has a potential
    dead: bool = False

    @abstractmethod
    def numbers(self) -> Mapping[str, float]:
        """Numbers of this load by parameter name."""

    @abstractmethod
    def force(self, section: Section, theta: Theta) -> ca.SX:
        """Force (3,) per length on the ribbon at a section, lab frame."""

    @abstractmethod
    def symmetries(self, motions: Array) -> Array:
        """Return combinations (k, j) of rigid motions (6, k) that leave this load as it is.

        Motions are three translations, then three turns about the lab axes.
        """

    def work(self, r: Array, weights: Array) -> float:
        """Work of a dead load on positions r (k, 3), by a quadrature with weights (k,)."""
        return 0.0

    def level(self, r: Array) -> Array | None:
        """Return what to add to H (k,) at positions r (k, 3) to make it constant; None for none."""
        return None

    def couple(self, section: Section, theta: Theta) -> ca.SX:
        """Couple (3,) per length on the ribbon at a section, lab frame."""
        return ca.SX.zeros(3)


class DeadLoad(Load):
    """A load that does not depend on the shape: its force up to s is known."""

    dead = True

    @abstractmethod
    def total(self, s: ca.SX, theta: Theta) -> ca.SX:
        """Force (3,) from the start of the ribbon to the arclength s, lab frame."""
