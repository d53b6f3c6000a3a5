"""What a scene may say of how a ribbon gives in its own plane: edgewise bending and stretch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from ribbonopt.classes import dataclass

from .schema.bounds import Bounds

if TYPE_CHECKING:
    from .model import RibbonSizes
    from .units import Units

Modulus = Annotated[float, Bounds(gt=0)]


@dataclass(frozen=True)
class Membrane:
    """Stiffnesses in the ribbon's own plane.

    A ribbon of one material has B1 = (1 - nu^2) (w / h)^2 and EA = 12 (1 - nu^2) (L / h)^2. With
    `ribbon` units are of its own D, w and L, as those of law.B2 are.

    Attributes
    ----------
    bending
        Stiffness B1 of bending about d1, in units of Dw; left out: infinite. Example: `9100`
    stretching
        Stiffness EA of stretch, in units of Dw / L^2; left out: infinite. Example: `1.09e7`
    """

    bending: Modulus | None = None
    stretching: Modulus | None = None

    def over(self, moment: float, force: float) -> Membrane:
        """Return the same in other units: of B1 times `moment`, of EA times `force`."""
        bending, stretching = self.bending, self.stretching
        return Membrane(
            None if bending is None else bending / moment,
            None if stretching is None else stretching / force,
        )


#: a membrane of a scene: numbers, or those of the sizes of its `ribbon`
AnyMembrane = Literal["ribbon"] | Membrane


def of_sizes(length: float, width: float, thickness: float, ratio: float) -> Membrane:
    """Return the membrane of a ribbon of one material, by its sizes and Poisson's ratio."""
    plate = 1 - ratio**2
    return Membrane(plate * (width / thickness) ** 2, 12 * plate * (length / thickness) ** 2)


def stiffnesses(membrane: AnyMembrane | None) -> dict[str, float | None]:
    """Return the finite stiffnesses by name; None where the sizes of a ribbon tell them."""
    if membrane is None:
        return {}
    if not isinstance(membrane, Membrane):
        return {"bending": None, "stretching": None}
    return {name: value for name, value in vars(membrane).items() if value is not None}


def in_units(
    membrane: AnyMembrane | None, units: Units, ribbon: RibbonSizes | None
) -> AnyMembrane | None:
    """Return a membrane in units of what counts as 1 inside, with the numbers of its ribbon."""
    if membrane is None:
        return None
    if ribbon is None:
        # Without a ribbon `membrane: ribbon` says nothing, which is refused elsewhere.
        if not isinstance(membrane, Membrane):
            return membrane
        return membrane.over(units.stiffness, units.force)
    if not isinstance(membrane, Membrane):
        membrane = of_sizes(ribbon.length, ribbon.width, ribbon.thickness, ribbon.poisson_ratio)
    return membrane.over(units.stiffness, units.stiffness)
