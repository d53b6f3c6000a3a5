"""A posteriori error of the answer: one Newton step of the next better scheme, from the solution.

The dense output is put into the same problem collocated with one degree more (at the highest
degree, and for shooting, on halved elements). Its defect is the local error; the Newton step
carries it through the boundary conditions to every unknown. The improved solution minus the
solution is the estimate, and four times that the bar.

Two schemes agree, and are wrong, where the stages of both step over a layer of the law. So the law
says where its layers are, and what is conserved witnesses: where either finds more than the schemes
differ by, the local error is that, and the errors of the answer grow with it.

A minimum is compared with the answer on elements twice as wide instead, see `compared`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.scene import Ipopt
from ribbonopt.solution.potential import dead_force_of
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.solvers.protocols import Factors

from .compared import compared
from .gaps import LEAST, RESOLVED, gaps_at_nodes, gaps_between, sizes_of
from .improved import improved
from .layers import Layers, clear_of, layers, overlooked
from .witness import columns_of_rod, more_of, summed, witness

UNIT = 3e-16  # local error by rounding alone
SAFETY = 4.0  # bar over estimate: what the next better scheme itself may miss
DOUBTFUL = 3.0  # times the difference of the schemes, from which on errors are not known,
#: times solver tolerance^(2/3): of a minimum with a jump. The barrier of its inequality costs
#: strains min(tol / d^2, sqrt(tol / d)) at the distance d, where elements are as wide
BARRIER = 30.0
ACCIDENT = 0.01  # of the relative error of the loads of a minimum: least of its energy
SMALL = 1e-4  # unless they are smaller than this all the same
#: of the local errors: less is left of them in a number of the start by accident alone, where those
#: of a layer and of the rest cancel in the difference of two schemes
CANCELLED = 1 / 300
BLURRED = 1e-14  # of the length: by how much rounding moves a layer, over that by which it may
#: what each bar is of, where that has a unit
QUANTITY = {"n0": "n", "m0": "m", "u0": "u", "u": "u", "H0": "H", "potential": "m", "energy": "m"}
USUAL = 1e-8  # tolerance of scenes that have none


@dataclass(frozen=True, eq=False)
class Analysis:
    """What the next better scheme says of a solution; of a minimum, that on coarser elements.

    Attributes
    ----------
    trajectory, other : Trajectory
        What elements are of, and the solution after one Newton step of that scheme. Of a minimum
        both the answer on the coarser elements: what the solution is compared with.
    local : (N,) array
        Local error of every element: what it adds to the states at its end, each state relative to
        its size along the ribbon.
    inside : (N,) array
        Error inside every element, relative, where that is not the business of its nodes: in stiff
        elements and next to layers; zero in others.
    errors, sizes : mappings of str to float
        Absolute errors of the parts of the answer, and what they are relative to; Dw = L = 1.
    more : float
        By how much errors exceed what the schemes differ by: rounding, and what they overlook.
    known : bool
        Whether errors are known: not where schemes overlook so much that this is a mere guess.
    layers : tuple of Layers
        Singularities of the law near each phase.
    factors : Factors or None
        Factors of the better scheme, if they were to be kept.
    least : float
        What the solver leaves of the relative error on any mesh, where that is more than rounding.
    """

    trajectory: Trajectory
    other: Trajectory
    local: Array
    inside: Array
    errors: Mapping[str, float]
    sizes: Mapping[str, float]
    more: float
    known: bool
    layers: tuple[Layers, ...]
    factors: Factors | None = None
    least: float = 0.0


def analyse(solution: Solution, near: Factors | None = None, *, keep: bool = False) -> Analysis:
    """Analyse a solution; LinAlgError if its equations are singular.

    ModelError for a minimum that was found on one mesh only.

    `near` are factors kept from a solution on the same mesh, so near that with its own factors
    Newton's method contracted by q: the errors then come out with a relative error of q / (1 - q).
    Factors that are to be kept cost twice as much.
    """
    known = solution.trajectory.found
    if Analysis not in known:
        # Refinement, rows and summaries ask one after the other; none but the first for factors.
        found = _analysed(solution, near, keep)
        known[Analysis] = found if found.factors is None else replace(found, factors=None)
        return found
    analysis: Analysis = known[Analysis]
    return analysis


def estimate_error(solution: Solution) -> dict[str, float]:
    """Bars: bounds of the absolute errors of n0, m0, u0, H0, energy, potential, states and u.

    Vectors by their largest component, in the units of the solution; states: positions, over the
    unit of length, and directors anywhere along the ribbon; u: strains anywhere along it, but where
    they jump. None of them is below rounding; nan where no bar can be given, because the mesh steps
    over a layer.
    """
    found, posed = analyse(solution), solution.posed
    bar = SAFETY if found.known else math.nan
    errors = {name: bar * error for name, error in found.errors.items() if name != RESOLVED}
    force = dead_force_of(posed)
    if force.any():
        # Its work at an end.
        errors["potential"] += float(np.linalg.norm(force)) * errors["states"]
    if posed.given is posed.scene:
        return errors
    of = solution.units.of
    return {name: of(QUANTITY.get(name, "")) * error for name, error in errors.items()}


def relative_error(solution: Solution) -> tuple[float, str]:
    """Largest bar over the size of what it is of, and the name of that.

    Loads are measured by the larger of force times length and moment, H by that and itself, strains
    by the largest along the ribbon, states by the length. Next to a straight ribbon without stress
    errors count absolutely: there is nothing that they could be relative to. Strains do not count
    in layers so thin, for the tolerance, that rounding moves them: they are jumps.
    """
    found = analyse(solution)
    error, worst = _worst(found.errors, found.sizes)
    return SAFETY * error, worst


def _worst(errors: Mapping[str, float], sizes: Mapping[str, float]) -> tuple[float, str]:
    """Largest error over the size of what it is of, and the name of that."""
    relative = {name: errors[name] / max(size, LEAST) for name, size in sizes.items()}
    worst = max(relative, key=relative.__getitem__)
    return relative[worst], worst


def _analysed(solution: Solution, near: Factors | None, keep: bool) -> Analysis:
    if solution.problem.recovered:
        return _of_minimum(solution)
    trajectory, tolerance = solution.trajectory, solution.posed.scene.tolerance or USUAL
    found = improved(solution, near, keep=keep)
    dense, split, residuals, growth = trajectory.dense, found.split, found.residuals, found.growth
    better = Trajectory(trajectory.problem, found.finer.moved(found.step))
    size = np.maximum(np.abs(dense.at_nodes).max(axis=0), 1.0)
    defects = np.abs(residuals.nodes / size)
    local = summed(defects.max(axis=1), split)
    near_by = tuple(layers(trajectory, i) for i in range(len(trajectory.problem.phases)))
    clear = clear_of(trajectory, near_by, BLURRED / tolerance)
    errors, sizes = gaps_at_nodes(trajectory, better, split, clear), sizes_of(trajectory)
    witnessed = np.maximum(witness(better, split), overlooked(trajectory, near_by))
    local, doubt = more_of(local, witnessed)
    # Rounding of one element counts as its local error does; an exact answer has none but that.
    more = doubt * (1 + len(local) * UNIT / max(float(local.sum()), UNIT))
    errors = {name: error * more for name, error in errors.items()}
    # Between the nodes the output starts from the node before, with the error of that element.
    more_inside, inside = gaps_between(trajectory, better, near_by, growth, clear)
    errors |= {name: max(errors[name], gap) for name, gap in more_inside.items()}
    of_rod, rod = local, trajectory.problem.kept(columns_of_rod)
    if len(rod) < len(size):
        # Errors in states of the law's own show in the rod where they matter to it.
        of_rod, _ = more_of(summed(defects[:, rod].max(axis=1), split), witnessed)
    errors["states"] = max(errors["states"], float(of_rod.max()))
    # And a Newton step leaves its own square, which on a mesh this coarse may be all there is.
    least = max(CANCELLED * float(of_rod.sum()), min(errors["states"], 1.0) ** 2)
    for name in ("n0", "m0", "u0", "energy"):
        errors[name] = max(errors[name], sizes[name] * least)
    known = doubt <= DOUBTFUL or _worst(errors, sizes)[0] <= SMALL
    parts = trajectory, better, local, inside, errors, sizes, more, known, near_by
    return Analysis(*parts, found.factors)


def _of_minimum(solution: Solution) -> Analysis:
    coarse, fine = solution.coarser, solution.trajectory
    if coarse is None:
        raise ModelError(
            "the answer of the energy formulation has no bars: it was found on one mesh only, with "
            "nothing to compare it with; give the scene a tolerance, or use another formulation",
            "tolerance",
        )
    near_by = tuple(layers(coarse, i) for i in range(len(coarse.problem.phases)))
    sizes, scene = sizes_of(fine), solution.posed.scene
    least = scene.solver.tolerance if isinstance(scene.solver, Ipopt) else Ipopt().tolerance
    open_in = least / (scene.tolerance or USUAL)
    errors, local, inside = compared(coarse, fine, near_by, sizes, open_in)
    local, more = more_of(local, overlooked(coarse, near_by))
    rounding = least * len(fine.nodes)  # costates take up what each element leaves
    jumps = any(near.jump.any() for near in near_by)
    barrier = BARRIER * least ** (2 / 3) if jumps else 0.0
    left = dict.fromkeys(errors, max(rounding, barrier))
    left |= dict.fromkeys(("energy", "potential"), rounding)  # of strains they know the square
    # Strains are controls of their elements: what other elements overlook moves them as the loads.
    strains = dict.fromkeys(("u0", "u", RESOLVED), sizes["u0"])
    moved = max(errors["n0"], errors["m0"]) / max(sizes["n0"], LEAST)
    # The energy of two meshes may agree by accident: it is not that much better than the loads.
    for name in ("energy", "potential"):
        errors[name] = max(errors[name], ACCIDENT * moved * sizes["energy"])
    errors = {
        name: error + (more - 1) * min(error, moved * strains.get(name, np.inf))
        for name, error in errors.items()
    }
    errors = {
        name: max(error, left[name] * max(sizes.get(name, 0.0), LEAST))
        for name, error in errors.items()
    }
    # What a jump costs at most is known, of other layers it is a guess.
    known = jumps or more <= DOUBTFUL or _worst(errors, sizes)[0] <= SMALL
    parts = coarse, coarse, local, inside, errors, sizes, more, known, near_by
    return Analysis(*parts, least=SAFETY * left["n0"])
