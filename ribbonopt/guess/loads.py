"""Guesses by all the loads at one end: the shape follows by integration."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics import RodFields
from ribbonopt.mechanics.ends.boundary import start_frame, start_position
from ribbonopt.problem import BoundaryValueProblem, Ribbon, theta_values
from ribbonopt.scene import LoadGuess, Scene
from ribbonopt.transcription.buffered import Buffered, Mapped

STEPS = 32  # of one call


@dataclass(frozen=True, eq=False)
class IntegratedLoads:
    """Shape that a force and a moment at the start give, by Runge-Kutta steps of order 4.

    `backwards` takes what is said of the start for the end, and fractions from there.
    """

    ribbon: Ribbon
    scene: Scene
    loads: LoadGuess
    backwards: bool = False

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""
        x, c = self._integrated(fraction)
        parts = _sections(self.ribbon)(x, c, theta_values(self.scene))[:6]
        r, d1, d2, d3, n, m = (part.reshape(-1, 3) for part in parts)
        return RodFields(r, np.stack([d1, d2, d3], axis=2), n, m)

    def unknowns_for(
        self, problem: BoundaryValueProblem, theta: Array, fraction: Array
    ) -> tuple[Array, Array] | None:
        """Unknowns v (k, nx) and constants where these are the states of the rod alone."""
        own = problem.state_names == self.ribbon.model.states and not problem.algebraic.numel()
        return self._integrated(fraction) if own else None

    def _integrated(self, fraction: Array) -> tuple[Array, Array]:
        """States of the rod (k, nx), and its constants, moments about the start."""
        model, boundary, parameters = self.ribbon.model, self.scene.boundary, self.scene.parameters
        position = start_position(boundary, parameters)
        frame = start_frame(boundary, parameters)
        n, m = np.array(self.loads.force), np.array(self.loads.moment)
        start = RodFields(position[None], frame[None], n[None], m[None])
        states, c = model.pack(start, position)
        length = self.scene.interval[1] - self.scene.interval[0]
        widths = np.diff(fraction) * (-length if self.backwards else length)
        # Steps short against the strains, which the loads bound.
        strain = np.abs(m).max() + length * np.abs(n).max()
        substeps = int(np.clip(np.ceil(np.abs(widths).max() * strain), 1, 100))
        theta = theta_values(self.scene)
        widths = np.repeat(widths / substeps, substeps)
        steps, shared = _steps(self.ribbon), (np.tile(c, STEPS), np.tile(theta, STEPS))
        count = len(widths)
        widths = np.append(widths, np.zeros(-count % STEPS))  # steps of no width go nowhere
        parts = [states]
        for part in widths.reshape(-1, STEPS):
            (after,) = steps(parts[-1][-1], *shared, part)
            parts.append(after.reshape(STEPS, -1))
        return np.vstack(parts)[: count + 1 : substeps], c


@lru_cache(maxsize=8)
def _sections(ribbon: Ribbon) -> Mapped:
    """Cross-sections at any number of states."""
    return Mapped(ribbon.section_function)


@lru_cache(maxsize=8)
def _steps(ribbon: Ribbon) -> Buffered:
    """States after each of `STEPS` steps, from the first state and all c, theta and h."""
    return Buffered(_step(ribbon).mapaccum("steps", STEPS))


@lru_cache(maxsize=8)
def _step(ribbon: Ribbon) -> ca.Function:
    """One Runge-Kutta step (x, c, theta, h) -> x."""
    model = ribbon.model
    x = ca.SX.sym("x", len(model.states))
    c = ca.SX.sym("c", len(model.constants))
    theta = ca.vertcat(*ribbon.theta.values())
    section = ribbon.section(x, c)
    u = ca.vertcat(0, section.u2, section.u3)
    rates = ca.Function("rates", [x, c, theta], [model.rates(x, section.rod, u)])
    h = ca.SX.sym("h")
    k1 = rates(x, c, theta)
    k2 = rates(x + h / 2 * k1, c, theta)
    k3 = rates(x + h / 2 * k2, c, theta)
    k4 = rates(x + h * k3, c, theta)
    after = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return ca.Function("step", [x, c, theta, h], [after])


@dataclass(frozen=True, eq=False)
class FollowerLoads:
    """Shape of a ribbon clamped at the start whose end carries known loads along its directors.

    Integrated from the end, then moved as a rigid body: an equilibrium, whatever the loads.
    """

    ribbon: Ribbon
    scene: Scene
    force: Array
    moment: Array

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""
        boundary, parameters = self.scene.boundary, self.scene.parameters
        frame = start_frame(boundary, parameters)
        x, y, z = frame @ self.force
        mx, my, mz = frame @ self.moment
        loads = LoadGuess((x, y, z), (mx, my, mz))
        whole = np.concatenate([[0.0], 1 - fraction[::-1], [1.0]])
        found = IntegratedLoads(self.ribbon, self.scene, loads, backwards=True).fields(whole)
        turn = frame @ found.frames[-1].T
        inner = slice(-2, 0, -1)
        return RodFields(
            start_position(boundary, parameters) + (found.r[inner] - found.r[-1]) @ turn.T,
            turn @ found.frames[inner],
            found.n[inner] @ turn.T,
            found.m[inner] @ turn.T,
        )
