"""Numbers to test against, computed independently of this package.

Half Moebius ribbon of Sadowsky's law: 28 digits by Taylor series at 180 bits, confirmed by
Gauss-Legendre collocation in another program. Units Dw = L = 1.
"""

from collections.abc import Mapping
from dataclasses import dataclass

HALF_MOEBIUS = {
    "n0": (0.0, 43.4964080173984993703, 42.0522517129717208281),
    "m0": (0.0, 2.00545099623122820984, -8.86920396209993570631),
    "u0": (0.0, 3.38657617297834557330, -2.706318441),
    "H": 57.4495031138344611286,
    "x_end": 0.21269781115303954394,
}

#: by epsilon of eq. (6.1); u2 is that of the law at the moment m0, worked out with 30 digits
REGULARIZED: Mapping[float, dict[str, tuple[float, ...]]] = {
    1e-2: {
        "n0": (0.0, 43.0906492266307374351, 42.9691476231505101214),
        "m0": (0.0, 2.14648365639864840470, -8.64714758544218312320),
        "u2": (3.34380206528176053184,),
    },
    1e-3: {
        "n0": (0.0, 43.4487522694134683085, 42.1544100662442338687),
        "m0": (0.0, 2.02056044251601278939, -8.84375201558034525853),
        "u2": (3.38142004605951682701,),
    },
}

#: u2(0) and H by delta, as printed
VARIATIONAL = {0.01: ("3.3833029", "57.415096"), 0.1: ("3.3500324", "55.946643")}


@dataclass(frozen=True)
class Elastica:
    """Planar elastica, clamped at both ends; numbers as printed."""

    force: str
    deflection: str
    curvature: str
    energy: str


#: by end shortening
ELASTICA = {
    0.25: Elastica("45.2259556678", "0.292389642", "6.61180050", "10.5514640"),
    0.5: Elastica("53.2741125962", "0.373306427", "9.94378432", "22.8023670"),
}

CANTILEVER_DEFLECTION = "0.3017207738"


def agrees(value: float, printed: str) -> bool:
    """Whether a value rounds to the printed digits."""
    decimals = len(printed.partition(".")[2])
    return abs(value - float(printed)) <= 0.5 * 10.0**-decimals * (1 + 1e-6)
