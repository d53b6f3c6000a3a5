"""Units: SI where a scene says what its ribbon is made of, else Dw = L = 1 (section 2).

All that is solved is solved in the special units Dw = L = 1. `in_special_units` is the only door
to them: what it returns has no `ribbon`, so that it is a scene like any other, its units are 1, and
to convert it again changes nothing. (`theta_of` refuses a scene that was not converted, `Solution`
multiplies what comes out.) Only the text of an equation (`also`) cannot be divided by a unit: its
quantities are SI inside too, by two parameters, `UNIT_LENGTH` and `UNIT_FORCE`, that no formula
can name.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

from .ends import Boundary, End
from .loads import Loads
from .model import Guess, LoadGuess, Reference, Scene, StrainGuess
from .quantities import dimension

UNIT_LENGTH, UNIT_FORCE = "units.length", "units.force"


@dataclass(frozen=True)
class Units:
    """What 1 of the special units is worth: L and D w / L^2, and what follows from them.

    `si` says whether that is in metres and newtons.
    """

    length: float = 1.0
    force: float = 1.0
    si: bool = False

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
    """Return the units of a scene, 1 without a `ribbon`; D = E h^3 / (12 (1 - nu^2))."""
    ribbon = scene.ribbon
    if ribbon is None:
        return Units()
    rigidity = ribbon.youngs_modulus * ribbon.thickness**3 / (12 * (1 - ribbon.poisson_ratio**2))
    return Units(ribbon.length, rigidity * ribbon.width / ribbon.length**2, si=True)


def in_special_units(scene: Scene) -> Scene:
    """Return an equal scene in units Dw = L = 1, formulas evaluated; itself if it is in them."""
    if scene.ribbon is None:
        return scene
    units, boundary, parameters = units_of(scene), scene.boundary, scene.parameters
    (start, end), switches = scene.interval, scene.switching
    own = {UNIT_LENGTH: units.length, UNIT_FORCE: units.force} if boundary.also else {}
    return replace(
        scene,
        interval=(start / units.length, end / units.length),
        parameters=parameters | own,
        boundary=_boundary(boundary, units, parameters),
        loads=_loads(scene.loads, units, parameters),
        guess=_guess(scene.guess, units),
        reference=_reference(scene.reference, units),
        switching=switches if isinstance(switches, str) else _over(switches, units.length),
        ribbon=None,
        record={},
        continuation=None,
    )


def _boundary(boundary: Boundary, units: Units, parameters: Mapping[str, float]) -> Boundary:
    start, end = (_end(end, units, parameters) for end in (boundary.start, boundary.end))
    return replace(boundary, start=start, end=end)


def _loads(loads: Loads, units: Units, parameters: Mapping[str, float]) -> Loads:
    return replace(loads, force=_over(loads.force, units.force / units.length, parameters))


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
        from .formulas.parsing import (
            evaluate_value,  # scenes in plain numbers start without the grammar
        )

        value = evaluate_value(value, parameters or {})
    return float(value) / unit
