"""The conditions of a scene on the unknowns of both ends, linearised where it is asked.

Unknowns z = (x(0), x(1), c) of the least states, whatever the scene's own: without loads they know
that the force is one constant, so that a force prescribed at both ends is seen as prescribed twice.
Where something acts or holds between the ends, the states there stand between x(1) and c.
"""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem.contract import BoundaryValueProblem
from ribbonopt.problem.imposed import residuals
from ribbonopt.problem.posed import Posed
from ribbonopt.problem.ribbon import Ribbon

STEPS = 16
CONVERGED = 1e-11
NEGLIGIBLE = 1e-9  # singular value, relative to the largest, that a step leaves alone


@dataclass(frozen=True, eq=False)
class Linearized:
    """Conditions as functions of z, for the numbers of one scene.

    Attributes
    ----------
    ribbon : Ribbon
        On its least states.
    names : tuple of str
        The nb conditions, those that give states their meaning included.
    function : Function
        (z, theta) to their residuals and Jacobian, (nb, 1 + nz).
    posed : Posed
        The scene.
    """

    ribbon: Ribbon
    names: tuple[str, ...]
    function: ca.Function
    posed: Posed

    @property
    def nx(self) -> int:
        """Number of states at an end: position, quaternion, then others."""
        return len(self.ribbon.states)

    @property
    def points(self) -> int:
        """Number of points whose states are unknowns: the ends, and stations between them."""
        return 2 + len(self.ribbon.stations)

    def parts(self, z: Array) -> tuple[Array, Array, Array]:
        """States (nx,) at the start and at the end, and constants (nc,)."""
        return z[: self.nx], z[self.nx : 2 * self.nx], z[self.points * self.nx :]

    def at(self, z: Array) -> tuple[Array, Array]:
        """Residuals (nb,) and Jacobian (nb, nz)."""
        both = self.function(z, self.posed.values).full()
        return both[:, 0], both[:, 1:]

    @property
    def reference(self) -> Array:
        """Point (3,) on which the constant moment acts."""
        return self.posed.start[0]

    @property
    def length(self) -> float:
        """Length of the ribbon."""
        return self.posed.length

    def generic(self, seed: float) -> Array:
        """Unknowns z of a rod without any symmetry.

        A Weyl sequence instead of `numpy.random`, whose import costs more than all of this module.
        """
        count = self.points
        values = 2 * np.modf(seed + np.arange(1, 18 * count + 1) * 0.6180339887498949)[0] - 1
        frames = np.linalg.qr(values[: 9 * count].reshape(count, 3, 3))[0]
        frames *= np.linalg.det(frames)[:, None, None]
        r, n, m = values[9 * count :].reshape(3, count, 3)
        size = self.length
        fields = RodFields(size * r, frames, n / size**2, m / size)
        x, c = self.ribbon.model.pack(fields, self.reference)
        own = np.resize(0.1 * values, (count, len(self.ribbon.law.states)))
        # Unknown forces and moments at single places are none that the fields tell of.
        unknown = [i for i, name in enumerate(self.ribbon.constants) if " of " in name]
        c[unknown] = np.resize(values, len(unknown))
        return np.concatenate([np.hstack([x, own]).ravel(), c])

    def satisfied(self, seed: float) -> Array | None:
        """Unknowns z without any symmetry but what the conditions demand; None if not found.

        Gauss-Newton from the generic rod: the shortest step to where the linearised conditions
        hold. The end's directors stay a frame too, which for a ribbon follows from the start's.
        """
        z = self.generic(seed)
        scale = self.scales(z)
        count, model = len(self.names), self.ribbon.model
        more = len(model.defect(self.parts(z)[1])[0])
        off, jacobian = np.empty(count + more), np.zeros((count + more, len(z)))
        last = slice(self.nx, self.nx + len(model.states))
        for _ in range(STEPS):
            off[:count], jacobian[:count] = self.at(z)
            off[count:], jacobian[count:, last] = model.defect(z[last])
            scaled = jacobian * scale
            rows = np.sqrt(np.einsum("ij,ij->i", scaled, scaled))
            relative = off / np.where(rows > 0, rows, np.nan)
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
        start, _, constants = self.parts(z)
        known = dict(zip(self.ribbon.states, start, strict=True))
        known |= dict(zip(self.ribbon.constants, constants, strict=True))
        n, m = ([known.get(f"{v}{axis}", 0.0) for axis in "xyz"] for v in "nm")
        force = max(1 / self.length**2, float(np.linalg.norm(n)))
        moment = max(1 / self.length, float(np.linalg.norm(m)))
        sizes = {"r": self.length, "n": force, "F": force, "m": moment, "a": moment, "b": moment}
        model = self.ribbon.model
        state = [sizes.get(name[0], 1.0) for name in model.states]
        state += [1.0] * len(self.ribbon.law.states)
        return np.array(self.points * state + [sizes[name[0]] for name in model.constants])


def linearize(
    ribbon: Ribbon, posed: Posed, problem: BoundaryValueProblem | None = None
) -> Linearized:
    """Return the conditions of a ribbon on its least states.

    Those of its `problem`, where they are the same: they need not be written again.
    """
    least, law = ribbon.least, ribbon.law.indirect()
    if law is not least.law:
        least = replace(least, law=law, _kept={})
    if problem is not None and least is ribbon and _stands_on(problem, ribbon):
        (start, *inner, end), c, named = problem.points, problem.constants, problem.conditions
    else:
        size = len(least.states)
        start, end = (ca.SX.sym(name, size) for name in ("start", "end"))
        inner = [ca.SX.sym("inner", size) for _ in least.stations]
        c = ca.SX.sym("c", len(least.constants))
        named = residuals(least, start, end, c, inner)
    z = ca.vertcat(start, end, *inner, c)
    conditions = ca.vertcat(*named.values())
    both = ca.densify(ca.horzcat(conditions, ca.jacobian(conditions, z)))
    function = ca.Function("conditions", [z, ribbon.parameters], [both])
    return Linearized(least, tuple(named), function, posed)


def _stands_on(problem: BoundaryValueProblem, ribbon: Ribbon) -> bool:
    """Whether the unknowns of a problem are the states and constants of a ribbon, and no more."""
    names = problem.state_names, problem.constant_names
    more = problem.algebraic.numel() + problem.costate.numel() + len(problem.recovered)
    return names == (ribbon.states, ribbon.constants) and not more
