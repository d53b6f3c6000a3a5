"""A posteriori error of the answer: one Newton step of the next better scheme, from the solution.

The dense output is put into the same problem collocated with one degree more (at the highest
degree, and for shooting, on halved elements). Its defect is the local error; the Newton step
carries it through the boundary conditions to every unknown. The improved solution minus the
solution is the estimate.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.solvers.condense import CondensedSystem

ROUNDING = 1e-15
LEAST = 1e-3  # size of an answer, Dw = L = 1, below which its error counts absolutely


@dataclass(frozen=True, eq=False)
class Analysis:
    """What the next better scheme says of a solution.

    Attributes
    ----------
    better : Trajectory
        The solution after one Newton step of that scheme.
    local : (N,) array
        Local error of every element: what it adds to the states at its end, each state relative to
        its size along the ribbon.
    errors, sizes : mappings of str to float
        Absolute errors of the parts of the answer, and what they are relative to; Dw = L = 1.
    factors : CondensedSystem or None
        Factors of the better scheme, if they were to be kept.
    """

    better: Trajectory
    local: Array
    errors: Mapping[str, float]
    sizes: Mapping[str, float]
    factors: CondensedSystem | None = None


def analyse(
    solution: Solution, near: CondensedSystem | None = None, *, keep: bool = False
) -> Analysis:
    """Analyse a solution of a square problem; LinAlgError if its equations are singular.

    `near` are factors kept from a solution on the same mesh, so near that with its own factors
    Newton's method contracted by q: the errors then come out with a relative error of q / (1 - q).
    Factors that are to be kept cost twice as much.
    """
    known = solution.trajectory.found
    if Analysis not in known:
        # Refinement, rows and summaries ask one after the other; none but the first for factors.
        found = _analysed(solution.trajectory, near, keep)
        known[Analysis] = replace(found, factors=None)
        return found
    analysis: Analysis = known[Analysis]
    return analysis


def estimate_error(solution: Solution) -> dict[str, float]:
    """Estimated absolute errors of `n0`, `m0`, `u0`, `H0`, `energy` and `states`.

    Vectors by their largest component, in the units of the solution; states: positions, over the
    unit of length, and directors anywhere along the ribbon. None of them is below rounding.
    """
    units = solution.units
    quantity = {"n0": "n", "m0": "m", "u0": "u", "H0": "H", "energy": "m"}
    errors = analyse(solution).errors
    return {name: units.of(quantity.get(name, "")) * error for name, error in errors.items()}


def relative_error(solution: Solution) -> tuple[float, str]:
    """Largest estimated error over the size of what it is an error of, and the name of that.

    Loads are measured by the larger of force times length and moment, strains by the largest
    along the ribbon, states by the length. Next to a straight ribbon without stress errors count
    absolutely: there is nothing that they could be relative to.
    """
    found = analyse(solution)
    relative = {name: found.errors[name] / max(size, LEAST) for name, size in found.sizes.items()}
    worst = max(relative, key=lambda name: relative[name])
    return relative[worst], worst


def _analysed(trajectory: Trajectory, near: CondensedSystem | None, keep: bool) -> Analysis:
    dense = trajectory.dense
    finer, split = dense.refined()
    blocks, w, p = finer.blocks, finer.w, finer.p
    if near is None:
        residuals, derivatives = blocks.linearize(w, p)
        factors = CondensedSystem(blocks, derivatives, p, only=None if keep else residuals)
    else:
        residuals, factors, keep = blocks.residuals(w, p), near, True
    step = factors.solve(residuals)
    better = Trajectory(trajectory.problem, finer.moved(step))
    size = np.maximum(np.abs(dense.at_nodes).max(axis=0), 1.0)
    local = np.abs(residuals.nodes / size).max(axis=1).reshape(-1, split).sum(axis=1)
    errors = _errors(trajectory, better, split)
    # Between the nodes the output starts from the node before, with the error of that element.
    errors["states"] = max(errors["states"], float(local.max()))
    return Analysis(better, local, errors, _sizes(trajectory), factors if keep else None)


def _errors(trajectory: Trajectory, better: Trajectory, split: int) -> dict[str, float]:
    """Differences of the answers, none below rounding."""
    ours = trajectory.at_nodes
    theirs = {name: values[::split] for name, values in better.at_nodes.items()}
    errors = {f"{name}0": _gap(theirs[name][0], ours[name][0]) for name in ("n", "m", "u", "H")}
    errors["energy"] = _gap(np.array(better.energy), np.array(trajectory.energy))
    errors["states"] = max(_gap(theirs[k], ours[k]) for k in ("r", "d1", "d2", "d3"))
    return errors


def _sizes(trajectory: Trajectory) -> dict[str, float]:
    """Return what the errors are relative to."""
    start = trajectory.at_nodes
    loads = max(float(np.abs(start[name][0]).max()) for name in ("n", "m"))
    strains = float(np.abs(trajectory.at_stages["u"]).max())
    return {
        "n0": loads,
        "m0": loads,
        "u0": strains,
        "energy": abs(trajectory.energy),
        "states": 1.0,
    }


def _gap(a: Array, b: Array) -> float:
    return max(float(np.abs(a - b).max()), ROUNDING * max(1.0, float(np.abs(b).max())))
