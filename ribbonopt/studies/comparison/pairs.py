"""The pairs of a comparison: formulation, states and transcription, and meshes for each.

Everything here is an override of a scene: which pairs make sense is for those to say who build
them, and what they refuse is a result like any other.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, Literal, TypeVar

from ribbonopt import problem
from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.scene import Algebraic, Collocation, Scene, Shooting

T = TypeVar("T")
Mesh = Collocation | Shooting
States = Literal["reduced", "full"]

STATES: tuple[States, ...] = ("reduced", "full")

#: formulations by the name the command line knows, as a scene writes them
FORMULATIONS: dict[str, Any] = {
    **{name: name for name in problem.FORMULATIONS},
    "algebraic-unbounded": Algebraic(bounds=False),
}

# (degree, intervals) from cheap to fine. Higher degrees before more intervals: ribbons are smooth
# but for the points where m2 changes sign, and there only the intervals help.
_LADDER = ((3, 5), (4, 6), (5, 6), (6, 8), (8, 8), (8, 16), (8, 32), (8, 64))
_GRID = tuple((degree, intervals) for degree in (2, 4, 6) for intervals in (4, 8, 16, 32))


@dataclass(frozen=True)
class SchemeFamily:
    """One transcription with the meshes to try.

    Attributes
    ----------
    ladder : tuple of Mesh
        From cheap to fine, to climb until an error is met.
    grid : tuple of Mesh
        Meshes that differ by factors of two, to measure orders.
    """

    ladder: tuple[Mesh, ...]
    grid: tuple[Mesh, ...]


def _collocation(scheme: Literal["gauss", "radau", "lobatto"]) -> SchemeFamily:
    return SchemeFamily(
        tuple(Collocation(scheme=scheme, degree=d, intervals=n) for d, n in _LADDER),
        tuple(Collocation(scheme=scheme, degree=d, intervals=n) for d, n in _GRID),
    )


def _explicit(
    scheme: Literal["rk4", "rk8"], ladder: Sequence[int], grid: Sequence[int]
) -> SchemeFamily:
    """Ten intervals, the mesh in the steps: more intervals only make the program larger."""
    return SchemeFamily(
        tuple(Shooting(scheme=scheme, steps=k, intervals=10) for k in ladder),
        tuple(Shooting(scheme=scheme, steps=k, intervals=10) for k in grid),
    )


#: transcriptions by the name the command line knows
TRANSCRIPTIONS: dict[str, SchemeFamily] = {
    "gauss": _collocation("gauss"),
    "radau": _collocation("radau"),
    "lobatto": _collocation("lobatto"),
    "rk4": _explicit("rk4", (1, 4, 16, 64), (1, 2, 4, 8)),
    "rk8": _explicit("rk8", (1, 2, 4, 8), (1, 2, 4)),
    "shooting-gauss": SchemeFamily(
        tuple(Shooting(scheme="gauss", degree=d, intervals=n) for d, n in _LADDER),
        tuple(Shooting(scheme="gauss", degree=d, intervals=n) for d, n in _GRID),
    ),
}


@dataclass(frozen=True)
class Pair:
    """One way to solve a scene, but for the mesh; names as the command line knows them."""

    formulation: str
    states: States
    transcription: str

    def __str__(self) -> str:
        """Name in tables and sentences."""
        return f"{self.formulation}, {self.states}, {self.transcription}"

    @property
    def family(self) -> SchemeFamily:
        """Transcription and its meshes."""
        return TRANSCRIPTIONS[self.transcription]

    def scene(self, scene: Scene, mesh: Mesh) -> Scene:
        """Return the scene, solved this way on a mesh: neither phases nor another mesh help."""
        return replace(
            scene,
            formulation=FORMULATIONS[self.formulation],
            states=self.states,
            planar=False,
            transcription=mesh,
            switching="off",
            tolerance=None,
        )


def pairs_of(
    formulations: Iterable[str] | None = None, transcriptions: Iterable[str] | None = None
) -> tuple[Pair, ...]:
    """Return all pairs of the formulations and transcriptions named; None stands for all.

    Raises
    ------
    SceneError
        If a name is not known.
    """
    chosen = _known("formulations", formulations, FORMULATIONS)
    schemes = _known("transcriptions", transcriptions, TRANSCRIPTIONS)
    return tuple(Pair(f, states, t) for f in chosen for states in STATES for t in schemes)


def _known(what: str, names: Iterable[str] | None, known: dict[str, T]) -> tuple[str, ...]:
    chosen = tuple(known if names is None else dict.fromkeys(names))
    unknown = [repr(name) for name in chosen if name not in known]
    if unknown or not chosen:
        found = ", ".join(unknown) or "none"
        raise SceneError(f"{what}: found {found}; expected some of {', '.join(known)}")
    return chosen
