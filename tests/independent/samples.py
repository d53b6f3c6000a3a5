"""States of a solution of the package, and what its scene prescribes at its ends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .described import edge_of, prescribed
from .loaded import ROWS, Strip
from .rod import Array
from .wide import ETA, P, Wide
from .wide import ROWS as WIDE_ROWS

BESIDE = 1e-13  # of the length, in front of a station or behind it
Found = list[tuple[float, str]]


@dataclass(frozen=True)
class Samples:
    """States of a solution, units Dw = L = 1; `width` of a ribbon that has one."""

    solution: Any
    a: float
    b: float
    width: float | None = None

    def __call__(self, s: float, side: int = 1) -> Array:
        """State (20, 1) or (22, 1) at an arclength; side -1: in front of what acts there.

        Else behind it, by as little: the phases of a solution meet there but for rounding.
        """
        x = (s - self.a) / (self.b - self.a)
        return self.states(np.clip([x + side * BESIDE], 0, 1))

    def along(self, s: Array) -> Array:
        """States (20, k) or (22, k) at arclengths (k,)."""
        return self.states(np.clip((np.asarray(s) - self.a) / (self.b - self.a), 0, 1))

    def states(self, fraction: Array) -> Array:
        """States (20, k) or (22, k) at fractions of the length (k,)."""
        at: Mapping[str, Array] = self.solution.trajectory.outputs(fraction)
        y = np.zeros((ROWS if self.width is None else WIDE_ROWS, len(fraction)))
        for i, name in enumerate(("r", "d1", "d2", "d3", "n", "m")):
            y[3 * i : 3 * i + 3] = at[name].T
        if self.width is not None:
            y[ETA], y[P] = at["own.eta"], at["own.p"]
        return y

    @property
    def compared(self) -> list[int]:
        """Rows of states that are integrated and compared."""
        return [*range(18), *([] if self.width is None else [ETA, P])]

    @property
    def sizes(self) -> tuple[float, float, float]:
        """Units of forces, moments and p: one and the largest of them; p is as w m^2 at most."""
        y = self.states(np.linspace(0, 1, 65))
        moment = 1 + float(np.abs(y[15:18]).max())
        p = (self.width or 0.0) * moment
        if self.width is not None:
            p = min(p, float(np.abs(y[P]).max()) + 1e-2 * p)
        return 1 + float(np.abs(y[12:15]).max()), moment, p


def looped(loop: Any, strip: Wide, sides: tuple[Array, Array], unit: float) -> tuple[float, str]:
    """Gap of eta and p where a loop goes on: at flips one of both is zero, else they are the same.

    Of opposite sign with every half twist, which turns the normal around.
    """
    own = np.array([[y[ETA, 0], y[P, 0] / unit] for y in sides])
    if loop.piece == "whole":
        return float(np.abs(own[1] - (-1) ** loop.half_twists * own[0]).max()), "eta, p of the loop"
    return float(np.abs(own).min(axis=1).max()), "edges of the piece"


def closed(loop: Any, sides: tuple[Array, Array]) -> Found:
    """Gaps of a whole loop: d1 and d2 change their sign with every half twist.

    Loads may be carried where it is held, so that n and m are not asked for; without them they go
    on of themselves.
    """
    if loop.piece != "whole":
        return []
    start, end = (y[:12, 0].copy() for y in sides)
    end[3:9] *= (-1) ** loop.half_twists
    gaps = np.abs(end - start)
    places = float(gaps[:3].max()), "places where the loop closes"
    return [places, (float(gaps[3:].max()), "directors where the loop closes")]


def boundary(scene: Any, given: Samples, strip: Strip | Wide, sides: tuple[Array, Array]) -> Found:
    """Gaps of what the scene prescribes at both ends."""
    force, moment, p = given.sizes
    loop = getattr(scene.boundary, "loop", None)
    found: Found = [] if loop is None else closed(loop, sides)
    if isinstance(strip, Wide) and loop is not None:
        return [*found, looped(loop, strip, sides, p)]
    ends = {"start": scene.boundary.start, "end": scene.boundary.end}
    for (name, end), y in zip(ends.items(), sides, strict=True):
        if end is None:
            continue
        asked = prescribed(end, scene.parameters)
        if name == "end":
            y = strip.jump(y, given.b)
        sign = 1 if name == "end" else -1
        frame = y[3:12].reshape(3, 3)
        gaps = {
            "position": y[:3, 0] - asked["r"],
            "directors": frame - asked["directors"],
            "force": (y[12:15, 0] - sign * asked["n"]) / force,
            "moment": (y[15:18, 0] - sign * asked["m"]) / moment,
            "force along directors": (frame @ y[12:15, 0] - sign * asked["own n"]) / force,
            "moment along directors": (frame @ y[15:18, 0] - sign * asked["own m"]) / moment,
        }
        if isinstance(strip, Wide):
            edges = {"straight": y[ETA], "free": y[P] / p}
            said = edge_of(end)
            gaps[f"{said or 'some'} edge"] = edges.get(said, min(edges.values(), key=np.abs))
        found += [
            (float(np.nan_to_num(np.abs(g)).max()), f"{k} at {name}") for k, g in gaps.items()
        ]
    return found
