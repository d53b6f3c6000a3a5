"""Units: SI where a scene says what its ribbon is made of, else Dw = L = 1 (section 2).

All that is solved is solved in the special units Dw = L = 1, where numbers are near one. A scene
without a `ribbon` is in them, unless its interval or its law's stiffness is far from one: then its
own length and stiffness are the units inside. `in_special_units` is the only door: what it returns
has no `ribbon`, so that it is a scene like any other, its units are 1, and to convert it again
changes nothing. (`theta_of` refuses a scene that was not converted, `Solution` multiplies what
comes out.) Only the text of an equation (`also`) cannot be divided by a unit: its quantities are
in those of the scene inside too, by two parameters, `UNIT_LENGTH` and `UNIT_FORCE`, that no formula
can name.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

from ribbonopt.classes import dataclass

from .along import scaled
from .ends import Boundary, End
from .frames import LabVector, Triple
from .guesses import Guess, LoadGuess, StrainGuess
from .inertia import in_units as turning
from .laws import Law, OwnLaw, Stiff
from .loads import AlongAxes, AlongVector, Loads
from .membrane import in_units
from .model import Reference, Scene
from .natural import strains_in_units
from .quantities import dimension
from .sized import Sized
from .stations import InteriorSupport, PointLoad

UNIT_LENGTH, UNIT_FORCE = "units.length", "units.force"
SHORT, LONG = 1e-2, 10.0  # lengths of intervals that need no other unit
SOFT, STIFF = 1e-2, 1e2  # bending stiffnesses that need none
BLEND = 4  # power of the size by which its unit goes over from 1 to the size itself


@dataclass(frozen=True)
class Units:
    """What 1 of the special units is worth: L and D w / L^2, and what follows from them.

    `si` says whether that is in metres and newtons, `stiffness` what the law's is divided by.
    """

    length: float = 1.0
    force: float = 1.0
    si: bool = False
    stiffness: float = 1.0

    @property
    def moment(self) -> float:
        """Unit D w / L of moments and energies."""
        return self.force * self.length

    @property
    def strain(self) -> float:
        """Unit 1 / L of bending and twist."""
        return 1 / self.length

    @property
    def name(self) -> str:
        """The units in words."""
        return "SI (m, N, N m, J)" if self.si else "Dw = L = 1"

    def of(self, quantity: str) -> float:
        """Return the unit of a named quantity."""
        length, force = dimension(quantity)
        return self.length**length * self.force**force


def units_of(scene: Scene) -> Units:
    """Return the units of a scene; D = E h^3 / (12 (1 - nu^2)) with a `ribbon`.

    Without one they are 1 as long as sizes are near one. Laws and loads declared in Python have
    their numbers in units Dw = L = 1, whatever the sizes.
    """
    ribbon, law = scene.ribbon, scene.law
    stiffness = 1.0
    if isinstance(law, Stiff):
        stiffness = _unit(next(iter(law.stiffnesses.values())), SOFT, STIFF)
    if ribbon is None:
        start, end = scene.interval
        length = _unit(end - start, SHORT, LONG)
        if length != 1 and (scene.loads.own or isinstance(law, OwnLaw)):
            length = 1.0
        return Units(length, stiffness / length**2, stiffness=stiffness)
    rigidity = ribbon.youngs_modulus * ribbon.thickness**3 / (12 * (1 - ribbon.poisson_ratio**2))
    force = stiffness * rigidity * ribbon.width / ribbon.length**2
    return Units(ribbon.length, force, si=True, stiffness=stiffness)


def _unit(size: float, least: float, most: float) -> float:
    """Return 1 for a size in a range, the size itself far off it, continuously from one to other.

    What is left, the size over its unit, lies in the range.
    """
    if size < least:
        return max((size / least) ** BLEND, size)
    return min((size / most) ** BLEND, size) if size > most else 1.0


def in_special_units(scene: Scene, units: Units | None = None) -> Scene:
    """Return an equal scene in units Dw = L = 1, formulas evaluated; itself if it is in them.

    `units` are those that count as 1 inside, if not the scene's own.
    """
    units, boundary, parameters = units or units_of(scene), scene.boundary, scene.parameters
    if scene.ribbon is None and units == Units():
        return scene
    (start, end), switches = scene.interval, scene.switching
    own = {UNIT_LENGTH: units.length, UNIT_FORCE: units.force} if boundary.also else {}
    return replace(
        scene,
        law=_law(scene, units),
        interval=(start / units.length, end / units.length),
        parameters=parameters | own,
        boundary=_boundary(boundary, units, parameters),
        loads=_loads(scene.loads, units, parameters),
        gravity=_gravity(scene, units),
        supports=tuple(_support(support, units, parameters) for support in scene.supports),
        width=scaled(scene.width, 1.0, units.length),
        guess=_guess(scene.guess, units),
        reference=_reference(scene.reference, units),
        natural=strains_in_units(scene.natural, units, scene.ribbon),
        membrane=in_units(scene.membrane, units, scene.ribbon),
        inertia=turning(scene.inertia, units, scene.ribbon),
        switching=switches if isinstance(switches, str) else _over(switches, units.length),
        ribbon=None,
        record={},
        continuation=None,
    )


def _law(scene: Scene, units: Units) -> Law:
    """Return a law in units of its own stiffness, with the numbers that are the ribbon's."""
    law, ribbon = scene.law, scene.ribbon
    if isinstance(law, Sized) and ribbon is not None:
        law = law.of_sizes(ribbon.width, ribbon.thickness, ribbon.poisson_ratio)
    known = isinstance(law, Stiff | Sized)
    return law.in_units(units.stiffness, 1 / units.length) if known else law  # type: ignore[union-attr]


