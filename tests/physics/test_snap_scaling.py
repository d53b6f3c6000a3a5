"""Where a strip whose ends are brought together by d snaps as one clamp is turned: as sqrt(d).

Truth: shooting of order eight and Legendre polynomials of the angle, which agree to the digits
given; for d to zero the beam equation, in closed form.
"""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from ribbonopt.scene import Boundary, ContinuationStage, End, Kirchhoff, LoadGuess, Scene
from ribbonopt.scene.frames import Turn, Turns
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import FOLD, POINT

#: shortening d: angle of the fold (radians) over sqrt(d)
SCALED = {0.1: 1.7862033, 0.02: 1.7828323, 0.004: 1.7819933, 0.0008: 1.7818197}
LIMIT = 1.78177604115671


def snapping(lost: float, steps: float) -> Scene:
    k = float(brentq(lambda k: 2 * ellipe(k**2) / ellipk(k**2) - 2 + lost, 1e-4, 0.99))
    K = ellipk(k**2)
    to = float(np.degrees(2.2 * np.sqrt(lost)))
    return Scene(
        name="snapping",
        law=Kirchhoff(B2=1, B3=2),
        states="planar",
        parameters={"a": 0.0},
        boundary=Boundary(
            End("clamped", position=(0, 0, 0), directors=Turns((Turn(y="-a*deg"),))),
            End("clamped", position=(0, 0, 1 - lost), directors="identity"),
        ),
        guess=LoadGuess(force=(0, 0, -16 * K**2), moment=(0, 8 * k * K, 0)),
        tolerance=1e-10,
        continuation=ContinuationStage(
            "parameters.a", to=to, from_=0.0, largest=to / steps, stop=("fold",)
        ),
    )


def scaled_fold(lost: float, steps: float) -> float:
    points = list(Continuation(snapping(lost, steps)))
    assert [point.kind for point in points if point.kind != POINT] == [FOLD]
    assert not any("not resolved" in point.note for point in points)
    return float(np.radians(points[-1].position) / np.sqrt(lost))


@pytest.mark.parametrize("steps", [1, 10, 37])
@pytest.mark.parametrize("lost", SCALED)
def test_angle_of_the_snap(lost: float, steps: float) -> None:
    assert scaled_fold(lost, steps) == pytest.approx(SCALED[lost], abs=6e-8)


def test_the_snap_tends_to_that_of_the_beam() -> None:
    values = np.array([scaled_fold(lost, 10) for lost in SCALED])
    # Each d is a fifth of the one before: remove the terms in d, d^2, d^3.
    for power in (1, 2, 3):
        values = (5**power * values[1:] - values[:-1]) / (5**power - 1)
    assert values.item() == pytest.approx(LIMIT, abs=1e-8)
