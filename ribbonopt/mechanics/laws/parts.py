"""What laws hand to generic code beside strains: switches, singularities, relaxed programs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import casadi as ca

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
    "switch_name",
    "closed_moment",
)


class Switch(NamedTuple):
    """Where the strains of a kinked law leap: where `value` changes sign and `leap` is not zero.

    Both have the dimension of a moment.
    """

    value: ca.SX
    leap: ca.SX


class Singular(NamedTuple):
    """Where strains are singular as functions of complex s: where `re` + i `im` is zero.

    `re` and `im` have one dimension, whichever; `size` says by how much strains change there, as a
    moment. Near the real axis that is a layer, which a mesh must resolve to be of use.
    """

    re: ca.SX
    im: ca.SX
    size: ca.SX


@dataclass(frozen=True, eq=False)
class Relaxed:
    """A convexified energy as a smooth program over controls along the ribbon.

    `controls` (nz,) symbols; `u` (3,) strains, `cost` per length and `path` (<= 0) as expressions
    of them; `estimate` (nz,), where to start, of the stress; `extension`, of the centre line.
    """

    controls: ca.SX
    u: ca.SX
    cost: ca.SX
    path: ca.SX
    estimate: ca.SX
    extension: ca.SX | float = 0.0
