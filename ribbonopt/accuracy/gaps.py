"""Two solutions of the same equations beside each other: by how much each quantity differs."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.solution.trajectory import Trajectory

from .layers import Layers, between

ROUNDING = 1e-15
RESOLVED = "u, layers apart"  # strains but in layers so thin that rounding moves them
MISSED = 1.5  # largest error inside an element over that at the places looked at
CANCEL = 0.25  # of the errors of the parts of H: what must not cancel in a bound
#: first columns of states (r, d1, d2, d3), u, n, m, H and n . m; how many states and u have
FIRSTS, ALONG = (0, 12, 15, 18, 21, 22), 15
JUMPING = ("switching", "leap")
#: d1' = u3 d2 - u2 d3, d2' = u1 d3 - u3 d1, d3' = u2 d1 - u1 d2: the factors (9,) of u1, u2, u3
TURNING = np.array(
    [[0, 0, 0, 0, 0, 1, 0, -1, 0], [0, 0, -1, 0, 0, 0, 1, 0, 0], [0, 1, 0, -1, 0, 0, 0, 0, 0.0]]
)
LEAST = 1e-3  # size of an answer, Dw = L = 1, below which its error counts absolutely


def gaps_at_nodes(
    trajectory: Trajectory,
    better: Trajectory,
    split: int,
    clear: Callable[[Array], NDArray[np.bool_]],
) -> dict[str, float]:
    """Differences of the answers, none below rounding.

    `better` has elements split in parts; `clear` says which fractions are in no thin layer.
    """
    known, theirs = compared(trajectory), compared(better)[::split]
    gap, size = _parts(np.abs(theirs - known)), _parts(np.abs(known))
    (_, u, n, m, H, _), (_, u0, n0, m0, H0, _) = gap[0].tolist(), size[0].tolist()
    errors = {"n0": _gap(n, n0), "m0": _gap(m, m0), "u0": _gap(u, u0)}
    # H is a difference: its rounding is that of its parts, which may cancel by accident.
    parts, gap_of_H = errors["n0"] + u0 * errors["m0"], _gap(H, H0, n0)
    errors["H0"] = max(gap_of_H, CANCEL * parts)
    energies = [each.energy for each in (better, trajectory)]
    potentials = energies
    if trajectory.problem.kept(_worked):
        potentials = [each.integral("potential") for each in (better, trajectory)]
    for name, (value, own) in (("energy", energies), ("potential", potentials)):
        errors[name] = _gap(abs(value - own), abs(own))
    if len(trajectory.ends) > 2:
        along = _shifted(trajectory, better.nodes[::split])
        gap, size = _parts(np.abs(theirs[:, :ALONG] - along)), _parts(np.abs(along))
    (states, u, *_), (most, strains, *_) = gap.max(axis=0).tolist(), size.max(axis=0).tolist()
    errors["states"] = _gap(states, most)
    nodes = better.at_nodes
    same = _same_side(trajectory.at_nodes, {name: nodes[name][::split] for name in JUMPING})
    apart = same & clear(trajectory.nodes)
    if apart.all():
        errors["u"] = errors[RESOLVED] = _gap(u, strains)
        return errors
    for name, rows in (("u", same), (RESOLVED, apart)):
        errors[name] = _gap(*(float(part[rows, 1].max(initial=0.0)) for part in (gap, size)))
    return errors


def _worked(problem: BoundaryValueProblem) -> bool:
    """Whether loads along the ribbon have a potential, so that its own is not its energy alone."""
    both = [(phase.outputs["energy"], phase.outputs["potential"]) for phase in problem.phases]
    return not all(ca.is_equal(energy, potential, 1) for energy, potential in both)


def sizes_of(trajectory: Trajectory) -> dict[str, float]:
    """Return what the errors of the answers are relative to."""
    nodes, strains = trajectory.at_nodes, trajectory.at_stages.largest("u")
    loads = max(float(np.abs(nodes[name][0]).max()) for name in ("n", "m"))
    return {
        "n0": loads,
        "m0": loads,
        "u0": strains,
        "H0": max(loads, abs(float(nodes["H"][0]))),
        "energy": abs(trajectory.energy),
        "states": 1.0,
        RESOLVED: strains,
    }


def gaps_between(
    trajectory: Trajectory,
    better: Trajectory,
    near_by: tuple[Layers, ...],
    growth: Array,
    clear: Callable[[Array], NDArray[np.bool_]],
) -> tuple[dict[str, float], Array]:
    """Errors of states and strains inside elements, and each element's (N,), relative."""
    result = np.zeros(len(trajectory.nodes) - 1)
    fractions, elements, watched = between(trajectory, near_by, growth)
    if not len(fractions):
        return {}, result
    ours, theirs = (t.looked_at(fractions) for t in (trajectory, better))
    gaps = {k: np.abs(theirs[k] - ours[k]).max(axis=1) for k in ("r", "d1", "d2", "d3", "u")}
    told = watched[elements]  # of others the nodes know as much, but for states
    strains = np.where(_same_side(ours, theirs) & told, gaps.pop("u"), 0.0)
    states = np.max(list(gaps.values()), axis=0)
    size = max(float(np.abs(ours["u"][told]).max(initial=0.0)), LEAST)
    resolved = np.where(clear(fractions), strains, 0.0)
    np.maximum.at(result, elements, np.maximum(states, resolved / size))
    result[~watched] = 0.0
    found = {"states": states, "u": strains, RESOLVED: resolved}
    # Next to layers the largest of so many places is not the largest of all.
    share = np.where(told, MISSED, 1.0)
    return {name: float((share * values).max()) for name, values in found.items()}, result


