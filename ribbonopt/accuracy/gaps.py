"""Two solutions of the same equations beside each other: by how much each quantity differs."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.solution.trajectory import Trajectory

from .layers import Layers, between

ROUNDING = 1e-15
RESOLVED = "u, layers apart"  # strains but in layers so thin that rounding moves them
MISSED = 1.5  # largest error inside an element over that at the places looked at
CANCEL = 0.25  # of the errors of the parts of H: what must not cancel in a bound
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
    ours = trajectory.at_nodes
    theirs = {name: values[::split] for name, values in better.at_nodes.items()}
    errors = {f"{name}0": _gap(theirs[name][0], ours[name][0]) for name in ("n", "m", "u")}
    # H is a difference: its rounding is that of its parts, which may cancel by accident.
    parts = errors["n0"] + float(np.abs(ours["u"][0]).max()) * errors["m0"]
    gap = _gap(theirs["H"][0], ours["H"][0], float(np.abs(ours["n"][0]).max()))
    errors["H0"] = max(gap, CANCEL * parts)
    for name in ("energy", "potential"):
        errors[name] = _gap(np.array(better.integral(name)), np.array(trajectory.integral(name)))
    along = {name: ours[name] for name in ("r", "d1", "d2", "d3", "u")}
    if len(trajectory.ends) > 2:
        along = _shifted(trajectory, better.nodes[::split])
    same, u = _same_side(ours, theirs), along.pop("u")
    strains = resolved = _gap(theirs["u"][same], u[same])
    apart = same & clear(trajectory.nodes)
    if (apart != same).any():
        resolved = _gap(theirs["u"][apart], u[apart])
    better_states, states = (np.hstack([rows[k] for k in along]) for rows in (theirs, along))
    errors["states"] = _gap(better_states, states)
    return errors | {"u": strains, RESOLVED: resolved}


def sizes_of(trajectory: Trajectory) -> dict[str, float]:
    """Return what the errors of the answers are relative to."""
    start = trajectory.at_nodes
    loads = max(float(np.abs(start[name][0]).max()) for name in ("n", "m"))
    strains = float(np.abs(trajectory.at_stages["u"]).max())
    return {
        "n0": loads,
        "m0": loads,
        "u0": strains,
        "H0": max(loads, abs(float(start["H"][0]))),
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
    fractions, elements = between(trajectory, near_by, growth)
    if not len(fractions):
        return {}, result
    ours, theirs = (t.outputs(fractions) for t in (trajectory, better))
    gaps = {k: np.abs(theirs[k] - ours[k]).max(axis=1) for k in ("r", "d1", "d2", "d3", "u")}
    strains = np.where(_same_side(ours, theirs), gaps.pop("u"), 0.0)
    states = np.max(list(gaps.values()), axis=0)
    size = max(float(np.abs(ours["u"]).max()), LEAST)
    resolved = np.where(clear(fractions), strains, 0.0)
    np.maximum.at(result, elements, np.maximum(states, resolved / size))
    found = {"states": states, "u": strains, RESOLVED: resolved}
    # The largest of so many places is not the largest of all.
    return {name: MISSED * float(values.max()) for name, values in found.items()}, result


def _shifted(trajectory: Trajectory, nodes: Array) -> dict[str, Array]:
    """Positions, directors and strains at other fractions (N + 1,), near the nodes.

    Phases of two solutions are not as long; both are to be compared at the same arclength.
    """
    ours, length = trajectory.at_nodes, trajectory.length
    shift = (length * (nodes - trajectory.nodes))[:, None]
    darboux = np.einsum("ki,ikj->kj", ours["u"], np.stack([ours[f"d{i}"] for i in (1, 2, 3)]))
    tangent = (1 + ours["extension"])[:, None] * ours["d3"]
    found = {"r": ours["r"] + shift * tangent}
    found |= {d: ours[d] + shift * np.cross(darboux, ours[d]) for d in ("d1", "d2", "d3")}
    slope = np.zeros_like(ours["u"])
    slope[1:] = np.diff(ours["u"], axis=0) / (length * np.diff(trajectory.nodes))[:, None]
    # Where phases meet strains may jump: there the next phase says how they change.
    meet = np.searchsorted(trajectory.nodes, trajectory.ends[1:-1])
    slope[meet] = slope[meet + 1]
    return found | {"u": ours["u"] + shift * slope}


def _same_side(ours: Mapping[str, Array], theirs: Mapping[str, Array]) -> NDArray[np.bool_]:
    """Places (k,) where two solutions are on the same side of a jump that strains may have."""
    same: NDArray[np.bool_] = (ours["switching"] * theirs["switching"] > 0) | (ours["leap"] == 0)
    return same


def _gap(a: Array, b: Array, size: float = 1.0) -> float:
    difference, whole = (float(np.abs(x).max(initial=0.0)) for x in (a - b, b))
    return max(difference, ROUNDING * max(size, whole))
