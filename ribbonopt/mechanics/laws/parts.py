"""What laws read, and what they hand to generic code: switches, singularities, programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import NamedTuple

import casadi as ca

from ribbonopt.classes import dataclass

#: what a law declares of itself, but for its own states: a law around it declares the same
DECLARED = (
    "components",
    "variational",
    "bounds_eta",
    "developable",
    "smooth",
    "linear_at_zero",
    "natural",
    "spins",
    "edgewise",
    "stretches",
    "kinked",
    "sheeted",
    "fades",
    "switch_name",
    "closed_moment",
)


class Stress(NamedTuple):
    """What a law may read of a section: n, m (3,) along the directors, and its own states.

    Where a phase may be a mixture also force and couple (3,) per length along the directors, None
    without loads: they move n1 and m2, which it keeps.
    """

    n: ca.SX
    m: ca.SX
    own: ca.SX
    load: ca.SX | None = None
    couple: ca.SX | None = None

    @classmethod
    def of_moment(cls, m: ca.SX) -> Stress:
        """Return the stress of a moment (3,) alone."""
        return cls(ca.SX.zeros(3), m, ca.SX(0, 1))


class Switch(NamedTuple):
    """Where the strains of a kinked law leap: where `value` changes sign and `leap` is not zero.

    Both have the dimension of a moment.
    """

    value: ca.SX
    leap: ca.SX


class Singular(NamedTuple):
    """Where strains are singular as functions of complex s: where `re` + i `im` is zero.

    `re` and `im` have one dimension, whichever; `size` says by how much strains change there, as a
    moment. Near the real axis that is a layer, which a mesh must resolve to be of use. Where it
    `fades` (1, else 0) strains change there in proportion to the distance, but for a logarithm;
    where that is -1 they jump, and are analytic on either side.
    """

    re: ca.SX
    im: ca.SX
    size: ca.SX
    fades: float = 0.0


@dataclass(frozen=True, eq=False)
class Relaxed:
    """A convexified energy as a smooth program over controls along the ribbon.

    `controls` (nz,) symbols; `u` (3,) strains, `cost` per length and `path` (<= 0) as expressions
    of them; `estimate` (nz,), where to start, of the stress; `extension`, of the centre line.

    A law with states of its own says of these controls also the `rates` of its states, and at a
    stress: the `strain` (3,) that they should be, the `complementary` energy, and `own`, states of
    the law that are costates here, by name.
    """

    controls: ca.SX
    u: ca.SX
    cost: ca.SX
    path: ca.SX
    estimate: ca.SX
    rates: ca.SX | None = None
    strain: ca.SX | None = None
    complementary: ca.SX | None = None
    own: Mapping[str, ca.SX] = field(default_factory=dict)
    extension: ca.SX | float = 0.0
