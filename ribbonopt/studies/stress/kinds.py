"""The kinds of stress, by the name the command line knows."""

from __future__ import annotations

from collections.abc import Iterable

from ribbonopt.errors import SceneError

from .ends import distances, half_twists
from .meshes import meshes, refined, shooting, tolerances
from .numbers import lengths, loads, smoothing, stiffnesses
from .starts import degenerate, noise
from .trial import Kind
from .ways import ways

KINDS = {
    "noise": Kind("noise on the start", noise),
    "degenerate": Kind("starts that single nothing out", degenerate),
    "mesh": Kind("meshes, without a tolerance", meshes),
    "refined": Kind("meshes to begin with, to a tolerance", refined),
    "tolerance": Kind("tolerance", tolerances),
    "smoothing": Kind("epsilon or delta of the law", smoothing),
    "lengths": Kind("another unit of length", lengths),
    "stiffness": Kind("ratios of stiffnesses", stiffnesses),
    "loads": Kind("loads times a factor", loads),
    "half-twists": Kind("half twists of a band", half_twists),
    "distance": Kind("distance of the ends", distances),
    "shooting": Kind("single and multiple shooting", shooting),
    "ways": Kind("formulations, states, transcriptions, solvers", ways),
}


def kinds_of(names: Iterable[str] | None = None) -> dict[str, Kind]:
    """Return kinds by name; None for all.

    Raises
    ------
    SceneError
        If a name is not known.
    """
    chosen = tuple(KINDS if names is None else dict.fromkeys(names))
    unknown = [repr(name) for name in chosen if name not in KINDS]
    if unknown or not chosen:
        found = ", ".join(unknown) or "none"
        raise SceneError(f"--only: found {found}; expected some of {', '.join(KINDS)}")
    return {name: KINDS[name] for name in chosen}
