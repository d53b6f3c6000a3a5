"""Guesses: force, moment and shape along the ribbon before anything is solved.

A guess gives `RodFields` at fractions of the length; `initial_unknowns` turns them into the
unknowns of a discretised problem. A `Solution` is itself a guess.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics import RodFields
from ribbonopt.mechanics.boundary import start_frame, start_position
from ribbonopt.problem import Ribbon, theta_of
from ribbonopt.scene import LoadGuess, Scene
from ribbonopt.transcription import Collocation, Layout, Mesh


class Guess(Protocol):
    """Anything that can say what the ribbon looks like."""

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""


@dataclass(frozen=True, eq=False)
class IntegratedLoads:
    """Shape that a force and a moment at the start give, by Runge-Kutta steps of order 4."""

    ribbon: Ribbon
    scene: Scene
    loads: LoadGuess

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""
        model, boundary, parameters = self.ribbon.model, self.scene.boundary, self.scene.parameters
        position = start_position(boundary, parameters)
        frame = start_frame(boundary, parameters)
        n, m = np.array(self.loads.force), np.array(self.loads.moment)
        start = RodFields(position[None], frame[None], n[None], m[None])
        states, c = model.pack(start, position)
        length = self.scene.interval[1] - self.scene.interval[0]
        widths = np.diff(fraction) * length
        # Steps short against the strains, which the loads bound.
        strain = np.abs(m).max() + length * np.abs(n).max()
        substeps = int(np.clip(np.ceil(widths.max() * strain), 1, 100))
        theta = np.array(list(theta_of(self.scene).values()))
        widths = np.repeat(widths / substeps, substeps)
        step, section = self._functions()
        count = len(widths)
        c, theta = (np.repeat(v[:, None], count + 1, axis=1) for v in (c, theta))
        after = step.mapaccum("steps", count)(states[0], c[:, 1:], theta[:, 1:], widths[None])
        x = np.hstack([states.T, np.array(after)])[:, ::substeps]
        count = len(fraction)
        parts = section.map(count)(x, c[:, :count], theta[:, :count])
        r, d1, d2, d3, n, m = (np.array(part).T for part in parts[:6])
        return RodFields(r, np.stack([d1, d2, d3], axis=2), n, m)

    def _functions(self) -> tuple[ca.Function, ca.Function]:
        """One step (x, c, theta, h) -> x, and the cross section (x, c, theta) -> r, d_i, n, m."""
        model = self.ribbon.model
        x = ca.SX.sym("x", len(model.states))
        c = ca.SX.sym("c", len(model.constants))
        theta = ca.vertcat(*self.ribbon.theta.values())
        section = self.ribbon.section(x, c)
        u = ca.vertcat(0, section.u2, section.u3)
        rates = ca.Function("rates", [x, c, theta], [model.rates(x, section.rod, u)])
        h = ca.SX.sym("h")
        k1 = rates(x, c, theta)
        k2 = rates(x + h / 2 * k1, c, theta)
        k3 = rates(x + h / 2 * k2, c, theta)
        k4 = rates(x + h * k3, c, theta)
        after = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        return ca.Function("step", [x, c, theta, h], [after]), self.ribbon.section_function


def initial_unknowns(
    guess: Guess,
    ribbon: Ribbon,
    collocation: Collocation,
    layout: Layout,
    mesh: Mesh,
    reference: Array,
) -> Array:
    """Unknowns w (nw,) of the discretised problem that stand for a guess.

    `reference` (3,) is the point on which the constant moment acts. One phase; algebraic variables
    start at zero.
    """
    nodes, stages = collocation.positions(mesh.widths)
    fractions = np.append(np.hstack([nodes[:-1, None], stages]).ravel(), 1.0)
    # A Radau scheme has its last stage on the next node: one value serves both.
    unique, where = np.unique(fractions, return_inverse=True)
    x, constants = ribbon.model.pack(guess.fields(unique), reference)
    x = x[where]
    body = x[:-1].reshape(layout.element_count, layout.stages + 1, -1)
    z = np.zeros((layout.element_count, layout.stages, layout.nz))
    states = np.concatenate([body[:, 1:], z], axis=2)
    return layout.pack(np.vstack([body[:, 0], x[-1:]]), states, constants)
