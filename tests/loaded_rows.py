"""Equilibria under loads, with natural curvature, width and finite B1: numbers as printed.

Each was found by shooting and by collocation of the energy alone, in programs that are not here;
`tests/independent` finds them a third time (`test_loaded_rows.py`). Units Dw = L = 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from independent.curved import Along, Material, Natural
from independent.loaded import Strip, rotated, state
from independent.shooting import Shooting, held

Array = np.ndarray

#: the generic clamp: no symmetry, m2 > 0 all along; and the one with an inflection
GENERIC = np.array([0.68, 0.15, 0.31]), rotated((0, 2.4, 0.6))
INFLECTED = np.array([0.3, 0.06, 0.9]), rotated((0, -0.6, 0.5))


@dataclass(frozen=True)
class Row:
    """What a strip is, and what is known of it: numbers as printed."""

    name: str
    strip: Strip
    known: Mapping[str, str]

    def near(self, *names: str) -> Array:
        """Return what is known of these to two digits, where Newton's method starts."""
        return np.array([float(f"{float(self.known[name]):.1e}") for name in names])


def loads(force: str, moment: str) -> dict[str, str]:
    """Printed components of force and moment at the start."""
    names = ("nx", "ny", "nz", "mx", "my", "mz")
    return dict(zip(names, [*force.split(), *moment.split()], strict=True))


def curled(along: Along, poisson_ratio: float = 0.0) -> Strip:
    """Sadowsky's ribbon with natural curvature along it."""
    return Strip(Material("sadowsky", natural=Natural(along, poisson_ratio=poisson_ratio)))


def tapering(s: Array) -> Array:
    """Width 1 - 0.7 s."""
    return 1 - 0.7 * s


FREE = Material("sadowsky")

CLAMPS = (
    Row(
        "free",
        Strip(FREE),
        loads(
            "-3.7729664362 -4.8803077155 -2.1644709480", "3.2080747099 1.7407571504 -0.1047002390"
        )
        | {"u2": "2.6173983946", "u3": "0.8404260689", "W": "3.322035406105"},
    ),
    Row(
        "curled 1.5",
        curled(1.5),
        loads(
            "-3.7045691120 -3.8045322158 -1.8701054982", "3.0607903669 0.2439408333 -0.0886255948"
        )
        | {"u2": "2.6176130580", "u3": "0.8427802639"}
        | {"W": "0.824306719058", "H": "-1.4724776923"},
    ),
    Row(
        "curled 1.5, Poisson's ratio 0.3",
        curled(1.5, 0.3),
        loads(
            "-3.6721204048 -3.4891829129 -1.7818003105", "2.6445203912 0.2477201173 -0.1065043345"
        )
        | {"u2": "2.6205174929", "u3": "0.8382196768"}
        | {"W": "0.759813203481", "H": "-1.3757223975"},
    ),
    Row(
        "curled 4",
        curled(4.0),
        loads(
            "-3.5899534785 -2.0094843653 -1.3788404009", "2.8142120362 -2.2507412979 -0.0612802946"
        )
        | {"u2": "2.6179860331", "u3": "0.8468437020"}
        | {"W": "1.661396462699", "H": "-7.8479487227"},
    ),
    Row(
        "curled 1 + 3 s, Poisson's ratio 0.3",
        curled(lambda s: 1 + 3 * s, 0.3),
        loads("-2.2794713616 -1.6175967627 -4.7475980576", "1.8206504040 0.5674784918 0.1018224728")
        | {"u2": "2.6292099179", "u3": "0.8270796529", "W": "0.574101987347"},
    ),
    Row(
        "tapered",
        Strip(Material("sadowsky", width=tapering)),
        loads("-1.8869542126 -2.4611621770 -3.2609453378", "1.6747929952 1.7809224232 0.2080106729")
        | {"u2": "2.6211922804", "u3": "0.8144819563", "W": "2.100233929442"}
        | {"H": "-1.6643042104", "H1": "0.6664438724"},
    ),
    Row(
        "rod",
        Strip(Material("rod", B=(3, 1, 0.8), strains_of_rod=(0.4, 1, -0.5))),
        loads("-1.8666739446 0.5032061909 -0.5680288001", "0.1092371051 0.8535486222 1.2298306407")
        | {"u1": "0.3246011853", "u2": "2.6168669231", "u3": "0.6153729954"}
        | {"W": "1.505672122148", "H": "1.0258628878", "n.m": "-0.4729783301"},
    ),
    Row(
        "force",
        Strip(FREE, force=(2.0, 4.0, -4.0)),
        loads(
            "-4.1881657369 -3.0727523281 -4.7864697120", "2.8470743636 1.7145038741 -0.0415239075"
        )
        | {"u2": "2.6038842867", "u3": "0.8392531311", "potential": "3.885127825565"}
        | {"H + f.r": "-3.3162769178", "e.(m + r x n)": "2.1197099756"},
    ),
    Row(
        "couple",
        Strip(FREE, couple=(0.0, 1.5, 0.5)),
        loads(
            "-4.4581107192 -5.5622614721 -0.4653804234", "3.5560629400 1.8253131263 -0.1311663744"
        )
        | {"u2": "2.6145039375", "u3": "0.8401219420"},
    ),
    Row(
        "pressure",
        Strip(FREE, pressure=8.0),
        loads(
            "-3.4489154847 -4.8918439300 -5.3525944828", "3.2151020023 1.7627574234 -0.1085666133"
        )
        | {"u2": "2.6206831018", "u3": "0.8408084000", "H": "-3.7959923331"},
    ),
)

