"""A trial: a scene as it was, but for one thing, and what its answer is to be compared with."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.scene import Scene
from ribbonopt.scene.units import Units


@dataclass(frozen=True, eq=False)
class Trial:
    """One variation of a scene.

    Attributes
    ----------
    value : str
        What is varied to what, in words; with the kind it names the trial.
    scene : Scene
        What is solved.
    label : str
        Short: trials that share it are drawn together.
    same : bool
        Whether the equilibrium should be that of the scene as it was: the trial changes how it is
        solved, or its units.
    start : callable or None
        Makes the guess from what was built, where it is no guess of the scene.
    units : Units
        What 1 of its units of length and force is, in those of the scene as it was.
    """

    value: str
    scene: Scene
    label: str
    same: bool = False
    start: Callable[[Prepared], Guess] | None = None
    units: Units = Units()


#: trials of a kind, or why there are none
Trials = Sequence[Trial] | str


@dataclass(frozen=True)
class Kind:
    """A kind of stress: `trials` takes the scene and whether a few values will do."""

    words: str
    trials: Callable[[Scene, bool], Trials]


def one_of(quick: bool, few: Sequence[float], many: Sequence[float]) -> Sequence[float]:
    """Return few values or many."""
    return few if quick else many


Kinds = Mapping[str, Kind]
