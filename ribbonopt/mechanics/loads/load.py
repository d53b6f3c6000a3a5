"""What a load along the ribbon says: force and couple per length at a section.

A class in a file beside this one, named in `catalogue`; or one of a user's own, an instance of
which stands in a scene built in Python: `Scene(..., loads=Loads(own=(...,)))`.

Lab frame; units D w / L^3 and D w / L^2. Numbers are parameters of the problem by name, the paths
of the scene; `theta` gives their symbols.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.section import Section

Theta = Callable[[str], ca.SX]
Line = Array | None  # direction (3,), zero of what is nowhere; None where there are several


class Load(ABC):
    """Force and couple per length."""

    #: path in the scene, for messages
    name: str = "loads"
    #: it does not depend on the shape, so that it is known all along the ribbon
    dead: bool = False
    #: why it has no potential, to be read behind its name; empty where it has one, -f . r
    without_potential: str = "follows the ribbon"

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

    def work(self, section: Section, theta: Theta) -> ca.SX:
        """Work per length of a load that has a potential."""
        return ca.dot(self.force(section, theta), section.r)

    def in_plane(self) -> Load | None:
        """Return the load as ribbons have it that stay in a plane, if it has a potential there."""
        return None if self.without_potential else self

    def couple(self, section: Section, theta: Theta) -> ca.SX:
        """Couple (3,) per length on the ribbon at a section, lab frame."""
        return ca.SX.zeros(3)

    def level(self, r: Array) -> Array | None:
        """Return what to add to H (k,) at positions r (k, 3) to make it constant; None for none."""
        return None

    def level_in_plane(self, n: Array, m2: Array) -> Array | None:
        """Return |n|^2 / 2 - p m2 (k,), constant in a plane under this alone; None where not."""
        return None

    def is_carried(self, *, about_d2: bool) -> bool:
        """Whether a flip about d2, or d1, carries it from a piece to the next."""
        return False

    def lines_of_action(self) -> tuple[Line, Line]:
        """Lab directions (3,) in which its force and its couple act, all along the ribbon."""
        return None, None

    def numbers_to_scale(self) -> Iterable[str]:
        """Names of numbers to multiply by a share to have that share of the load."""
        return self.numbers()

    def size_along(self) -> float:
        """Return about its largest size per length, units Dw = L = 1."""
        return max((abs(value) for value in self.numbers().values()), default=0.0)

    def mean_force(self) -> Array:
        """Return about the mean (3,) of a dead force per length, lab frame; zero if not known."""
        return np.zeros(3)

    @property
    def structure_key(self) -> tuple[object, ...]:
        """What loads share that differ in numbers only."""
        return (type(self),)


class DeadLoad(Load):
    """A load that does not depend on the shape: its force up to s is known."""

    dead = True
    without_potential = ""
    #: lab axes along which there may be a force, and about which a couple
    lab_axes: tuple[str, str] = ("xyz", "xyz")
    #: those along which the force up to s has no closed form: it is integrated with the shape
    open_axes: str = ""

    @abstractmethod
    def total(self, s: ca.SX, theta: Theta) -> ca.SX:
        """Force (3,) from the start of the ribbon to the arclength s, lab frame.

        What it says of the axes `open_axes` counts for nothing.
        """


def line_of(samples: Array) -> Line:
    """Return the direction (3,) that vectors (k, 3) share, zero if all vanish; None if none."""
    if len(samples) == 1:
        (only,) = samples
        size = float(np.sqrt(only @ only))
        return np.asarray(only / size) if size > 0 else np.zeros(3)
    _, singular, right = np.linalg.svd(samples)
    if not singular.any():
        return np.zeros(3)
    if len(singular) > 1 and singular[1] > PARALLEL * singular[0]:
        return None
    return np.asarray(right[0])


def turns_that_leave(samples: Array, motions: Array) -> Array:
    """Return combinations (k, j) of motions (6, k) that turn none of the vectors (n, 3)."""
    size = max(float(np.abs(samples).max(initial=0.0)), np.finfo(float).tiny)
    changed = np.cross(motions[None, 3:].swapaxes(1, 2), samples[:, None] / size)
    _, singular, right = np.linalg.svd(changed.swapaxes(1, 2).reshape(-1, motions.shape[1]))
    return np.asarray(right[int((singular > PARALLEL).sum()) :].T)


PARALLEL = 1e-9  # sine of an angle
