"""The laws that a scene can name: a file for each kind, and here the union of all.

All but the linear ones are positively homogeneous of degree one and not differentiable at m = 0, so
`relations.norm` is guarded: M = sqrt(m2^2 + m3^2 + GUARD^2), which changes no bit of any result for
M > 1e-51; at m = 0 strains and derivatives are finite.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from numbers import Real

import casadi as ca

from ribbonopt.errors import ModelError
from ribbonopt.scene import Law, OwnLaw

from .blended import HomotopyLaw, RegularizedLaw
from .kirchhoff import KirchhoffLaw
from .law import ConstitutiveLaw
from .sadowsky import SadowskyLaw, SingleSheetLaw
from .variational import VariationalLaw

#: laws by the name a scene gives them; their fields are those of the scene's classes
LAWS: Mapping[str, type[ConstitutiveLaw]] = {
    "kirchhoff": KirchhoffLaw,
    "sadowsky": SadowskyLaw,
    "single_sheet": SingleSheetLaw,
    "regularized": RegularizedLaw,
    "homotopy": HomotopyLaw,
    "variational": VariationalLaw,
}


def numbers_of(law: Law) -> dict[str, float]:
    """Return the numbers of a scene's law by name."""
    named = {f.name: getattr(law, f.name) for f in fields(law) if f.name != "type"}
    for name, value in named.items():
        if not (isinstance(value, Real) and math.isfinite(value)):
            raise ModelError(f"law.{name}: found {value!r}, expected a number", f"law.{name}")
    return {name: float(value) for name, value in named.items()}


def law_of(law: Law, numbers: Mapping[str, ca.SX], position: ca.SX) -> ConstitutiveLaw:
    """Return the relation that a scene's law stands for.

    Parameters
    ----------
    law
        What the scene says. A class of a user's own says itself what it stands for, by a method
        `constitutive(numbers, position)`.
    numbers
        Its numbers by name, as symbols.
    position
        Symbol of the arclength s, on which numbers may depend.
    """
    if not isinstance(law, OwnLaw):
        return LAWS[law.type](**numbers)
    found = law.constitutive(numbers, position)
    if not isinstance(found, ConstitutiveLaw):
        raise ModelError(
            f"law {law.type}: constitutive(numbers, position) returned {type(found).__name__}, "
            "expected a ConstitutiveLaw of ribbonopt.mechanics.laws.law",
            "law",
        )
    return found


def capabilities(law: Law) -> ConstitutiveLaw:
    """Return the relation of a scene's law with symbols of its own, to be asked what it has."""
    return law_of(law, {name: ca.SX.sym(name) for name in numbers_of(law)}, ca.SX.sym("s"))


def is_developable(law: Law) -> bool:
    """Whether the ribbon of a law is a developable surface; a blend of rod and ribbon is none."""
    return capabilities(law).developable and numbers_of(law).get("rho", 1.0) == 1.0