def _boundary(boundary: Boundary, units: Units, parameters: Mapping[str, float]) -> Boundary:
    start, end = (_end(end, units, parameters) for end in (boundary.start, boundary.end))
    return replace(boundary, start=start, end=end)


def _loads(loads: Loads, units: Units, parameters: Mapping[str, float]) -> Loads:
    if loads == Loads():
        return loads
    per_length = units.force / units.length
    return replace(
        loads,
        force=_along(loads.force, per_length, units.length),
        couple=_along(loads.couple, units.force, units.length),
        pressure=scaled(loads.pressure, per_length, units.length),
        points=tuple(_point(point, units, parameters) for point in loads.points),
    )


def _along(vector: AlongVector | None, unit: float, length: float) -> AlongVector | None:
    """Return a vector of numbers along the ribbon divided by a unit, its arclength by a length."""
    if isinstance(vector, AlongAxes):
        x, y, z = (scaled(v, unit, length) for v in (vector.x, vector.y, vector.z))
        return AlongAxes(x, y, z)
    if vector is None:
        return None
    x, y, z = (scaled(value, unit, length) for value in vector)
    return x, y, z


def _gravity(scene: Scene, units: Units) -> Triple | LabVector | None:
    """Return the weight per length, for which gravity stands in a scene without a `ribbon`."""
    ribbon = scene.ribbon
    if scene.gravity is None or ribbon is None or ribbon.density is None:
        return scene.gravity
    mass = ribbon.density * ribbon.width * ribbon.thickness
    unit = units.force / units.length / mass
    weight: Triple | LabVector = _over(scene.gravity, unit, scene.parameters)
    return weight


def _point(point: PointLoad, units: Units, parameters: Mapping[str, float]) -> PointLoad:
    return PointLoad(
        at=_over(point.at, units.length, parameters),
        force=_over(point.force, units.force, parameters),
        moment=_over(point.moment, units.moment, parameters),
    )


def _support(
    support: InteriorSupport, units: Units, parameters: Mapping[str, float]
) -> InteriorSupport:
    at = _over(support.at, units.length, parameters)
    return InteriorSupport(at, _over(support.position, units.length, parameters))


def _end(end: End, units: Units, parameters: Mapping[str, float]) -> End:
    """Return an end; directors, axes and directions have no units."""
    return replace(
        end,
        position=_over(end.position, units.length, parameters),
        distance=_over(end.distance, units.length, parameters),
        force=_over(end.force, units.force, parameters),
        moment=_over(end.moment, units.moment, parameters),
    )


def _guess(guess: Guess, units: Units) -> Guess:
    """Return a guess; shapes are given by angles, saved solutions give fields without units."""
    if isinstance(guess, LoadGuess):
        return LoadGuess(_over(guess.force, units.force), _over(guess.moment, units.moment))
    if isinstance(guess, StrainGuess):
        return StrainGuess(_over(guess.strains, units.strain))
    return guess


def _reference(known: Reference | None, units: Units) -> Reference | None:
    if known is None:
        return None
    return Reference(_over(known.n0, units.force), _over(known.m0, units.moment))


def _over(value: Any, unit: float, parameters: Mapping[str, float] | None = None) -> Any:
    """Return a value of a scene, or all the values that it holds, divided by a unit."""
    if value is None:
        return None
    if isinstance(value, tuple | list):
        return tuple(_over(item, unit, parameters) for item in value)
    if is_dataclass(value):
        held = {f.name: getattr(value, f.name) for f in fields(value)}
        return replace(value, **{k: _over(v, unit, parameters) for k, v in held.items()})  # type: ignore[type-var]
    if isinstance(value, str):
        # Scenes in plain numbers start without the grammar.
        from .formulas.parsing import evaluate_value

        value = evaluate_value(value, parameters or {})
    return float(value) / unit