def compared(trajectory: Trajectory) -> Array:
    """Columns (N + 1, c) at the nodes of what is compared: states, strains, n, m and H first."""
    nodes = trajectory.at_nodes
    choice = nodes.choice
    return np.asarray(nodes.block(choice)[:, : choice.before("switching")])


def _parts(columns: Array) -> Array:
    """Largest number (k, p) of each part in such columns (k, c)."""
    firsts = FIRSTS if columns.shape[1] > ALONG else FIRSTS[:2]
    return np.asarray(np.maximum.reduceat(columns, firsts, axis=1))


def _shifted(trajectory: Trajectory, nodes: Array) -> Array:
    """Positions, directors and strains (N + 1, 15) at other fractions (N + 1,), near the nodes.

    Phases of two solutions are not as long; both are to be compared at the same arclength.
    """
    ours, length = trajectory.at_nodes, trajectory.length
    found: Array = compared(trajectory)[:, :ALONG].copy()
    shift = (length * (nodes - trajectory.nodes))[:, None]
    r, directors, u = found[:, :3], found[:, 3:12], found[:, 12:]
    tangent = (1 + ours["extension"])[:, None] * ours["d3"]
    slope = np.zeros_like(u)
    slope[1:] = np.diff(u, axis=0) / (length * np.diff(trajectory.nodes))[:, None]
    # Where phases meet strains may jump: there the next phase says how they change.
    meet = np.searchsorted(trajectory.nodes, trajectory.ends[1:-1])
    slope[meet] = slope[meet + 1]
    turning = (u @ TURNING).reshape(-1, 3, 3) @ directors.reshape(-1, 3, 3)
    directors += shift * turning.reshape(-1, 9)
    r += shift * tangent
    u += shift * slope
    return found


def _same_side(ours: Mapping[str, Array], theirs: Mapping[str, Array]) -> NDArray[np.bool_]:
    """Places (k,) where two solutions are on the same side of a jump that strains may have."""
    same: NDArray[np.bool_] = (ours["switching"] * theirs["switching"] > 0) | (ours["leap"] == 0)
    return same


def _gap(difference: float, whole: float, size: float = 1.0) -> float:
    """Return a difference, no less than the rounding of what is as large."""
    return max(difference, ROUNDING * max(size, whole))
