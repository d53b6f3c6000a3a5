"""Dense output of shooting: the same steps once more, from a node to the wanted point.

Every point has the order of the nodes. Algebraic variables follow from their equations at the
states.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.known import Known, at_places, sampled
from ribbonopt.transcription.tableaus import gauss

from .blocks import ShootingBlocks


@dataclass(frozen=True, eq=False)
class ShootingOutput:
    """Numbers of one solution; positions are relative to their phase.

    Attributes
    ----------
    blocks : ShootingBlocks
        The discretised equations.
    w, p : arrays
        Unknowns, and parameters.
    known : Known or None
        The known fields that p was sampled from, if the problem has any.
    """

    blocks: ShootingBlocks
    w: Array
    p: Array
    known: Known | None = None

    @property
    def order(self) -> int:
        """Order of the error of `states` between the nodes."""
        return self.blocks.order

    @property
    def theta(self) -> Array:
        """Parameters of the problem."""
        return self.blocks.layout.theta(self.p)

    @property
    def constants(self) -> Array:
        """Unknown constants c."""
        return self.blocks.layout.unpack(self.w)[2]

    @property
    def at_nodes(self) -> Array:
        """States (N + 1, nx) at the nodes of all phases."""
        return self.blocks.layout.unpack(self.w)[0]

    def moved(self, step: Array) -> ShootingOutput:
        """Return the output of the unknowns w + step."""
        return replace(self, w=self.w + step)

    def refined(self) -> tuple[ShootingOutput, int]:
        """Return this output on the next better scheme, and the parts of each element."""
        blocks, split = self.blocks.finer
        widths = np.repeat(self.blocks.widths(self.p) / split, split)
        p = blocks.layout.parameters(self.theta, widths, self.known)
        return ShootingOutput(blocks, blocks.sampled(self, p), p, self.known), split

    def approximate(self, phase: int, sigma: Array) -> Array:
        """Unknowns v (k, nv) at relative positions sigma (k,)."""
        return np.hstack([self.states(phase, sigma), self.algebraic(phase, sigma)])

    def nodes(self, phase: int) -> Array:
        """Relative positions (n + 1,) of the nodes of a phase."""
        return self.blocks.layout.phase_nodes(self.p, phase)

    def states(self, phase: int, sigma: Array) -> Array:
        """States x (k, nx) at the relative positions sigma (k,)."""
        element, t, h = self.blocks.layout.locate(self.p, phase, sigma)
        nodes, _, _ = self.blocks.layout.unpack(self.w)
        # Nodes are known already.
        x = np.where((t == 1)[:, None], nodes[element + 1], nodes[element])
        inside = (t > 0) & (t < 1)
        if inside.any():
            e = element[inside]
            start = self.blocks.layout.starts(self.p)[e]
            x[inside] = self._after(phase, nodes[e], start, (t * h)[inside])
        return x

    def many(self, phase: int, sigma: Array) -> Array:
        """States x (k, nx) at the relative positions sigma (k,): the same."""
        return self.states(phase, sigma)

    def algebraic(self, phase: int, sigma: Array) -> Array:
        """Algebraic variables z (k, nz): from their equations at the states."""
        return self._algebraic(phase, self.states(phase, sigma), sigma)

    def stages(self, phase: int) -> tuple[Array, Array, Array]:
        """Values v (k, nv), relative positions (k,) and weights (k,) of a Gauss quadrature.

        As many points in every step as give the order of the method.
        """
        rule = gauss((self.order + 1) // 2)
        nodes, steps = self.nodes(phase), self.blocks.flows[phase].steps
        widths = np.repeat(np.diff(nodes) / steps, steps)
        starts = np.repeat(nodes[:-1], steps) + np.tile(np.arange(steps), len(nodes) - 1) * widths
        sigma = (starts[:, None] + widths[:, None] * rule.nodes).ravel()
        x = self.states(phase, sigma)
        v = np.hstack([x, self._algebraic(phase, x, sigma)])
        return v, sigma, (widths[:, None] * rule.weights).ravel()

    @property
    def growth(self) -> Array:
        """Exponents (N,) of elements, zero: steps between nodes are those that led to the next."""
        return np.zeros(self.blocks.layout.element_count)

    def decay(self) -> Array:
        """No coefficients (N, 0)."""
        return np.empty((self.blocks.layout.element_count, 0))

    def residual_between_nodes(self) -> Array:
        """Defects (N, 1) of the differential equations over every element.

        The steps of an element against as many steps over each of its halves: the largest entry of
        the difference per relative width, over the largest entry of |F| at the nodes.
        """
        lay = self.blocks.layout
        nodes, _, _ = lay.unpack(self.w)
        starts, widths = lay.starts(self.p), lay.widths(self.p)
        error, rates = np.empty(lay.element_count), 0.0
        for phase, s in enumerate(lay.phase_slices):
            half = widths[s] / 2
            whole = self._after(phase, nodes[s], starts[s], widths[s])
            middle = self._after(phase, nodes[s], starts[s], half)
            halves = self._after(phase, middle, starts[s] + half, half)
            error[s] = np.abs(whole - halves).max(axis=1) / widths[s]
            rates = max(rates, self._largest_rate(phase, nodes[s], starts[s]))
        return error[:, None] / rates

    def _after(self, phase: int, x: Array, sigma: Array, h: Array) -> Array:
        """States (k, nx) after the steps of an element of widths h (k,) from x at sigma."""
        lay, step, place = self.blocks.layout, self.blocks.flows[phase].step.mapped_values, sigma
        if lay.known:
            everywhere = (sigma[:, None] + h[:, None] * np.array(lay.places)).ravel()
            known = sampled(self.known, phase, everywhere, lay.known)
            place = np.column_stack([sigma, known.reshape(len(x), -1)])
        after: Array = step(x, self.constants, self.theta, place, h)[0].reshape(x.shape)
        return after

    def _algebraic(self, phase: int, x: Array, sigma: Array) -> Array:
        nz = self.blocks.layout.nz
        if not nz or not len(x):
            return np.empty((len(x), nz))
        solve, places = self.blocks.flows[phase].mapped_algebraic, self._places(phase, sigma)
        z: Array = solve(x, self.constants, self.theta, places)[0].reshape(-1, nz)
        return z

    def _places(self, phase: int, sigma: Array) -> Array:
        """Positions sigma (k,) with the known fields there, as stage functions take them."""
        return at_places(self.known, phase, sigma, self.blocks.layout.known)

    def _largest_rate(self, phase: int, x: Array, sigma: Array) -> float:
        v = np.hstack([x, self._algebraic(phase, x, sigma)])
        values, places = self.blocks.flows[phase].stage.mapped_values, self._places(phase, sigma)
        equations = values(v, self.constants, self.theta, places)[0].reshape(len(v), -1)
        return float(np.abs(equations[:, : x.shape[1]]).max())
