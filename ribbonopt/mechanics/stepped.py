"""The balance of a ribbon with stations: n and m of any other balance, less what acts before s.

With P(s) and C(s) the forces and couples of all stations up to s, n = n' - P and m = m' - C + b,
where n', m' are those of the balance inside and b' = -P x r', b = 0 at the start.

What is before s follows from s, or in the phases between stations from which of them it is: there
`passed` holds a number for each station, 1 behind it and 0 before.
"""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .balance import Balance
from .loads.load import Theta
from .rotations import cross_matrix
from .section import RodFields, Section
from .stations import AXES, Station


@dataclass(frozen=True, eq=False)
class Stepped(Balance):
    """Another balance, with steps of force and moment at stations."""

    inner: Balance
    stations: tuple[Station, ...]
    theta: Theta
    passed: ca.SX | None = None

    @property
    def states(self) -> tuple[str, ...]:  # type: ignore[override]
        return (*self.inner.states, "bx", "by", "bz")

    @property
    def constants(self) -> tuple[str, ...]:  # type: ignore[override]
        return (*self.inner.constants, *self.unknown)

    @property
    def unknown(self) -> tuple[str, ...]:
        """Names of the unknown constants of the stations."""
        return tuple(name for station in self.stations for name in station.unknown)

    def with_passed(self, passed: ca.SX) -> Balance:
        return replace(self, passed=passed)

    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        own, rest = self._split(x)
        count = len(self.inner.constants)
        n, m = self.inner.force_and_moment(r, own, c[:count], s, reference)
        force, couple = self._steps(s, c[count:])
        return n - force, m - couple + rest

    def stepped(self, c: ca.SX, s: ca.SX) -> ca.SX:
        return self._steps(s, c[len(self.inner.constants) :])[0]

    def rates(self, section: Section, x: ca.SX) -> ca.SX:
        assert section.stepped is not None  # as `stepped` says
        inside, (own, _) = replace(section, n=section.n + section.stepped), self._split(x)
        return ca.vertcat(
            self.inner.rates(inside, own), -ca.cross(section.stepped, section.tangent)
        )

    def beyond(self, s: ca.SX) -> ca.SX:
        found = ca.SX.zeros(3)
        for station, passed in zip(self.stations, self._passed(s), strict=True):
            # A reaction does no work: its place is a condition of the least energy.
            found += (1 - passed) * station.force(self.theta, lambda name: ca.SX(0))
        return found

    def start_conditions(self, x: ca.SX) -> dict[str, ca.SX]:
        own, rest = self._split(x)
        named = {f"moment of the point loads along {a}": rest[i] for i, a in enumerate(AXES)}
        return self.inner.start_conditions(own) | named

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        states, constants = self.inner.pack(fields, reference)
        rest = np.zeros((len(fields.r), 3))
        if len(constants):  # what of m the states inside do not carry
            n, m = constants[:3], constants[3:6]
            rest = fields.m - m - np.cross(n, fields.r - reference)
            rest[:, [f"a{axis}" in self.inner.states for axis in AXES]] = 0.0
        return np.hstack([states, rest]), np.append(constants, np.zeros(len(self.unknown)))

    def moved(self, x: Array, c: Array) -> tuple[Array, Array]:
        count, own = len(self.inner.constants), len(self.inner.states)
        states, constants = self.inner.moved(x[:own], c[:count])
        rest = np.hstack([np.zeros((3, 3)), -cross_matrix(x[own:])])
        return np.vstack([states, rest]), np.vstack([constants, self._turned(c[count:])])

    def _turned(self, c: Array) -> Array:
        """Return the changes (nc, 6) of the unknown constants by unit translations and turns."""
        result = np.zeros((len(c), 6))
        whose = {name: i for i, name in enumerate(self.unknown)}
        for name, row in whose.items():
            kind, axis, owner = name[0], name[1], name[2:]
            others = [whose.get(f"{kind}{a}{owner}") for a in AXES]
            vector = np.array([0.0 if i is None else c[i] for i in others])
            result[row, 3:] = -cross_matrix(vector)[AXES.index(axis)]
        return result

    def _split(self, x: ca.SX) -> tuple[ca.SX, ca.SX]:
        count = len(self.inner.states)
        return x[:count], x[count:]

    def _passed(self, s: ca.SX) -> list[ca.SX]:
        """Whether each station is before s: 1, or 0."""
        if self.passed is not None:
            return list(ca.vertsplit(self.passed))
        return [s >= station.place(self.theta) for station in self.stations]

    def _steps(self, s: ca.SX, unknown: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Force and couple (3,) of all stations up to s."""
        symbols = dict(zip(self.unknown, ca.vertsplit(unknown), strict=True))
        force = couple = ca.SX.zeros(3)
        for station, passed in zip(self.stations, self._passed(s), strict=True):
            force += passed * station.force(self.theta, symbols.__getitem__)
            couple += passed * station.couple(self.theta, symbols.__getitem__)
        return force, couple
