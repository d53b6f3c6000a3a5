"""The conditions of a scene on the unknowns of both ends, linearised where it is asked.

Unknowns z = (x(0), x(1), c) of the reduced states, whatever the scene's own: they know that the
force is one constant, so that a force prescribed at both ends is seen as prescribed twice.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics import MODELS, RodFields
from ribbonopt.problem.contract import BoundaryValueProblem
from ribbonopt.problem.ribbon import Ribbon

NX = len(MODELS["reduced"].states)
NC = len(MODELS["reduced"].constants)
STEPS = 16
CONVERGED = 1e-11
NEGLIGIBLE = 1e-9  # singular value, relative to the largest, that a step leaves alone


@dataclass(frozen=True, eq=False)
class Linearized:
    """Conditions as functions of z, for one set of numbers theta.

    Attributes
    ----------
    ribbon : Ribbon
        On the reduced states.
    names : tuple of str
        The nb conditions, those that make the start's directors a frame included.
    function : Function
        (z, theta) to their residuals and Jacobian, (nb, 1 + nz).
    theta : (np,) array
        Numbers of the scene.
    """

    ribbon: Ribbon
    names: tuple[str, ...]
    function: ca.Function
    theta: Array

    def at(self, z: Array) -> tuple[Array, Array]:
        """Residuals (nb,) and Jacobian (nb, nz)."""
        both = self.function(z, self.theta).full()
        return both[:, 0], both[:, 1:]

    def parameter(self, name: str) -> float:
        """Value of a parameter of the scene."""
        return float(self.theta[list(self.ribbon.theta).index(name)])

    @cached_property
    def reference(self) -> Array:
        """Point (3,) on which the constant moment acts."""
        return np.array([self.parameter(f"reference.{axis}") for axis in "xyz"])

    @cached_property
    def length(self) -> float:
        """Length of the ribbon."""
        return self.parameter("interval.end") - self.parameter("interval.start")

    def generic(self, seed: float) -> Array:
        """Unknowns z of a rod without any symmetry.

        A Weyl sequence instead of `numpy.random`, whose import costs more than all of this module.
        """
        values = 2 * np.modf(seed + np.arange(1, 37) * 0.6180339887498949)[0] - 1
        frames = np.linalg.qr(values[:18].reshape(2, 3, 3))[0]
        frames *= np.linalg.det(frames)[:, None, None]
        r, n, m = values[18:].reshape(3, 2, 3)
        size = self.length
        fields = RodFields(size * r, frames, n / size**2, m / size)
        x, c = self.ribbon.model.pack(fields, self.reference)
        return np.concatenate([x.ravel(), c])

    def satisfied(self, seed: float) -> Array | None:
        """Unknowns z without any symmetry but what the conditions demand; None if not found.

        Gauss-Newton from the generic rod: the shortest step to where the linearised conditions
        hold. The end's directors stay a frame too, which for a ribbon follows from the start's.
        """
        z = self.generic(seed)
        scale = self.scales(z)
        count = len(self.names)
        residuals, jacobian = np.empty(count + 1), np.zeros((count + 1, len(z)))
        for _ in range(STEPS):
            residuals[:count], jacobian[:count] = self.at(z)
            q = z[NX + 3 : 2 * NX]
            residuals[count], jacobian[count, NX + 3 : 2 * NX] = q @ q - 1, 2 * q
            scaled = jacobian * scale
            rows = np.sqrt(np.einsum("ij,ij->i", scaled, scaled))
            relative = residuals / np.where(rows > 0, rows, np.nan)
            worst = np.abs(relative).max()
            if not np.isfinite(worst):
                return None
            if worst < CONVERGED:
                return z
            step = np.linalg.lstsq(scaled / rows[:, None], relative, rcond=NEGLIGIBLE)[0]
            z = z - scale * step
        return None

    def scales(self, z: Array) -> Array:
        """Sizes (nz,) of the unknowns: lengths, quaternions, forces and moments."""
        state = np.append(np.full(3, self.length), np.ones(NX - 3))
        n, m = z[2 * NX : 2 * NX + 3], z[2 * NX + 3 :]
        force = max(1 / self.length**2, float(np.linalg.norm(n)))
        moment = max(1 / self.length, float(np.linalg.norm(m)))
        return np.concatenate([state, state, np.full(3, force), np.full(3, moment)])


def linearize(ribbon: Ribbon, problem: BoundaryValueProblem, theta: Array) -> Linearized:
    """Return the conditions of a ribbon on its reduced states."""
    reduced = replace(ribbon, model=MODELS["reduced"])
    z = ca.SX.sym("z", 2 * NX + NC)
    named = reduced.residuals(z[:NX], z[NX : 2 * NX], z[2 * NX :])
    conditions = ca.vertcat(*named.values())
    both = ca.densify(ca.horzcat(conditions, ca.jacobian(conditions, z)))
    function = ca.Function("conditions", [z, problem.parameters], [both])
    return Linearized(reduced, tuple(named), function, theta)
