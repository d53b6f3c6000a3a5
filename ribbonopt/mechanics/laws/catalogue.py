"""The laws that a scene can name: a file for each kind, and here the union of all.

All but the linear ones are positively homogeneous of degree one and not differentiable at m = 0, so
`relations.norm` is guarded: M = sqrt(m2^2 + m3^2 + GUARD^2), which changes no bit of any result for
M > 1e-51; at m = 0 strains and derivatives are finite.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from importlib import import_module
from numbers import Real
from typing import TYPE_CHECKING, Any

import casadi as ca

from ribbonopt.errors import ModelError
from ribbonopt.scene import Law, OwnLaw, Scene
from ribbonopt.scene.membrane import stiffnesses

from .law import ConstitutiveLaw, Stress

if TYPE_CHECKING:
    from ribbonopt.mechanics.along import Field
    from ribbonopt.scene.along import Along

#: laws by the name a scene gives them: module and class, which is imported when a scene asks for
#: it; the class takes what the scene's has, in order
LAWS: Mapping[str, tuple[str, str]] = {
    "kirchhoff": ("kirchhoff", "KirchhoffLaw"),
    "rod": ("rod", "RodLaw"),
    "sadowsky": ("sadowsky", "SadowskyLaw"),
    "single_sheet": ("sadowsky", "SingleSheetLaw"),
    "regularized": ("blended", "RegularizedLaw"),
    "homotopy": ("blended", "HomotopyLaw"),
    "variational": ("variational", "VariationalLaw"),
    "wunderlich": ("wunderlich", "WunderlichLaw"),
    "extensible": ("extensible", "ExtensibleLaw"),
    "sano": ("sano", "SanoLaw"),
}


def law_class(name: str) -> type[ConstitutiveLaw]:
    """Return the class of a law by the name a scene gives it."""
    module, kind = LAWS[name]
    found: type[ConstitutiveLaw] = getattr(import_module(f".{module}", __package__), kind)
    return found


def always_the_same(law: Law) -> bool:
    """Whether a law by itself is the same all along the ribbon, and has no natural strains."""
    return not isinstance(law, OwnLaw) and law_class(law.type).natural is False


def numbers_of(law: Law) -> dict[str, float]:
    """Return the numbers of a scene's law by name; of triples, along directors, as B.d1.

    Those that are the ribbon's, and stand in a law in units Dw = L = 1 only, are left out.
    """
    named = {name: value for name, value in _numbers(law).items() if value is not None}
    for name, value in named.items():
        if not (isinstance(value, Real) and math.isfinite(value)):
            raise ModelError(f"law.{name}: found {value!r}, expected a number", f"law.{name}")
    return {name: float(value) for name, value in named.items()}


def _numbers(law: Law) -> dict[str, Any]:
    """Return the numbers of a scene's law by name, None where the ribbon tells them."""
    named: dict[str, Any] = {}
    for f in fields(law):
        value = getattr(law, f.name)
        if isinstance(value, tuple):
            named |= {f"{f.name}.d{i}": item for i, item in enumerate(value, start=1)}
        elif f.name != "type":
            named[f.name] = value
    return named


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
        return law_class(law.type)(*_arguments(law, numbers))
    found = law.constitutive(numbers, position)
    if not isinstance(found, ConstitutiveLaw):
        raise ModelError(
            f"law {law.type}: constitutive(numbers, position) returned {type(found).__name__}, "
            "expected a ConstitutiveLaw of ribbonopt.mechanics.laws.law",
            "law",
        )
    return found


def _arguments(law: Law, numbers: Mapping[str, ca.SX]) -> Iterator[ca.SX]:
    """Yield what the class of a law takes, in the order of the scene's fields; triples as (3,)."""
    for name in (f.name for f in fields(law) if f.name != "type"):
        triple = isinstance(getattr(law, name), tuple)
        yield ca.vertcat(*(numbers[f"{name}.d{i}"] for i in (1, 2, 3))) if triple else numbers[name]


