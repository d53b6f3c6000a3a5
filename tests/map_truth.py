"""Numbers of maps and of vibrations, computed independently of this package.

Shooting of order 8 in equal steps (`tests/independent`: `plane_loci`, `half_turn`, `vibrating`),
two numbers of steps agree to the digits; those of the tables of folds and branch points by Taylor
series to 50 digits besides. Units Dw = L = 1, mass per length one; angles in degrees.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

#: by shortening: where a strip snaps of which one clamp is turned against the bow
ONE_CLAMP = {
    1e-4: 1.0208856038,
    1e-3: 3.2284127239,
    0.003: 5.5921157191,
    0.01: 10.2119046246,
    0.03: 17.6976390922,
    0.05: 22.8595483544,
    0.1: 32.3633539404,
    0.15: 39.6646056051,
    0.2: 45.8110670728,
    0.25: 51.1996292141,
    0.3: 56.0243147015,
    0.35: 60.3892236210,
    0.4: 64.3483022372,
    0.45: 67.9209087904,
    0.5: 71.0964462129,
}

#: both clamps turned against the bow: a leaning branch crosses, the symmetric one folds
MIRROR = {
    1e-4: (1.1459264629, 1.1527488924),
    1e-3: (3.6240471298, 3.6456555419),
    0.003: (6.2782253378, 6.3157836118),
    0.01: (11.4700410601, 11.5394636833),
    0.03: (19.9045281569, 20.0291557524),
    0.05: (25.7456825265, 25.9125893315),
    0.1: (36.5843542629, 36.8441435567),
    0.15: (45.0213911710, 45.3738562558),
    0.2: (52.2345409524, 52.6887159925),
    0.25: (58.6758391529, 59.2472575346),
    0.3: (64.5732251838, 65.2844556088),
    0.35: (70.0573529030, 70.9400787771),
    0.4: (75.2067540586, 76.3055391223),
    0.45: (80.0660840136, 81.4447545072),
    0.5: (84.6520549496, 86.4047229631),
}

#: angle over the root of the shortening, radians, of a strip that is nearly flat
FLAT = {"one clamp": 1.78177604115671294, "branch point": 2.0, "fold": 2.01190530422067}

#: by force per length towards +x, the way of the bow, at a shortening of 0.1: fold of one clamp
WEIGHTED = {
    -8.0: 28.0236747383,
    -4.0: 30.1660838417,
    -2.0: 31.2577728188,
    2.0: 33.4830518056,
    4.0: 34.6171339228,
    8.0: 36.9297663175,
}

#: by the part of the width that is lost towards the clamp that is turned
TAPERED = {0.4: 30.4940919752, 0.6: 29.3239213723}

#: points of the closed fold curve at a shortening of 0.1: angles of both clamps
CURVE = (
    (32.3633539404, 0.0),
    (32.6209388857, 4.0),
    (32.8842014, 7.46883),
    (33.6109206, 15.52324),
    (34.3979880, 22.93355),
    (35.1491349, 29.11395),
    (33.4498359, -28.66067),
)
CUSPS = ((36.5843542629, 36.5843542629), (36.6242808043, -36.6242808043))

#: by shortening: where the sheared arch, Kirchhoff 1, 2, loses and regains its symmetry
SHEARED = {
    0.1: (0.106386037595, 0.29666159426),
    0.15: (0.152208796130, 0.3677940161),
    0.2: (0.193448265863, 0.4239752289),
    0.25: (0.230279190221, 0.46983316454),
    0.3: (0.262831860144, 0.507812703),
    0.35: (0.291196047949, 0.539386062),
    0.4: (0.315420374410, 0.56550940407),
    0.45: (0.335508068348, 0.586830990),
}

#: by delta: load at the tip at which a strip on edge buckles sideways; in the limit 6.729347254560
ON_EDGE = {
    1e-3: 6.729292787981,
    0.01: 6.725747726639,
    0.1: 6.555578944016,
    1.0: 4.012599343579,
}


def same_sense(shortening: float) -> tuple[float, float]:
    """Angle of both clamps, turned in the same sense, at which bow and S shape meet; the force.

    That is the largest slope of the arch itself: a = 2 asin k with 2 E(k) / K(k) = 2 - d.
    """
    m = brentq(
        lambda m: 2 * ellipe(m) / ellipk(m) - 2 + shortening, 1e-13, 0.9, xtol=1e-17, rtol=1e-15
    )
    return float(np.degrees(2 * np.arcsin(np.sqrt(m)))), float(16 * ellipk(m) ** 2)


class Vibrations(NamedTuple):
    """Frequencies in the plane and out of it, of rods with B2 = 1, B3 = 2, and a scene of them."""

    scene: str
    inside: tuple[float, ...]
    outside: tuple[float, ...]
    inertia: float = 0.0


CLAMP = "start: {support: clamped, position: [0, 0, 0], directors: identity}"
FREE = f"boundary: {{{CLAMP}, end: {{support: free}}}}"


def _arch(shortening: float, angle: float) -> str:
    turned = f"directors: {{turns: [{{y: -{angle}*pi/180}}]}}"
    return (
        f"boundary: {{start: {{support: clamped, position: [0, 0, 0], {turned}}}, "
        f"end: {{support: clamped, position: [0, 0, {1 - shortening}], directors: identity}}}}"
    )


#: in no other table: loads, natural curvature, width that tapers, clamps turned
VIBRATIONS = {
    "heavy": Vibrations(
        f"{FREE}\nloads: {{force: {{x: -5}}}}",
        (4.1158308972, 21.6203594229, 58.3018636209, 116.672917416),
        (18.092503163,),
    ),
    "heavy, inertia": Vibrations(
        f"{FREE}\nloads: {{force: {{x: -5}}}}", (), (17.7981057811, 98.3781713784), 1e-3
    ),
    "tapered": Vibrations(
        f"{FREE}\nwidth: 1 - 0.7*s", (4.9316419817, 24.6872796348, 64.5266273302, 123.873035455), ()
    ),
    "tapered, heavy": Vibrations(
        f"{FREE}\nwidth: 1 - 0.7*s\nloads: {{force: {{x: -3}}}}",
        (5.4274899459, 24.5256393228, 63.1697140296, 122.300226449),
        (32.631127091,),
    ),
    "curled": Vibrations(
        f"{FREE}\nnatural: {{curvature: 2.5}}",
        (3.9914334257, 14.936766301, 50.688860951, 108.875776002),
        (8.2370587699, 59.682863141),
    ),
    "curled, inertia": Vibrations(
        f"{FREE}\nnatural: {{curvature: 2.5}}", (), (8.2231085129, 55.551243101), 1e-3
    ),
    "arch, turned by 25": Vibrations(
        f"{_arch(0.2, 25)}\n"
        "guess: {force: [-1.08196926, 0, -51.191189], moment: [0, 5.6365573, 0]}",
        (37.2291313475, 63.8989471876, 123.552913263, 210.82442937),
        (52.594248186,),
    ),
    "arch, turned by 40": Vibrations(
        f"{_arch(0.35, 40)}\n"
        "guess: {force: [-2.9332923, 0, -58.0482773], moment: [0, 7.1584373, 0]}",
        (35.8999183135, 54.4104093148, 112.760929723, 185.74756856),
        (42.433958775, 202.040584569),
    ),
}
