"""Laws by their names, with the numbers of a ribbon: its width, thickness and Poisson's ratio.

In units of Dw: B2 = 1 - nu^2, B3 = 2 (1 - nu) and B1 = (1 - nu^2) w^2 / h^2 of a thin strip.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ribbonopt.classes import dataclass
from ribbonopt.scene import (
    Extensible,
    Homotopy,
    Kirchhoff,
    Law,
    Regularized,
    Rod,
    Sadowsky,
    Sano,
    SingleSheet,
    Variational,
    Wunderlich,
)

ALL = "all"
#: what `all` stands for: models of a ribbon, not ways to smooth them; from rod to wide ribbon
MODELS = ("kirchhoff", "sadowsky", "wunderlich", "extensible", "sano")
OPTIONS = {
    "width": "--width 0.05",
    "thickness": "--thickness 0.001",
    "poisson_ratio": "--poisson 0.3",
}
SIZES = ("width", "thickness", "poisson_ratio")
WORDS = {"width": "width", "thickness": "thickness", "poisson_ratio": "Poisson's ratio"}


@dataclass(frozen=True)
class Maker:
    """What a law needs to know of a ribbon, the law of these numbers, and the one without them.

    `asks` is the law that asks the `ribbon` of its scene for them itself, so that it changes with
    it; others are made for one ribbon.
    """

    needs: tuple[str, ...]
    make: Callable[..., Law]
    asks: Law | None = None
    otherwise: Law | None = None
    note: str = ""


def _kirchhoff(poisson_ratio: float) -> Law:
    return Kirchhoff(B2=1 - poisson_ratio**2, B3=2 * (1 - poisson_ratio))


def _rod(width: float, thickness: float, poisson_ratio: float) -> Law:
    """Return the rod of the same section that bends in its plane too: B1 = Y h w^3 / 12."""
    squared = 1 - poisson_ratio**2
    return Rod(B=(squared * (width / thickness) ** 2, squared, 2 * (1 - poisson_ratio)))


def _sano(width: float, thickness: float, poisson_ratio: float) -> Law:
    return Sano().of_sizes(width, thickness, poisson_ratio)


MAKERS: Mapping[str, Maker] = {
    "kirchhoff": Maker(
        ("poisson_ratio",),
        _kirchhoff,
        otherwise=Kirchhoff(),
        note="nothing says Poisson's ratio: stiffnesses of 0; --poisson 0.3 gives others",
    ),
    "rod": Maker(SIZES, _rod),
    "sadowsky": Maker((), Sadowsky),
    "wunderlich": Maker(("width",), Wunderlich, Wunderlich()),
    "extensible": Maker(SIZES, Extensible, Extensible()),
    "sano": Maker(SIZES, _sano, Sano()),
    "variational": Maker((), Variational),
    "regularized": Maker((), Regularized),
    "homotopy": Maker((), Homotopy),
    "single_sheet": Maker((), SingleSheet),
}
