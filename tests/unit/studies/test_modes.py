"""Where buckling loads are looked for, and which modes are admitted."""

from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np
import pytest

from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import loads_scene
from ribbonopt.studies.buckling.mode import Mode
from ribbonopt.studies.buckling.rod import pure_compliances
from ribbonopt.studies.buckling.square import Pieces
from ribbonopt.studies.buckling.straight import SETTLED, StraightStates

TEXT = """
name: strip
law: %s
boundary:
  start: {position: [0, 0, 0], directors: identity}
  end: {force: [0, 1, 0], moment: [0, 0, 0]}
"""


@pytest.mark.parametrize(
    ("law", "bending", "twist"),
    [
        ("{type: kirchhoff, B2: 3, B3: 0.5}", 3.0, 0.5),
        ("{type: sadowsky}", 1.0, 4.0),  # m3 = 4 u3 of a ribbon twisted alone
        ("{type: variational, delta: 1.0}", 1.0, 1.0),
    ],
)
def test_the_rod_is_as_stiff_as_the_ribbon_bent_or_twisted_alone(
    law: str, bending: float, twist: float
) -> None:
    posed = Posed.of(loads_scene(TEXT % law))
    ribbon = Ribbon.of(posed)
    found = pure_compliances(ribbon, posed.values)
    numbers = ca.Function("numbers", [ribbon.parameters], [found])(posed.values)
    expected = [[0.0], [1 / bending], [1 / twist]]
    np.testing.assert_allclose(numbers.full(), expected, rtol=1e-9)


@pytest.mark.parametrize(
    ("m2", "kinds", "admitted"),
    [
        ([1, 0.5, -0.5, -1], (1, -1), True),
        ([1, 0.5, 1e-9, -1], (1, -1), True),  # zero but for rounding
        ([1, 0.5, 0.01, -1], (1, -1), False),
        ([1, -0.5, -0.5, -1], (1, -1), False),
        ([1, 0.5, -0.5, -1], (-1, 1), False),
        ([1, 0.5, -0.5, -1], (), True),  # a law that needs no phases
    ],
)
def test_modes_are_admitted_where_m2_has_the_sign_of_their_phases(
    m2: list[float], kinds: tuple[int, ...], admitted: bool
) -> None:
    m = np.stack([np.zeros(4), np.array(m2), np.full(4, 0.3)], axis=1)
    phases = np.array([0, 0, 1, 1]) if kinds else np.zeros(4, int)
    trajectory: Any = SimpleNamespace(at_stages={"m": m}, stages=(None, None, None, phases))
    assert Mode(1.0, 0.0, trajectory, Pieces(kinds) if kinds else None).admissible == admitted


@pytest.mark.parametrize(
    ("m2", "pieces", "places"),
    [
        ([1, 0.5, 0.25, 0.1], Pieces((1, 1), (1,)), [0.5]),
        ([1, -1, -1, -1], Pieces((1, -1, -1), (2,)), [0.25, 0.5]),  # a zero before the station
        ([1, 1, -1, -1], Pieces((1, -1), (1,)), [0.5]),  # a couple takes m2 over zero
        ([-1, -1, 0, 0], Pieces((-1, -1), (1,)), [0.5]),  # nothing acts behind the station
        ([0, 0, -1, 1], Pieces((1, -1, 1), (1,)), [0.5, 0.75]),
    ],
)
def test_phases_of_a_mode_meet_at_stations_too(
    m2: list[float], pieces: Pieces, places: list[float]
) -> None:
    m = np.stack([np.zeros(4), np.array(m2), np.full(4, 0.3)], axis=1)
    stages = None, np.array([0.125, 0.375, 0.625, 0.875]), None, np.array([0, 0, 1, 1])
    trajectory: Any = SimpleNamespace(
        at_stages={"m": m}, stages=stages, ends=np.array([0.0, 0.5, 1.0])
    )
    found, at = Mode(1.0, 0.0, trajectory).signs
    assert found == pieces
    np.testing.assert_allclose(at, places)


@pytest.mark.parametrize(("low", "high"), [(1.0, 9.0), (-4.0, -1.0)])
def test_the_bar_of_a_load_is_the_error_of_its_mode_on_the_range(low: float, high: float) -> None:
    """Loads are known as fractions of the range, and no better than they are settled."""

    class Straight(StraightStates):
        ribbon: Any = None

        def at(self, value: float) -> np.ndarray:
            return np.array([value])

        def least(self, value: float) -> Any:
            return None

    nothing: Any = None
    search: Any = SimpleNamespace(at=lambda load: np.array([low + load * (high - low)]))
    for error in (1e-6, 0.0):
        mode = Mode(0.25, error, nothing)
        found = Straight(nothing, nothing, nothing).settled(search, mode, low, high)
        assert found is not None
        assert found.value == pytest.approx(low + 0.25 * (high - low))
        assert found.error >= max(error, SETTLED) * (high - low)
