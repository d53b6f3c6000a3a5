"""From the mode of a rod to that of a ribbon: the law changed bit by bit, then the mesh refined.

The strains (1 - t) u_rod + t u_law are homogeneous of degree one for every t. Where the law jumps
or has a kink at m2 = 0 a smooth law stands for it first; then the ribbon falls into phases that
meet where m2 of the mode changes sign, each on one side of the law, which is analytic there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.guess.unknowns import laid_out, places_of
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.solvers import NewtonSolver
from ribbonopt.solvers.condense import factored
from ribbonopt.transcription import CollocationMethod, Mesh

from .infinitesimal import Deflected
from .mode import Mode
from .rod import RodBuckling
from .square import Pieces, packed, square

DEGREE, INTERVALS = 8, 12
LEAST_STEP = 1 / 64  # of t
WANTED = 1e-12  # error of the load, relative to the range that is searched
RESIDUALS = (1e-5, 1e-7, 1e-9, 1e-11)  # of the equations between the stages, relative
ROUNDS, MOST = 30, 640  # of refinement; elements

Read = Callable[[Array], Array]  # fractions (k,) of the length to states (k, 2 nx)


@dataclass(frozen=True, eq=False)
class Search:
    """From the modes of one rod to those of the ribbon.

    `smooth` is the ribbon's law, or what stands for one with a kink.
    """

    rod: RodBuckling
    smooth: ConstitutiveLaw

    @property
    def deflected(self) -> Deflected:
        """The ribbon."""
        return self.rod.deflected

    @cached_property
    def _smooth(self) -> BoundaryValueProblem:
        """The problem in one phase: the rod's law for t = 0, the ribbon's or a smooth one for 1."""
        t = ca.SX.sym("t")

        def strain(stress: Stress) -> ca.SX:
            return (1 - t) * self.rod.strain(stress) + t * self.smooth.strain(stress)

        return square(self.deflected, t, strain, self.smooth)

    @property
    def _named(self) -> int:
        """How many parameters come before the further numbers of a law."""
        nx, nc, nt = self.deflected.sizes
        return 2 * (nx + nc + nt) + 2 * nx + nc

    def mode(self, load: float, start: Array) -> Mode | None:
        """Return the mode that a mode of the rod leads to, None if that is lost on the way."""
        law = self.deflected.ribbon.law
        found = self._from_rod(load, start)
        if found is None or not law.kinked:
            return None if found is None else self.refined(found, self._smooth)
        pieces, places = found.signs
        problem = square(self.deflected, ca.SX(0, 1), law.strain, law, pieces)
        found = self._in_phases(found, problem, pieces, places)
        return None if found is None else self.refined(found, problem)

    def at(self, load: float) -> Array:
        """Start, constants and parameters of the straight state, as they are taken at a load."""
        found: Array = self.rod.a + load * (self.rod.b - self.rod.a)
        return found

    def moved(self, mode: Mode, straight: Array) -> Mode | None:
        """Solve again from a mode of a search over other loads, and its straight state.

        `straight` (nx + nc + nt,) are its start, constants and parameters.
        """
        trajectory, output = mode.trajectory, mode.trajectory.dense
        _, nc, _ = self.deflected.sizes
        a, b = self.rod.a, self.rod.b
        constants = output.constants.copy()
        constants[nc] = (straight - a) @ (b - a) / ((b - a) @ (b - a))
        parts = trajectory.approximate, trajectory.ends, constants
        numbers, mesh = output.theta[self._named :], self._mesh(mode)
        found = self._solved(trajectory.problem, mesh, *parts, numbers, mode.pieces)
        return None if found is None else replace(found, error=self._error(found))

    def _mesh(self, mode: Mode) -> Mesh:
        output = mode.trajectory.dense
        widths = output.blocks.widths(output.p)
        return Mesh(tuple(widths[s] for s in output.blocks.layout.phase_slices))

    def _from_rod(self, load: float, start: Array) -> Mode | None:
        """Bring the law on, from that of the rod."""
        grid, along = self.rod.along(load, start)

        def read(fractions: Array) -> Array:
            return np.stack([np.interp(fractions, grid, column) for column in along.T], axis=1)

        nx, _, _ = self.deflected.sizes
        problem, constants = self._smooth, np.append(start[nx:], load)
        ends = self.rod.ends(load)
        mesh = _shared(ends)
        mode = self._solved(problem, mesh, read, ends, constants, np.zeros(1))
        share, step = 0.0, 0.5
        while mode is not None and share < 1:
            following = min(1.0, share + step)
            found = self._again(mode, problem, mesh, np.array([following]))
            if found is None:
                step /= 4
                if step < LEAST_STEP:
                    return None
                continue
            mode, share, step = found, following, 2 * step
        return mode

    def _in_phases(
        self, mode: Mode, problem: BoundaryValueProblem, pieces: Pieces, places: Array
    ) -> Mode | None:
        ends = np.concatenate([[0.0], places, [1.0]])
        trajectory, dense = mode.trajectory, mode.trajectory.dense
        lengths = trajectory.length * np.diff(ends)[:-1]
        constants, read = np.append(dense.constants, lengths), trajectory.approximate
        found = self._solved(problem, _shared(ends), read, ends, constants, np.empty(0), pieces)
        return found if found is not None and found.admissible else None

    def _again(
        self, mode: Mode, problem: BoundaryValueProblem, mesh: Mesh, numbers: Array
    ) -> Mode | None:
        """Solve from a mode of the same problem, or of the same phases."""
        trajectory = mode.trajectory
        parts = trajectory.approximate, trajectory.ends, trajectory.dense.constants
        return self._solved(problem, mesh, *parts, numbers, mode.pieces)

    def _solved(
        self,
        problem: BoundaryValueProblem,
        mesh: Mesh,
        read: Read,
        ends: Array,
        constants: Array,
        numbers: Array,
        pieces: Pieces | None = None,
    ) -> Mode | None:
        """Solve from states that can be read anywhere, and constants."""
        nlp = CollocationMethod.named("gauss", DEGREE).transcribe(problem, mesh.elements)
        nx, nc, _ = self.deflected.sizes
        both = read(np.array([0.0, 1.0]))[:, nx:].ravel()
        row = np.concatenate([both, constants[:nc]])
        theta = packed(self.rod.a, self.rod.b, row / (row @ row), numbers)
        p = nlp.layout.parameters(theta, mesh.widths)
        w = laid_out(nlp.blocks, read(places_of(nlp.blocks, p, ends)), constants)
        report = NewtonSolver(nlp).solve(w, p)
        if not report.status.converged:
            return None
        output = nlp.output(report.w, p)
        return Mode(float(output.constants[nc]), np.inf, Trajectory(problem, output), pieces)

    def refined(self, mode: Mode, problem: BoundaryValueProblem) -> Mode:
        """Refine the mesh until the load is as exact as is wanted, or no mesh does better."""
        mode = replace(mode, error=self._error(mode))
        for allowed in RESIDUALS:
            if mode.error <= WANTED:
                break
            mode = self._halved(mode, problem, allowed)
        return mode

    def _halved(self, mode: Mode, problem: BoundaryValueProblem, allowed: float) -> Mode:
        """Halve elements whose equations do not hold between the stages, until they do."""
        for _ in range(ROUNDS):
            output = mode.trajectory.dense
            off = output.residual_between_nodes().max(axis=1) > allowed
            widths = output.blocks.widths(output.p)
            if not off.any() or len(widths) + off.sum() > MOST:
                break
            halves = [
                np.repeat(widths[s] / (1 + off[s]), 1 + off[s])
                for s in output.blocks.layout.phase_slices
            ]
            numbers = output.theta[self._named :]
            found = self._again(mode, problem, Mesh(tuple(halves)), numbers)
            if found is None:
                break
            mode = found
        return replace(mode, error=self._error(mode))

    def _error(self, mode: Mode) -> float:
        """One Newton step of the next better scheme: what it changes the load by."""
        finer, _ = mode.trajectory.dense.refined()
        residuals, derivatives = finer.blocks.linearize(finer.w, finer.p)
        step = factored(finer.blocks, derivatives, finer.p).solve(residuals)
        _, _, constants = finer.blocks.layout.unpack(step)
        return abs(float(constants[self.deflected.sizes[1]]))


def _shared(ends: Array) -> Mesh:
    """Equal elements in phases between fractions, as many as their lengths ask for."""
    shares = np.diff(ends)
    if len(shares) == 1:
        return Mesh.uniform(INTERVALS)
    return Mesh.uniform(*(max(4, round(INTERVALS * float(share))) for share in shares))