def relation_of(scene: Scene, theta: Callable[[str], ca.SX], position: ca.SX) -> ConstitutiveLaw:
    """Return the relation of a scene: its law, and what the scene says of the ribbon beside.

    `theta` gives the symbols of its numbers by name, `position` is the symbol of the arclength s.
    """
    numbers = {name: theta(f"law.{name}") for name in _numbers(scene.law)}
    law = law_of(scene.law, numbers, position)
    along = {field.name: field.at(position, theta) for field in fields_of(scene)}
    if scene.natural is not None:
        from .natural_of import natural_law  # few scenes have natural strains

        law = natural_law(scene, law, along, position)
    if scene.width is not None:
        from .tapered import tapered  # few scenes have a width of their own

        law = tapered(law, along["width"], position)
    if scene.membrane is not None:
        from .membrane import with_membrane  # few scenes have a membrane that gives

        finite = {name: theta(f"membrane.{name}") for name in stiffnesses(scene.membrane)}
        law = with_membrane(law, finite, along.get("width", 1.0), position)
    return law


def fields_of(scene: Scene) -> tuple[Field, ...]:
    """Return the numbers along the ribbon that its relation depends on beside its law."""
    if scene.width is None and scene.natural is None:
        return ()
    from ribbonopt.mechanics.along import Field  # as above

    named: dict[str, Along | None] = {"width": scene.width}
    if scene.natural is not None:
        members = vars(scene.natural).items()
        named |= {f"natural.{name}": 0.0 if value is None else value for name, value in members}
    return tuple(Field(name, value) for name, value in named.items() if value is not None)


def membrane_numbers(scene: Scene) -> dict[str, float]:
    """Return the finite stiffnesses in the ribbon's own plane by the names of their parameters.

    None that the sizes of a `ribbon` tell: these stand in a scene in units Dw = L = 1 only.
    """
    found = stiffnesses(scene.membrane).items()
    return {f"membrane.{name}": float(value) for name, value in found if value is not None}


def curvature_across(scene: Scene) -> float | None:
    """Return K22 = k22 + nu k11 of natural strains, 0 without; None where it is not a number.

    In the units of the scene.
    """
    natural = scene.natural
    if natural is None:
        return 0.0
    k11, k22 = natural.curvature, natural.across
    ribbon = 0.0 if scene.ribbon is None else scene.ribbon.poisson_ratio
    ratio = ribbon if natural.poisson_ratio is None else natural.poisson_ratio
    if not isinstance(k22, float) or not (ratio == 0 or isinstance(k11, float)):
        return None
    return k22 + (ratio * k11 if isinstance(k11, float) else 0.0)


def bends_alone(scene: Scene) -> bool:
    """Whether a strip that stays in its plane leaps nowhere: not one that is curved across, too.

    A continuation may bring that on, if there are natural strains.
    """
    if scene.natural is None:
        return True
    return scene.continuation is None and curvature_across(scene) == 0


def held_law(scene: Scene, law: ConstitutiveLaw) -> ConstitutiveLaw:
    """Return the relation of a scene where it holds its ribbon in a plane; else the one given."""
    return law.in_plane() if scene.states == "planar" and bends_alone(scene) else law


def capabilities(scene: Scene) -> ConstitutiveLaw:
    """Return the relation of a scene, its law in numbers, to be asked what it has."""
    known = {f"law.{name}": ca.SX(value) for name, value in numbers_of(scene.law).items()}
    known |= {name: ca.SX(value) for name, value in membrane_numbers(scene).items()}
    law = relation_of(scene, lambda name: known.get(name, ca.SX.sym(name)), ca.SX.sym("s"))
    return held_law(scene, law)


def is_linear(law: Law, up_to: float = math.inf) -> bool:
    """Whether a law by itself has an energy that is smooth at m = 0: a start may begin with it.

    And, if its strains may leap, that they do not at twisting moments `up_to` that.
    """
    numbers = {name: ca.SX(value) for name, value in numbers_of(law).items()}
    unknown = {name: ca.SX.sym(name) for name in _numbers(law)}
    found = law_of(law, unknown | numbers, ca.SX.sym("s"))
    if not (found.linear_at_zero and found.variational):
        return False
    if found.smooth:
        return True
    leap = found.switching(Stress.of_moment(ca.SX(ca.DM([0, 0, up_to])))).leap
    return bool(ca.evalf(leap) == 0)


def is_developable(scene: Scene) -> bool:
    """Whether the ribbon of a scene is a developable surface; a blend of rod and ribbon is none."""
    return capabilities(scene).developable and numbers_of(scene.law).get("rho", 1.0) == 1.0
