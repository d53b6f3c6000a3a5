"""Newton's method from a twisted circle, where it does for least energy.

Truth: the least energy, found by IPOPT from the same circle and followed in the same way.
"""

import numpy as np
import pytest

from ribbonopt.attempt.ledger import Ledger
from ribbonopt.guess.shapes import Perturbed
from ribbonopt.problem import Posed
from ribbonopt.scene import Boundary, Loads, Loop, Natural, Rod, Scene, Variational, validate_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.starts import automatic
from ribbonopt.starts.automatic import Automatic
from ribbonopt.starts.first_shape import shapes_for
from ribbonopt.starts.loops import newton_suffices

SMOOTH = Variational(delta=0.3)


def posed(half_twists: int, piece: str, law: object = SMOOTH, **more: object) -> Posed:
    loop = Loop(half_twists, piece)  # type: ignore[arg-type]
    interval = (0.0, 1.7 / loop.pieces)
    parts = {"law": law, "boundary": Boundary(loop=loop), "interval": interval, **more}
    return Posed.of(validate_scene(Scene("band", **parts)))  # type: ignore[arg-type]


def first(scene: Posed) -> tuple[Solution, str]:
    ledger = Ledger()
    guess = next(iter(Automatic(scene).guesses(scene, ledger)))
    assert isinstance(guess, Solution)
    return guess, ledger.steps[0]["step"]


@pytest.mark.parametrize(
    ("half_twists", "piece", "delta"),
    [
        (0, "whole", 0.01),
        (1, "whole", 0.01),
        pytest.param(-1, "whole", 0.8, marks=pytest.mark.slow),
        pytest.param(1, "half", 0.1, marks=pytest.mark.slow),
        (3, "fundamental", 0.01),
        (-5, "fundamental", 0.3),
        pytest.param(1, "whole", 0.5, marks=pytest.mark.slow),
        pytest.param(3, "fundamental", 0.3, marks=pytest.mark.slow),
        pytest.param(4, "fundamental", 0.03, marks=pytest.mark.slow),
        pytest.param(6, "fundamental", 0.5, marks=pytest.mark.slow),
        pytest.param(7, "fundamental", 0.1, marks=pytest.mark.slow),
        pytest.param(8, "fundamental", 0.01, marks=pytest.mark.slow),
        pytest.param(9, "fundamental", 1.0, marks=pytest.mark.slow),
    ],
)
def test_it_leads_to_what_least_energy_leads_to(
    half_twists: int, piece: str, delta: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = posed(half_twists, piece, Variational(delta=delta))
    found, told = first(scene)
    assert told.startswith("twisted circle")
    monkeypatch.setattr(automatic, "newton_suffices", lambda *parts: False)
    least, told = first(scene)
    assert told.startswith("least energy")
    assert found.energy == pytest.approx(least.energy, rel=1e-9)


@pytest.mark.parametrize(
    ("half_twists", "piece", "more"),
    [
        (2, "fundamental", {}),  # the figure of eight has more energy than what leaves its plane
        (3, "half", {}),
        (1, "whole", {"loads": Loads(force={"z": -1})}),  # type: ignore[arg-type]
        (1, "whole", {"natural": Natural(curvature=1.0)}),
        (1, "whole", {"width": "1 + 0.1 * s"}),
        (1, "whole", {"law": Rod(B=(1.0, 1.0, 1.0))}),
    ],
)
def test_other_bands_begin_with_least_energy(
    half_twists: int, piece: str, more: dict[str, object]
) -> None:
    scene = posed(half_twists, piece, **more)
    (shape,) = shapes_for(scene)
    law = scene.scene.law if "law" in more else SMOOTH
    assert not newton_suffices(scene, shape, law)


def test_so_does_a_circle_that_is_perturbed() -> None:
    scene = posed(1, "whole")
    (shape,) = shapes_for(scene)
    assert newton_suffices(scene, shape, SMOOTH)
    other = Perturbed.at_random(shape, 0.1, np.random.default_rng(0))
    assert not newton_suffices(scene, other, SMOOTH)
