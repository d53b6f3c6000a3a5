"""A posteriori error of the answer: one Newton step of the next better scheme, from the solution.

The dense output is put into the same problem collocated with one degree more (at the highest
degree, and for shooting, on halved elements). Its defect is the local error; the Newton step
carries it through the boundary conditions to every unknown. The improved solution minus the
solution is the estimate.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution import Solution
from ribbonopt.solvers.condense import CondensedSystem

if TYPE_CHECKING:
    from ribbonopt.transcription import Blocks, Output

ROUNDING = 1e-15


@dataclass(frozen=True, eq=False)
class Analysis:
    """What the next better scheme says of a solution.

    Attributes
    ----------
    better : Solution
        The solution after one Newton step of that scheme.
    local : (N,) array
        Local error of every element: what it adds to the states at its end, each state relative to
        its size along the ribbon.
    """

    better: Solution
    local: Array


@lru_cache(maxsize=2)
def analyse(solution: Solution) -> Analysis:
    """Analyse a solution of a square problem; LinAlgError if its equations are singular."""
    dense = solution.dense
    blocks, split = dense.blocks.finer()
    widths = np.repeat(dense.blocks.widths(dense.p) / split, split)
    p = np.concatenate([dense.theta, widths])
    w = blocks.layout.pack(*_sampled(dense, blocks, p))
    residuals, derivatives = blocks.linearize(w, p)
    step = CondensedSystem(blocks, derivatives, p).solve(residuals)
    better = replace(solution, dense=blocks.dense(w + step, p))
    nodes = blocks.layout.unpack(w)[0]
    size = np.maximum(np.abs(nodes).max(axis=0), 1.0)
    local = np.abs(residuals.nodes / size).max(axis=1).reshape(-1, split).sum(axis=1)
    return Analysis(better, local)


def estimate_error(solution: Solution) -> dict[str, float]:
    """Estimated absolute errors of `n0`, `m0`, `u0`, `H0`, `energy` and `states`.

    Vectors by their largest component, in the units of the solution; states: positions, over the
    unit of length, and directors at the nodes. None of them is below rounding.
    """
    better, units = analyse(solution).better, solution.units
    result = {
        name: _gap(getattr(better, name), getattr(solution, name), units.of(name[0]))
        for name in ("n0", "m0", "u0")
    }
    result["H0"] = _gap(better.start["H"], solution.start["H"], units.of("H"))
    result["energy"] = _gap(np.array(better.energy), np.array(solution.energy), units.moment)
    ours, theirs = (s.outputs(solution.nodes) for s in (solution, better))
    states = {name: units.of(name) for name in ("r", "d1", "d2", "d3")}
    result["states"] = max(_gap(theirs[k], ours[k], unit) / unit for k, unit in states.items())
    return result


def relative_error(solution: Solution) -> tuple[float, str]:
    """Largest estimated error over the size of what it is an error of, and the name of that.

    Loads are measured by the larger of force times length and moment, strains by the largest
    along the ribbon, states by the length.
    """
    errors, units = estimate_error(solution), solution.units
    force, moment = units.of("n"), units.of("m")
    loads = max(float(np.abs(solution.n0).max()) / force, float(np.abs(solution.m0).max()) / moment)
    strains = float(np.abs(solution.at_stages["u"]).max()) / units.of("u")
    sizes = {
        "n0": loads * force,
        "m0": loads * moment,
        "u0": strains * units.of("u"),
        "energy": abs(solution.energy),
        "states": 1.0,
    }
    floor = np.finfo(float).tiny
    relative = {
        name: (errors[name] if size > floor else 0.0) / max(size, floor)
        for name, size in sizes.items()
    }
    worst = max(relative, key=lambda name: relative[name])
    return relative[worst], worst


def _sampled(dense: Output, blocks: Blocks, p: Array) -> tuple[Array, Array, Array]:
    """Nodes, stages and constants of a solution on another mesh or scheme."""
    slices = blocks.layout.phase_slices()
    positions = blocks.stage_positions(p)
    nodes, stages = [], []
    for phase, s in enumerate(slices):
        flat = positions[s].ravel()
        v = np.hstack([dense.states(phase, flat), dense.algebraic(phase, flat)])
        stages.append(v.reshape(*positions[s].shape, blocks.layout.nv))
        ends = np.append(0.0, np.cumsum(blocks.widths(p)[s]))
        x = dense.states(phase, ends)
        nodes.append(x if phase == len(slices) - 1 else x[:-1])
    return np.concatenate(nodes), np.concatenate(stages), dense.constants


def _gap(a: Array, b: Array, unit: float) -> float:
    size = float(np.abs(b).max())
    return max(float(np.abs(a - b).max()), ROUNDING * max(unit, size))
