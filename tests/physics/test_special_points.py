"""Folds and branch points of clamped strips, against values found without collocation.

Planar: one clamp or both of a buckled strip are turned against its bow. In space: its end is moved
across. The values are by shooting of order eight and, in the plane, by Legendre polynomials of the
angle as well; those of the same sense are in closed form.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from ribbonopt.scene import (
    Boundary,
    ContinuationStage,
    End,
    Kirchhoff,
    Law,
    LoadGuess,
    Scene,
    Variational,
)
from ribbonopt.scene.frames import AnyVector, Turn, Turns
from ribbonopt.studies.continuation.continuation import Continuation

SWEEP = pytest.mark.sweep  # `ribbonopt verify` has these points too
STEPS = (None, *(pytest.param(step, marks=SWEEP) for step in (2.5, 7.0)))  # largest, in degrees
#: distance lost by the ends: angle (degrees) of the fold where one clamp is turned
ONE = {0.4: 64.3483022372, 0.25: 51.1996292141, 0.15: 39.6646056051, 0.1: 32.3633539404}
ONE |= {0.05: 22.8595483544, 0.01: 10.2119046246}
#: angles of the branch point and of the fold where both are turned against the bow alike
MIRROR = {0.01: (11.4700410601, 11.5394636833), 0.05: (25.7456825265, 25.9125893315)}
MIRROR |= {0.1: (36.5843542629, 36.8441435567), 0.25: (58.6758391529, 59.2472575346)}
#: law, distance lost, and both branch points of the strip whose end is moved across
ACROSS = [
    (Kirchhoff(B2=1, B3=2), 0.1, (0.106386037595, 0.29666159426)),
    (Kirchhoff(B2=1, B3=2), 0.25, (0.230279190221, 0.46983316454)),
    (Kirchhoff(B2=1, B3=2), 0.4, (0.315420374410, 0.56550940407)),
    pytest.param(Variational(delta=0.1), 0.4, (0.31692641983, 0.5604730532), marks=SWEEP),
]


def modulus(lost: float) -> float:
    """Modulus k of a clamped elastica with its ends at 1 - lost: 2 E / K - 1."""
    return float(brentq(lambda k: 2 * ellipe(k**2) / ellipk(k**2) - 2 + lost, 1e-4, 0.99))


def same_sense(lost: float) -> float:
    """Angle (degrees) from which on the S shape is stable: the largest slope of the arch."""
    return float(np.degrees(2 * np.arcsin(modulus(lost))))


def arch(lost: float) -> LoadGuess:
    """Loads of the arch at its start."""
    k = modulus(lost)
    K = ellipk(k**2)
    return LoadGuess(force=(0, 0, -16 * K**2), moment=(0, 8 * k * K, 0))


def turned(lost: float, start: float, end: float, to: float, largest: float | None) -> Scene:
    """Clamps at 1 - lost; the start is turned by -start a, the end by end a, a up to `to`."""
    clamps = (
        End("clamped", position=place, directors=Turns((Turn(y=f"{factor}*a*deg"),)))
        for place, factor in (((0, 0, 0), -start), ((0, 0, 1 - lost), end))
    )
    return Scene(
        name="turned",
        law=Kirchhoff(B2=1, B3=2),
        states="planar",
        parameters={"a": 0.0},
        boundary=Boundary(*clamps),
        guess=arch(lost),
        tolerance=1e-10,
        record={"middle": "dot(r, ex) at 0.5"},
        continuation=ContinuationStage("parameters.a", to=to, from_=0.0, largest=largest),
    )


def found(scene: Scene) -> dict[str, list[float]]:
    """Special points by kind; all that is not resolved is a failure."""
    points: dict[str, list[float]] = {}
    for point in Continuation(scene):
        assert "not resolved" not in point.row["note"], point.row["note"]
        points.setdefault(point.kind, []).append(point.position)
    return points


def nearest(points: list[float], value: float) -> float:
    return min(points, key=lambda point: abs(point - value))


@pytest.mark.parametrize("largest", STEPS)
@pytest.mark.parametrize("lost", ONE)
def test_fold_of_one_clamp(lost: float, largest: float | None) -> None:
    points = found(turned(lost, 1, 0, 90, largest))
    assert points["fold"][0] == pytest.approx(ONE[lost], rel=1e-9)
    assert "branch point" not in points


@pytest.mark.parametrize("largest", STEPS)
@pytest.mark.parametrize("lost", MIRROR)
def test_both_clamps_against_the_bow(lost: float, largest: float | None) -> None:
    points = found(turned(lost, 1, 1, 90, largest))
    crossing, fold = MIRROR[lost]
    assert nearest(points["branch point"], crossing) == pytest.approx(crossing, rel=1e-9)
    assert points["fold"][0] == pytest.approx(fold, rel=1e-9)


@pytest.mark.parametrize("largest", STEPS)
@pytest.mark.parametrize("lost", [0.01, 0.1, 0.25])
def test_the_arch_turned_in_one_sense_keeps_its_energy(lost: float, largest: float | None) -> None:
    where = same_sense(lost)
    rows = [p for p in Continuation(turned(lost, 1, -1, 0.999 * where, largest))]
    energies = np.array([point.row["energy"] for point in rows])
    np.testing.assert_allclose(energies, energies[0], rtol=1e-10)
    assert {point.kind for point in rows} == {"point"}


def sheared(law: Law, lost: float, to: float, largest: float | None) -> Scene:
    return Scene(
        name="sheared",
        law=law,
        parameters={"y": 0.0},
        boundary=Boundary(
            End("clamped", position=(0, 0, 0), directors="identity"),
            End("clamped", position=(0, "y", 1 - lost), directors="identity"),
        ),
        guess=arch(lost),
        tolerance=1e-9,
        continuation=ContinuationStage("parameters.y", to=to, from_=0.0, largest=largest),
    )


@pytest.mark.parametrize("largest", [pytest.param(0.013, marks=SWEEP), 0.05, *STEPS[:1]])
@pytest.mark.parametrize(("law", "lost", "truth"), ACROSS)
def test_arch_moved_across(
    law: Law, lost: float, truth: tuple[float, float], largest: float | None
) -> None:
    points = found(sheared(law, lost, 1.05 * truth[1], largest))
    for value in truth:
        assert nearest(points["branch point"], value) == pytest.approx(value, abs=1e-10)


def pushed(lost: float, to: float, largest: float | None) -> Scene:
    """The start is not turned but pushed, by a moment against the clamped arch's."""
    scene = turned(lost, 1, 0, 90, largest)
    start = End(
        "hinged",
        position=(0, 0, 0),
        axis="d2",
        along=(0, 1, 0),
        moment=AnyVector(d2="M"),
    )
    return replace(
        scene,
        parameters={"a": 0.0, "M": arch(lost).moment[1]},
        boundary=replace(scene.boundary, start=start),
        continuation=ContinuationStage("parameters.M", to=to, largest=largest),
    )


@pytest.mark.parametrize("largest", [None, 0.03, 0.11])
def test_a_fold_under_load_is_where_the_load_is_largest(largest: float | None) -> None:
    lost, angles = 0.1, np.cos(np.pi * (np.arange(9) + 0.5) / 9)[::-1] + 7.5
    turning = turned(lost, 1, 0, 0, None)
    stage = ContinuationStage("parameters.a", values=(0.0, *angles.tolist()))
    turning = replace(turning, record={"M": "dot(m, ey) at 0"}, continuation=stage)
    rows = [p.row["M"] for p in Continuation(turning) if p.position in angles]
    moment = np.polynomial.Chebyshev.fit(angles, rows, 8)
    top = max(float(moment(a.real)) for a in moment.deriv().roots() if abs(a.imag) < 1e-9)
    fold = found(pushed(lost, 1.1 * top, largest))["fold"][0]
    assert fold == pytest.approx(top, rel=1e-8)
