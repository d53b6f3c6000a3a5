"""Guesses by all the loads at one end: the shape follows by integration."""

from __future__ import annotations

import math

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.catalogue import fields_of
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import BoundaryValueProblem, Posed, Ribbon
from ribbonopt.scene import LoadGuess
from ribbonopt.transcription.buffered import Accumulated, Mapped

POINTS = 33  # at which natural strains are looked at
CURVATURES = ("natural.curvature", "natural.twist", "natural.across")


@dataclass(frozen=True, eq=False)
class IntegratedLoads:
    """Shape that a force and a moment at the start give, by Runge-Kutta steps of order 4.

    `backwards` takes what is said of the start for the end, and fractions from there.
    """

    ribbon: Ribbon
    posed: Posed
    loads: LoadGuess
    backwards: bool = False

    @property
    def most_turning(self) -> float:
        """Bound of the angle (radians) by which the frames turn in all, for stiffness 1."""
        return self.posed.length * min(self._most_strain, _bounded_strain(self.posed, self.loads))

    @property
    def _most_strain(self) -> float:
        """Bound of the strains, for stiffness 1: the force may act on all of the length."""
        n, m = (max(map(abs, v)) for v in (self.loads.force, self.loads.moment))
        return m + self.posed.length * n + free_strain(self.posed)

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""
        x, c = self._integrated(fraction)
        section, start = self.ribbon.kept(_sections), self.posed.scene.interval[0]
        along = 1 - fraction if self.backwards else fraction
        s = start + self.posed.length * along
        parts = section(x, c, self.posed.values, s)[:6]
        r, d1, d2, d3, n, m = (part.reshape(-1, 3) for part in parts)
        return RodFields(r, np.stack([d1, d2, d3], axis=2), n, m)

    def unknowns_for(
        self, problem: BoundaryValueProblem, theta: Array, fraction: Array
    ) -> tuple[Array, Array] | None:
        """Unknowns v (k, nx) and constants where these are the states of the rod alone."""
        own = problem.state_names == self.ribbon.states and not problem.algebraic.numel()
        return self._integrated(fraction) if own else None

    def _integrated(self, fraction: Array) -> tuple[Array, Array]:
        """States of the rod (k, nx), and its constants, moments about the start."""
        model, (position, frame) = self.ribbon.model, self.posed.start
        n, m = np.array(self.loads.force), np.array(self.loads.moment)
        start = RodFields(position[None], frame[None], n[None], m[None])
        (state,), c = model.pack(start, position)
        length = self.posed.length
        widths = (fraction[1:] - fraction[:-1]) * (-length if self.backwards else length)
        # Steps short against the strains, which the loads bound.
        wanted = np.ceil(np.abs(widths).max() * self._most_strain)
        substeps = int(min(max(wanted, 1), 100))
        if substeps > 1:
            widths = np.repeat(widths / substeps, substeps)
        first = self.posed.scene.interval[0] + (length if self.backwards else 0.0)
        at = first + np.cumsum(widths) - widths
        states = np.zeros((len(widths) + 1, len(self.ribbon.states)))
        states[0, : len(state)] = state
        steps = self.ribbon.kept(_steps)
        states[1:] = steps(states[0], c, self.posed.values, widths, at)
        return states[::substeps], c


def _bounded_strain(posed: Posed, loads: LoadGuess) -> float:
    """Bound of the strains by H = W + n3, |u|^2 <= 2 W; infinite where H is not constant."""
    if posed.loaded or not all(field.uniform for field in fields_of(posed.scene)):
        return math.inf
    n, m = math.hypot(*loads.force), math.hypot(*loads.moment)
    return math.sqrt((m + free_strain(posed)) ** 2 + 4 * n)


def free_strain(posed: Posed) -> float:
    """Bound of the strains that a ribbon has without loads, by its natural ones."""
    if posed.scene.natural is None:
        return 0.0
    s = np.linspace(*posed.scene.interval, POINTS)
    fields = [f for f in fields_of(posed.scene) if f.name in CURVATURES]
    return 2 * sum(float(np.abs(f.sampled(s, posed.theta)).max()) for f in fields)


def _sections(ribbon: Ribbon) -> Mapped:
    """Cross sections at any number of states."""
    return Mapped(ribbon.section_function)


def _steps(ribbon: Ribbon) -> Accumulated:
    """States after each of many Runge-Kutta steps (x, c, theta, h, s) -> x."""
    x = ca.SX.sym("x", len(ribbon.states))
    c = ca.SX.sym("c", len(ribbon.constants))
    theta, s, h = ribbon.parameters, ribbon.position, ca.SX.sym("h")
    section = ribbon.section(x, c)
    rates = ca.Function("rates", [x, c, theta, s], [ribbon.rates(section, section.u)])
    k1 = rates(x, c, theta, s)
    k2 = rates(x + h / 2 * k1, c, theta, s + h / 2)
    k3 = rates(x + h / 2 * k2, c, theta, s + h / 2)
    k4 = rates(x + h * k3, c, theta, s + h)
    after = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return Accumulated(ca.Function("step", [x, c, theta, h, s], [after]), shared=2)


@dataclass(frozen=True, eq=False)
class FollowerLoads:
    """Shape of a ribbon clamped at the start whose end carries known loads along its directors.

    Integrated from the end, then moved as a rigid body: an equilibrium, whatever the loads.
    """

    ribbon: Ribbon
    posed: Posed
    force: Array
    moment: Array

    @property
    def most_turning(self) -> float:
        """Bound of the angle (radians) by which the frames turn in all, for stiffness 1."""
        force, moment = float(np.abs(self.force).max()), float(np.abs(self.moment).max())
        return self.posed.length * (moment + self.posed.length * force)

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""
        position, frame = self.posed.start
        x, y, z = frame @ self.force
        mx, my, mz = frame @ self.moment
        loads = LoadGuess((x, y, z), (mx, my, mz))
        whole = np.concatenate([[0.0], 1 - fraction[::-1], [1.0]])
        found = IntegratedLoads(self.ribbon, self.posed, loads, backwards=True).fields(whole)
        turn = frame @ found.frames[-1].T
        inner = slice(-2, 0, -1)
        return RodFields(
            position + (found.r[inner] - found.r[-1]) @ turn.T,
            turn @ found.frames[inner],
            found.n[inner] @ turn.T,
            found.m[inner] @ turn.T,
        )
