"""Switches of a kinked law that move: the second variation where strains leap.

Each side of a switch at s has the law of its phase. When the switch moves by k, a stretch of that
length changes sides: the shape turns there by [u] k, [u] being the leap of the strains, and since
the leap of W_Leg is zero at the switch and grows as its rate beside it, m' . [u] and what varies
with s in the law itself, that costs [W_Leg]' k^2 / 2. The states beside a switch so jump by [f] k,
the energy by [W] k (natural strains have an m . [u]), and what else they take part in, they do at
the middle of the jump. It is the limit of a smooth law: its layer, that bends easily, shrinks to a
point, and as the square of a moment over no length a switch weighs nothing in the metric.
"""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.problem import BoundaryValueProblem, Ribbon
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription.buffered import Buffered
from ribbonopt.transcription.functions import stage_functions

from .gauss_stages import GaussStages

NO_LEAP = 1e-9  # of the largest strain


@dataclass(frozen=True, eq=False)
class Moved:
    """What moves with k switches, each scaled to a leap of one: `jumps` (N, nx) of the states.

    Jumps are those at the start of each element, `prices` (N,) what they cost; `firsts` are the
    elements that begin at a switch, `turning` (k, nx, nx) the Jacobians of their jumps and
    `stiffness` (k,) what moving costs.
    """

    jumps: Array
    prices: Array
    firsts: NDArray[np.intp]
    turning: Array
    stiffness: Array

    def add_to(self, Q: Array, costates: Array) -> None:
        """Add to the Hessians (N, nx + m, nx + m) of elements, whose last variables are the moves.

        `costates` (N + 1, nx) are those of the nodes.
        """
        nx = costates.shape[1]
        Q[:, -1, -1] += 1.0  # where nothing moves: a variable without effect
        for e, turning, stiffness in zip(self.firsts, self.turning, self.stiffness, strict=True):
            coupling = costates[e] @ turning
            Q[e, -1, :nx] += coupling
            Q[e, :nx, -1] += coupling
            Q[e, -1, -1] += stiffness + coupling @ self.jumps[e] - 1.0


@dataclass(frozen=True, eq=False)
class MovingSwitches:
    """The leap at a switch as a function of a stage.

    By how much rates, strains and cost of the side +1 are above those of -1, the Jacobian of the
    rates by the states, and how the leap of W_Leg varies with the arclength alone.
    """

    leap: Buffered

    @classmethod
    def of(cls, ribbon: Ribbon, sides: Mapping[int, BoundaryValueProblem]) -> MovingSwitches:
        """Build from the problems of least energy of both sides, +1 and -1."""
        law, problem = ribbon.law, sides[1]
        above, below = (stage_functions(sides[kind])[0] for kind in (1, -1))
        inputs = list(above.inputs)
        change = above.equations - below.values(*inputs)
        free = problem.algebraic.numel()
        stress = law.stress_of(inputs[0][-free:], ca.SX.zeros(len(law.states)))
        strains = law.branch(1).strain(stress) - law.branch(-1).strain(stress)
        # Both sides have an energy, so that the second of each is W_Leg.
        (_, up), (_, down) = (law.branch(kind).densities(stress, strains) for kind in (1, -1))
        varies = ca.jacobian(up - down, ribbon.position)
        place = problem.start + inputs[3][0] * problem.phases[0].length
        strains, varies = ca.substitute([strains, varies], [ribbon.position], [place])
        jacobian = ca.jacobian(change, inputs[0])[:, :-free]
        price = above.cost_density(*inputs) - below.cost_density(*inputs)
        outputs = [ca.densify(each) for each in (change, strains, jacobian, varies, price)]
        return cls(Buffered(ca.Function("leap", inputs, outputs)))

    def at(self, solution: Solution, stages: GaussStages, theta: Array) -> Moved:
        """Return what moves at the switches of a solution."""
        trajectory, firsts = solution.trajectory, stages.firsts
        turns = list(trajectory.turns)
        nx, switches = stages.x.shape[1], trajectory.ends[turns]
        o = trajectory.outputs(switches)
        frames = solution.fields(switches).frames
        n, m = (np.einsum("ki,kij->kj", o[name], frames) for name in "nm")
        stretched = np.array([0.0, 0.0, 1.0]) * (1 + o["extension"])[:, None]
        slope = -np.cross(o["u"], m) - np.cross(stretched, n)  # m' of eq. (2.7)
        most = NO_LEAP * float(np.abs(trajectory.at_stages["u"]).max())
        jumps, prices = np.zeros((len(stages.widths), nx)), np.zeros(len(stages.widths))
        turning, stiffness = np.zeros((len(firsts), nx, nx)), np.ones(len(firsts))
        for i, e in enumerate(firsts):
            v = np.concatenate([stages.x_switch[i], stages.z_switch[i]])
            change, strains, jacobian, varies, price = self.leap(
                v, np.empty(0), theta, switches[i : i + 1]
            )
            size = float(np.linalg.norm(strains))
            if size <= most:
                continue  # nothing leaps: there is nothing to move
            sign = np.sign(solution.sheets[turns[i]] - solution.sheets[turns[i] - 1])
            jumps[e], prices[e] = sign * change / size, sign * float(price[0]) / size
            turning[i] = sign * jacobian.reshape(nx, nx).T / size
            cost = slope[i] @ strains + float(varies[0])
            stiffness[i] = trajectory.length**2 * sign * cost / size**2
        return Moved(jumps, prices, firsts, turning, stiffness)
