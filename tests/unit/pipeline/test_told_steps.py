"""What is told of a search, and what of a smooth law is shown where nothing else was found."""

from types import SimpleNamespace
from typing import Any

import pytest

from ribbonopt.pipeline.told import other_phases
from ribbonopt.pipeline.tried import LABELLED, Tried
from ribbonopt.scene import Variational


def found(delta: float) -> Any:
    return SimpleNamespace(
        posed=SimpleNamespace(scene=SimpleNamespace(law=Variational(delta=delta)))
    )


def search(best: Any, **more: Any) -> Any:
    return SimpleNamespace(best=best, **more)


@pytest.mark.parametrize("deltas", [(0.1, 0.01), (0.01, 0.1, LABELLED), (0.01, 1e-4, 1e-5, 0.3)])
def test_the_sharpest_that_can_be_computed_again_is_shown(deltas: tuple[float, ...]) -> None:
    """Laws so sharp that only phases solve them would be no answer to look at."""
    tried = search(
        SimpleNamespace(verified=False, sheets=()),
        smooth=[found(delta) for delta in deltas],
        needs_phases=True,
    )
    getter: Any = Tried.smooth_instead
    shown = [one.posed.scene.law.delta for one in getter.fget(tried)]
    assert shown == sorted(delta for delta in deltas if delta >= LABELLED)


@pytest.mark.parametrize(
    ("named", "sheets", "words"),
    [
        ((0.3,), (1, -1), ""),
        ((0.2, 0.6), (1, -1, 1), ""),
        ((0.2, 0.6), (1, -1), "2 phases, not 3"),
        ((0.3,), (), "1 phases, not 2"),
        ((0.3,), (1, -1, 1), "3 phases, not 2"),
    ],
)
def test_a_scene_that_names_switches_names_one_phase_more(
    named: tuple[float, ...], sheets: tuple[int, ...], words: str
) -> None:
    posed = SimpleNamespace(scene=SimpleNamespace(switching=named))
    told = other_phases(search(SimpleNamespace(verified=True, sheets=sheets), posed=posed))
    assert (words in "".join(told)) and bool(told) == bool(words)