INFLECTIONS = (
    Row(
        "inflected",
        curled(0.0),
        loads(
            "16.8669462259 10.1262292991 21.2015089038", "-12.6192283011 1.5751389102 5.9469006056"
        )
        | {"switch": ".42758397060", "W": "3.916012637747"}
        | {"u2": "0.5765587387", "u3": "-0.5765587387"},
    ),
    Row(
        "inflected and curled 0.6",
        curled(0.6),
        loads(
            "16.8879031617 10.0693088718 21.2151084119", "-12.4948410008 0.9806797511 5.9405252136"
        )
        | {"switch": ".42791806584", "W": "4.458500088088"}
        | {"u2": "0.5745882791", "u3": "-0.5745882791"},
    ),
)


def between_clamps(row: Row, switched: bool = False) -> dict[str, float]:
    """Find a row between clamps and return what may be known of it."""
    place, frame = INFLECTED if switched else GENERIC
    names = ("nx", "ny", "nz", "mx", "my", "mz", *(["switch"] if switched else []))
    strip = row.strip
    y = Shooting(lambda y: _clamped(strip, y, place, frame)).solve(row.near(*names))
    start = state(np.zeros(3), np.eye(3), y[:3], y[3:6])
    middle = float(y[6]) if switched else 0.5
    kinds = (1, -1) if switched else (1, 1)
    halves = strip.along(start, (0.0, middle, 1.0), kinds)
    u = strain(strip, halves[0], middle)
    (W,), (V,) = halves[-1][18:]
    found = dict(zip(names, y, strict=True))
    found |= {f"u{i + 1}": abs(u[i]) if switched and i == 1 else u[i] for i in range(3)}
    found |= {"W": W, "potential": W - V, "n.m": float(y[:3] @ y[3:6])}
    found |= {"H": float(strip.energy(start, kinds[0], np.zeros(1))[1, 0])}
    found |= {"H1": float(strip.energy(halves[-1], kinds[-1], np.ones(1))[1, 0])}
    found |= {"H + f.r": found["H"], "e.(m + r x n)": float(np.array([1, 2, -2]) @ y[3:6] / 3)}
    return found


def _clamped(strip: Strip, y: Array, place: Array, frame: Array) -> Array:
    start = state(np.zeros(3), np.eye(3), y[:3], y[3:6])
    if len(y) == 6:
        return held(strip.along(start, (0.0, 1.0), (1,))[-1], place, frame)
    middle, end = strip.along(start, (0.0, y[6], 1.0), (1, -1))
    return np.concatenate([held(end, place, frame), strip.turn(middle, y[6])[None]])


def strain(strip: Strip, y: Array, s: float, kind: int = 1) -> Array:
    """Strains (3,) of a state of one column."""
    own = np.einsum("ijk,jk->ik", y[3:12].reshape(3, 3, -1), y[15:18])
    return strip.material.strains(kind, own, np.full(1, s))[0][:, 0]
