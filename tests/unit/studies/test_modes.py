"""Where buckling loads are looked for, and which modes are admitted."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import loads_scene
from ribbonopt.studies.buckling.buckling import SETTLED, _States
from ribbonopt.studies.buckling.mode import Mode
from ribbonopt.studies.buckling.rod import pure_stiffnesses

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
    found = pure_stiffnesses(Ribbon.of(posed), posed.values)
    np.testing.assert_allclose(found, [1.0, bending, twist], rtol=1e-9)


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
    assert Mode(1.0, 0.0, trajectory, kinds).admissible == admitted


@pytest.mark.parametrize(("low", "high"), [(1.0, 9.0), (-4.0, -1.0)])
def test_the_bar_of_a_load_is_the_error_of_its_mode_on_the_range(low: float, high: float) -> None:
    """Loads are known as fractions of the range, and no better than they are settled."""

    class Straight(_States):
        ribbon: Any = None

        def at(self, value: float) -> np.ndarray:
            return np.array([value])

        def least(self, value: float) -> Any:
            return None

    nothing: Any = None
    search: Any = SimpleNamespace(at=lambda load: np.array([low + load * (high - low)]))
    for error in (1e-6, 0.0):
        mode = Mode(0.25, error, nothing)
        found = Straight(nothing, nothing, "parameters.P").settled(search, mode, low, high)
        assert found is not None
        assert found.value == pytest.approx(low + 0.25 * (high - low))
        assert found.error >= max(error, SETTLED) * (high - low)
