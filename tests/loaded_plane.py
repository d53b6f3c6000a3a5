"""Cantilevers, hanging strips and rings in the plane, and cantilevers that buckle sideways: rows.

As in `loaded_rows`: numbers as printed, and how `tests/independent` finds them. Units Dw = L = 1;
ribbons in the plane of x and z, clamped along z, W = u2^2 / 2.
"""

from __future__ import annotations

import numpy as np
from independent.curved import Material
from independent.loaded import Point, Strip, state
from independent.rod import dot
from independent.shooting import Shooting
from loaded_rows import Array, Row, tapering

HALVES = (0.0, 0.5, 1.0)
BENDING = Material("kirchhoff")
TAPERED = Material("kirchhoff", width=tapering)
CANTILEVERS = (
    Row(
        "tip load, tapered",
        Strip(TAPERED, points=(Point(1.0, (-1, 0, 0)),)),
        {"x": "-0.356148547888", "z": "0.916335210590", "my": "-0.91633521059"},
    ),
    Row(
        "own weight, tapered",
        Strip(TAPERED, (lambda s: -5 * tapering(s), 0, 0)),
        {"x": "-0.326452366854", "z": "0.936274162831", "my": "-1.28159628887"},
    ),
    Row(
        "own weight 1",
        Strip(BENDING, (-1, 0, 0)),
        {"x": "-0.123471401983", "z": "0.991246395347", "my": "-0.49693339993"},
    ),
    Row(
        "own weight 5",
        Strip(BENDING, (-5, 0, 0)),
        {"x": "-0.495905044622", "z": "0.846657179954", "my": "-2.22689255381"}
        | {"potential": "-0.55803344042"},
    ),
    Row(
        "own weight 50",
        Strip(BENDING, (-50, 0, 0)),
        {"x": "-0.907917123477", "z": "0.245014756321", "my": "-9.52846852058"}
        | {"potential": "-17.0738188486"},
    ),
    Row(
        "column 12",
        Strip(BENDING, (0, 0, -12)),
        {"x": "0.849526933032", "z": "0.162135277437", "my": "4.48427846387"}
        | {"potential": "5.283036846566"},
    ),
    Row(
        "two point loads",
        Strip(BENDING, points=(Point(0.5, (-2, 0, 0)), Point(1.0, (-1, 0, 0)))),
        {"x": "-0.447606589454", "z": "0.875968938365", "my": "-1.809822691708"}
        | {"half x": "-0.160450778122", "half z": "0.466926876671"}
        | {"potential": "-0.417310998215"},
    ),
)


def cantilever(row: Row) -> dict[str, float]:
    """Find a cantilever in the plane of x and z, clamped along z."""
    strip = row.strip

    def free(y: Array) -> Array:
        end = strip.jump(strip.along(_planar(y), HALVES, (1, 1))[-1], 1.0)
        return np.stack([end[12], end[14], end[16]])

    y = Shooting(free).solve([0.0, 0.0, *row.near("my")])
    middle, end = strip.along(_planar(y[:, None]), HALVES, (1, 1))
    end = strip.jump(end, 1.0)
    found = {"x": end[0, 0], "z": end[2, 0], "my": y[2], "half x": middle[0, 0]}
    return found | {"half z": middle[2, 0], "potential": end[18, 0] - end[19, 0]}


def _planar(y: Array) -> Array:
    """Start of ribbons in the plane with forces (y[0], 0, y[1]) and moments y[2]."""
    zero = 0 * y[0]
    forces, moments = np.stack([y[0], zero, y[1]]), np.stack([zero, y[2], zero])
    return state(np.zeros(3), np.eye(3), forces, moments)


HANGING = Row(
    "sagging",
    Strip(BENDING, (-20, 0, 0)),
    {"nx": "-10.0000000000", "nz": "-46.8051307226", "my": "-9.3200784860"}
    | {"half x": "-0.349660666208", "half m2": "8.53682823640", "potential": "14.155784141498"},
)


def hanging() -> dict[str, float]:
    """Both ends clamped along z at a span of 0.6 under f = -20 ex, sagging."""
    strip = HANGING.strip

    def met(y: Array) -> Array:
        (end,) = strip.along(_planar(y), (0.0, 1.0), (1,))
        return np.stack([end[0], end[2] - 0.6, end[9]])  # d3 along z: its x vanishes

    y = Shooting(met).solve(HANGING.near("nx", "nz", "my"))
    middle, end = strip.along(_planar(y[:, None]), HALVES, (1, 1))
    found = {"nx": y[0], "nz": y[1], "my": y[2], "half x": middle[0, 0]}
    return found | {"half m2": middle[16, 0], "potential": end[18, 0] - end[19, 0]}


RINGS = {
    3.2: {"long": ".195539899228", "short": ".109338613551", "m2": "11.7751802244"}
    | {"m2 at the short axis": "1.3447998081", "n3": "-155.2118839684", "H": "-85.884449310"},
    5.0: {"long": ".218300474065", "short": ".006996327050", "m2": "23.6380729447"}
    | {"m2 at the short axis": "-5.8837152254", "n3": "-270.7473959323", "H": "8.631850337"},
}


def pressed_ring(pressure: float, near: tuple[float, float]) -> dict[str, float]:
    """Quarter of a ring of length 1 under p R^3 = pressure, from its sharp end (m2, n3 near)."""
    strip = Strip(BENDING, pressure=pressure * (2 * np.pi) ** 3)

    def met(y: Array) -> Array:
        (end,) = strip.along(_planar(y), (0.0, 0.25), (1,))
        return np.stack([y[0], end[11], dot(end[3:6], end[12:15])])

    y = Shooting(met).solve([0.0, near[1], near[0]])
    start = _planar(y[:, None])
    (end,) = strip.along(start, (0.0, 0.25), (1,))
    found = {"long": abs(end[0, 0]), "short": abs(end[2, 0]), "m2": y[2], "n3": y[1]}
    H = strip.energy(start, 1, np.zeros(1))[1, 0]
    return found | {"m2 at the short axis": end[16, 0], "H": H}


#: loads on cantilevers at which the tip has turned so that its quaternion has this component 3
SIDEWAYS = {"weight": "22.0167761285", "tip": "6.8988862429"}


def sideways(kind: str, turned: float = 0.08, law: str = "sadowsky") -> float:
    """Load along d2 under which a cantilever buckled sideways by so much is in equilibrium."""
    material = Material(law)

    def met(y: Array) -> Array:
        zero = 0 * y[0]
        if kind == "weight":
            strip = Strip(material, (0.0, lambda s: -y[6], 0.0))
        else:
            strip = Strip(material, points=(Point(1.0, (zero, -y[6], zero)),))
        start = state(np.zeros(3), np.eye(3), y[:3], y[3:6])
        end = strip.jump(strip.along(start, (0.0, 1.0), (1,))[-1], 1.0)
        d1, d2, d3 = end[3:12].reshape(3, 3, -1)
        scalar = np.sqrt(1 + d1[0] + d2[1] + d3[2]) / 2
        q3 = (d1[1] - d2[0]) / (4 * scalar)
        return np.concatenate([end[12:18], (q3 + turned)[None]])

    load, share = (21.5, 0.5) if kind == "weight" else (6.7, 1.0)
    # m1 = M; m3 from how it buckles: the turn about d3 is about m3 / 2 / B3.
    y = [0.0, -load, 0.0, share * load, 0.0, -6 * turned, load]
    return float(Shooting(met).solve(y)[6])
