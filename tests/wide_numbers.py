"""Wide ribbons whose equilibria are known: clamps, also with an inflection, half Moebius bands.

All numbers are those of `independent`, of two meshes that agree to the digits shown; n0 and m0 are
force and moment at the start, inflections are s, eta and p. Units Dw = L = 1.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from independent.joining import Conditions, clamped
from independent.joints import Joints
from independent.loaded import rotated
from independent.path import rotation
from independent.wide import ETA, D, M, N, P, R, Wide
from independent.wide_starts import meshed, narrow

Array = np.ndarray
ORIGIN, IDENTITY = np.zeros(3), np.eye(3)
BENT = (np.array([0.68, 0.15, 0.31]), rotated((0.0, 2.4, 0.6)))
TURNED = (np.array([0.3, 0.06, 0.9]), rotated((0.0, -0.6, 0.5)))
#: loads of Sadowsky's ribbon, where Newton's method begins
NARROW = {
    "C": ((-3.7729664, -4.8803077, -2.1644709), (3.2080747, 1.7407571, -0.1047002)),
    "S": ((16.8669462, 10.1262293, 21.2015089), (-12.6192283, 1.5751389, 5.9469006)),
    "half": ((0.0, 43.4964080, 42.0522517), (0.0, 2.0054510, -8.8692040)),
}


@dataclass(frozen=True)
class Known:
    """One equilibrium: which (C, S, half), the width, straight edges, and its numbers."""

    of: str
    width: float
    straight: tuple[bool, bool]
    n0: Sequence[float]
    m0: Sequence[float]
    energy: float
    H: float
    inflections: Sequence[Sequence[float]] = ()

    @property
    def length(self) -> float:
        """Of the piece that is solved."""
        return 0.5 if self.of == "half" else 1.0

    @property
    def conditions(self) -> Conditions:
        """What holds at both ends."""
        if self.of == "half":
            return half_band
        place, frame = BENT if self.of == "C" else TURNED
        return clamped((ORIGIN, place), (IDENTITY, frame), self.straight)

    def start(self, before: Callable[[Array], Array] | None = None) -> Joints:
        """Where Newton's method begins: a ribbon without width, or states along another."""
        law, ends = Wide(self.width), [0.0, *[i[0] for i in self.inflections], self.length]
        n, m0 = (np.array(v) for v in NARROW[self.of])
        straight = [s for s, held in zip((0.0, self.length), self.straight, strict=True) if held]
        near = narrow(law, n, m0, ORIGIN, IDENTITY, self.length, straight)
        return meshed(law, before or near, ends, (False, self.of == "half"))


def half_band(first: Array, last: Array) -> Array:
    """Conditions of half a Moebius band: flips about d1 at its start, about x at its end."""
    frame, there = (y[D].reshape(3, 3, -1) for y in (first, last))
    held = rotation(frame, np.broadcast_to(IDENTITY[:, :, None], frame.shape))
    start = [first[R], held, first[N][:1], first[M][:1], first[P : P + 1]]
    return np.concatenate([*start, last[1:3], there[0][:1], there[2][:1], last[ETA : ETA + 1]])


CLAMPS = {
    "C, edges straight": Known(
        "C",
        0.05,
        (True, True),
        (-3.77396573219, -4.90380817428, -2.16889754528),
        (3.22185793774, 1.74180998037, -0.11284574612),
        3.322380384314,
        -0.65118428222,
    ),
    "C, edges free": Known(
        "C",
        0.05,
        (False, False),
        (-3.77496069219, -4.90945478976, -2.17245061839),
        (3.22323466762, 1.74148263321, -0.11088145861),
        3.322358553050,
        -0.653861270175,
    ),
    "C, one straight": Known(
        "C",
        0.05,
        (True, False),
        (-3.77745989012, -4.92211035310, -2.17588361434),
        (3.22968039985, 1.74157461573, -0.11508816124),
        3.322366170387,
        -0.658520952036,
    ),
    "S, edges straight": Known(
        "S",
        0.1,
        (True, True),
        (25.0314210028, 14.6760005957, 40.343036322),
        (-18.9877762694, 1.2088281207, 8.6221913641),
        4.475217972872,
        49.934298486632,
        ((0.43215630941, 0.003653547824, 0.083307035243),),
    ),
    "S, edges free": Known(
        "S",
        0.1,
        (False, False),
        (16.8561367311, 11.5766492995, 21.9152971393),
        (-14.2114088199, 1.2441252480, 6.4590125801),
        3.976220803352,
        29.533790578955,
        ((0.43017908630, 0.003083800663, 0.041058325179),),
    ),
}


def _half(width: float, n: Sequence[float], m: Sequence[float], E: float, H: float) -> Known:
    return Known("half", width, (False, True), (0.0, *n), (0.0, *m), E / 2, H)


HALVES = {
    "0.01": _half(
        0.01,
        (43.5095034741, 42.5050020113),
        (1.937429962352, -9.014081731556),
        57.75377205483,
        58.0658649826,
    ),
    "0.1/pi": _half(
        0.1 / np.pi,
        (43.5003746252, 43.5345191595),
        (1.771950600742, -9.393441498676),
        58.47416895441,
        59.5834432608,
    ),
    "0.2/pi": _half(
        0.2 / np.pi,
        (43.3849767498, 45.1537441540),
        (1.477049826039, -10.122560228798),
        59.67720476657,
        62.2814509829,
    ),
    "0.1": _half(
        0.1,
        (43.0898457384, 47.2160231598),
        (1.030857460743, -11.266473268704),
        61.31032435335,
        66.2380316386,
    ),
    "0.3": _half(
        0.3,
        (38.3351103277, 66.7250849100),
        (-8.002389855877, -32.168304649522),
        80.07425413124,
        131.5652879012,
    ),
    "0.5": _half(
        0.5,
        (62.647927492, 158.905843148),
        (-240.20933784, -492.76056239),
        219.025681753,
        1527.912569427,
    ),
}
