"""Guesses: force, moment and shape along the ribbon before anything is solved.

A guess gives `RodFields` at fractions of the length; `initial_unknowns` turns them into the
unknowns of a discretised problem. A `Solution` is itself a guess.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics import RodFields
from ribbonopt.mechanics.boundary import start_frame, start_position
from ribbonopt.problem import BoundaryValueProblem, Ribbon, theta_of
from ribbonopt.scene import LoadGuess, Scene

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Blocks


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


@dataclass(frozen=True, eq=False)
class ConstantStrains:
    """Arc or helix of constant strains from the start, without force: nothing to be known of loads.

    The moment is that of the law for these strains; it need not be in equilibrium.
    """

    ribbon: Ribbon
    scene: Scene
    strains: tuple[float, float]

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length."""
        boundary, parameters = self.scene.boundary, self.scene.parameters
        length = self.scene.interval[1] - self.scene.interval[0]
        u = np.array([0.0, *self.strains])
        size = float(np.linalg.norm(u))
        axis = u / size if size > 0 else np.array([0.0, 0.0, 1.0])
        s = fraction * length
        # Rodrigues' formula for a turn by size * s about the Darboux vector, and its integral.
        K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        angle = (size * s)[:, None, None]
        turns = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * (K @ K)
        scale = size if size > 0 else 1.0
        along = s[:, None, None] * np.eye(3) + ((1 - np.cos(angle)) * K) / scale
        along = along + ((angle - np.sin(angle)) / scale) * (K @ K)
        frame = start_frame(boundary, parameters)
        r = start_position(boundary, parameters) + along[:, :, 2] @ frame.T
        frames = frame @ turns
        m2, m3 = self._moments()
        m = m2 * frames[:, :, 1] + m3 * frames[:, :, 2]
        return RodFields(r, frames, np.zeros_like(r), m)

    def _moments(self) -> tuple[float, float]:
        u = ca.SX.sym("u", 2)
        theta = ca.vertcat(*self.ribbon.theta.values())
        moments = ca.vertcat(*self.ribbon.law.moment(u[0], u[1]))
        values = list(theta_of(self.scene).values())
        m2, m3 = np.array(ca.Function("m", [u, theta], [moments])(self.strains, values)).ravel()
        return float(m2), float(m3)


def initial_unknowns(
    guess: Guess, ribbon: Ribbon, problem: BoundaryValueProblem, blocks: Blocks, p: Array
) -> Array:
    """Unknowns w (nw,) of the discretised problem (one phase) that stand for a guess.

    `p` holds theta and the relative widths of the elements.
    """
    layout, widths = blocks.layout, blocks.widths(p)
    theta = p[: len(p) - layout.element_count]
    nodes = np.concatenate([[0.0], np.cumsum(widths)])
    nodes[-1] = 1.0
    positions = np.hstack([nodes[:-1, None], blocks.stage_positions(p)])
    fractions = np.append(positions.ravel(), 1.0)
    # A Radau scheme has its last stage on the next node: one value serves both.
    unique, where = np.unique(fractions, return_inverse=True)
    fields = guess.fields(unique)
    reference = theta[[problem.parameter_names.index(f"reference.{axis}") for axis in "xyz"]]
    x, constants = ribbon.model.pack(fields, reference)
    more = _estimates(problem, fields, theta)
    count = layout.nx - x.shape[1]
    x, z = np.hstack([x, more[:, :count]])[where], more[:, count:][where]
    body = np.hstack([x, z])[:-1].reshape(layout.element_count, layout.stages + 1, -1)
    ends = np.vstack([body[:, 0, : layout.nx], x[-1:]])
    return layout.pack(ends, body[:, 1:], constants[: layout.nc])


def _estimates(problem: BoundaryValueProblem, fields: RodFields, theta: Array) -> Array:
    """Last states and algebraic variables (k, ...) from the moments along d2 and d3."""
    count = len(fields.r)
    if not problem.estimate.numel():
        return np.empty((count, 0))
    local = np.einsum("ki,kij->kj", fields.m, fields.frames)[:, 1:]
    function = ca.Function("estimate", [problem.local, problem.parameters], [problem.estimate])
    values = function.map(count)(local.T, np.repeat(theta[:, None], count, axis=1))
    return np.asarray(np.array(values).T)
