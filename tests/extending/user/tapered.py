"""A linear rod whose width falls along it: w(s) = 1 - taper s."""

from dataclasses import dataclass

from ribbonopt.mechanics.laws.kirchhoff import KirchhoffLaw


@dataclass(frozen=True)
class Tapered:
    taper: float = 0.7
    type: str = "tapered"

    def constitutive(self, numbers, position):
        width = 1 - numbers["taper"] * position
        return KirchhoffLaw(width, width)
