"""Special points of loci in two parameters: cusps, isola centres, crossings, double points.

Truth: closed forms, and shooting of order 8 in the plane with variational equations, which shares
nothing with the product; across the plane the linearised equations written out here.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve, minimize_scalar

from ribbonopt.scene import load_scene, loads_scene
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.studies.continuation.continuation import Continuation

MAPS = Path(__file__).parents[2] / "configs" / "maps"

#: a cantilever under a force whose components are formulas of a and b; its folds have a cusp where
#: the straight one buckles
CANTILEVER = """
name: cantilever
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {a: 0.055, b: 0.185}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free, force: [a - 0.12, 0, -(2.6 + b - 20*a*a)]}
guess: {force: [0, 0, -3.2], moment: [0, -2.5, 0]}
states: planar
tolerance: 1e-9
continuation:
  {parameter: [parameters.a, parameters.b], of: fold, between: [0.055, 0.15], to: 0.15,
   first: 0.02, stability: false}
"""


def shot(alpha: float, Q: float, P: float) -> np.ndarray:
    """Angle at the clamp, and its derivatives by alpha, Q, P, of a cantilever with tip angle alpha.

    th'' = -P sin th - Q cos th under the forces Q across and -P along.
    """

    def rates(s: float, y: np.ndarray) -> list[float]:
        c, sn = np.cos(y[0]), np.sin(y[0])
        d = -(P * c - Q * sn)
        return [y[1], -(P * sn + Q * c), y[3], d * y[2], y[5], d * y[4] - c, y[7], d * y[6] - sn]

    y = [alpha, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    return np.asarray(solve_ivp(rates, (1, 0), y, "DOP853", rtol=1e-12, atol=1e-13).y[::2, -1])


def level(alpha: float, a: float, b: float) -> np.ndarray:
    """Place (a, b) near a guess, the tip at an angle, where b is stationary: there folds meet."""

    def off(v: np.ndarray) -> list[float]:
        at, by_alpha, by_q, by_p = shot(v[0], v[1] - 0.12, 2.6 + v[2] - 20 * v[1] ** 2)
        return [at, by_alpha, by_q - 40 * v[1] * by_p]

    return np.asarray(fsolve(off, [alpha, a, b], xtol=1e-13))[1:]


@pytest.mark.slow
def test_cusp_crossing_and_isola_centre_of_a_cantilever() -> None:
    """One locus of folds has all three; the cusp is at zero force across and pi^2 / 4 along."""
    branch = Branch.of(Continuation(loads_scene(CANTILEVER)))
    found = {
        row["kind"]: (row["parameters.a"], row["parameters.b"], row["error"])
        for row in branch.special
        if row["of"] == "fold" and row["stage"] == 1
    }
    truth = {
        "cusp": (0.12, np.pi**2 / 4 - 2.6 + 20 * 0.12**2),
        "crossing": tuple(level(0.28, 0.108, 0.1786)),
        "isola centre": tuple(level(0.5, 0.0605, 0.163)),
    }
    assert set(found) == set(truth)
    for kind, (a, b) in truth.items():
        *place, error = found[kind]
        assert place == pytest.approx([a, b], abs=1e-7), kind
        assert abs(place[0] - a) <= max(error, 1e-12) * max(abs(a), 0.1 * 0.095), kind
        assert place[1] == pytest.approx(b, abs=1e-9), kind


@pytest.mark.slow
def test_the_closed_curve_of_folds_has_four_cusps() -> None:
    """Where an arch between two clamps snaps, in the plane of their angles."""
    branch = Branch.of(Continuation(load_scene(MAPS / "cusps.yaml")))
    places = {"cusp": [], "crossing": []}  # type: dict[str, list[tuple[float, ...]]]
    for row in branch.special:
        if row["stage"] == 1:
            first, second = row["parameters.first"], row["parameters.second"]
            places[row["kind"]].append((first, second, row["error"]))
    a, b = 36.5843542629, 36.6242808043
    truth = {(a, a), (-a, -a), (b, -b), (-b, b)}
    assert len(places["cusp"]) == 4
    for first, second, error in places["cusp"]:
        near = min(truth, key=lambda at: abs(at[0] - first) + abs(at[1] - second))
        truth.remove(near)
        assert max(abs(near[0] - first), abs(near[1] - second)) <= max(36 * error, 1e-9)
        assert (first, second) == pytest.approx(near, abs=1e-7)
    assert not truth
    for first, second, _ in places["crossing"]:
        assert abs(first) == pytest.approx(11.6024591820, abs=1e-5)
        assert abs(second) == pytest.approx(31.9967473002, abs=1e-8)
    assert "closed" in branch.endings[1, 0].reason


#: both clamps of an arch turned by the same angle against the bow; soft in twist it gives way
#: across its plane too, at an angle that depends on B3
MIRROR = """
name: mirror
law: {{type: kirchhoff, B2: 1, B3: 1.0}}
parameters: {{angle: 0}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: {{turns: [{{y: -angle*deg}}]}}}}
  end: {{support: clamped, position: [0, 0, 0.9], directors: {{turns: [{{y: angle*deg}}]}}}}
guess: {{force: [0, 0, -42], moment: [0, 4, 0]}}
tolerance: 1e-9
continuation:
  {{parameter: [parameters.angle, law.B3], of: {kind}, between: [0, 40], to: 0.55,
    stability: false}}
"""


def plane(m0: float, Nz: float, a: float) -> np.ndarray:
    """State [th, m2, x, z] of half the arch, th(0) = -a, under the force Nz along."""

    def rates(s: float, y: np.ndarray) -> list[float]:
        return [y[1], Nz * np.sin(y[0]), np.sin(y[0]), np.cos(y[0])]

    y = solve_ivp(rates, (0, 0.5), [-a, m0, 0, 0], "DOP853", rtol=1e-12, atol=1e-13)
    return np.asarray(y.y[:, -1])


def arch(m0: float, guess: tuple[float, float]) -> np.ndarray:
    """Force and angle of the symmetric arch with the moment m0 at the clamps."""

    def off(v: np.ndarray) -> list[float]:
        end = plane(m0, v[0], v[1])
        return [end[0], end[3] - 0.45]

    return np.asarray(fsolve(off, guess, xtol=1e-13))


def across(m0: float, Nz: float, a: float, B3: float) -> float:
    """Determinant of small deflections out of the plane: turns w1, w3, way y; m1, m3, n2."""

    def rates(s: float, Y: np.ndarray) -> list[float]:
        u2, n1 = Y[1], -Nz * np.sin(Y[0])
        found = [u2, Nz * np.sin(Y[0])]
        for w1, w3, _, m1, m3, n2 in Y[2:].reshape(3, 6):
            k = m3 / B3
            found += [-u2 * w3, k + u2 * w1, -w1, -u2 * m3 + k * u2 + n2, u2 * m1, -k * n1]
        return found

    begin = np.concatenate([[-a, m0], np.eye(6)[3:].ravel()])
    end = solve_ivp(rates, (0, 1), begin, "DOP853", rtol=1e-11, atol=1e-13).y[2:, -1]
    return float(np.linalg.det(end.reshape(3, 6)[:, :3]))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["fold", "branch point"])
def test_double_points_where_loci_meet(kind: str) -> None:
    """The loci within the plane do not see B3; at one B3 each meets that of points across it."""
    if kind == "fold":
        near = (-89.2, np.deg2rad(36.844))
        bracket = (0.5, 0.65, 0.8)
        m0 = minimize_scalar(lambda m: -arch(m, near)[1], bracket=bracket, tol=1e-9).x
    else:
        near, angle = (-84.8, np.deg2rad(36.584)), np.deg2rad(36.5843542629)
        m0 = brentq(lambda m: arch(m, near)[1] - angle, 1.2, 1.45, xtol=1e-13)
    Nz, a = arch(m0, near)
    truth = brentq(lambda B3: across(m0, Nz, a, B3), 0.6, 0.72, xtol=1e-12)
    branch = Branch.of(Continuation(loads_scene(MIRROR.format(kind=kind))))
    (row,) = [row for row in branch.special if row["kind"] == "double point"]
    assert row["law.B3"] == pytest.approx(truth, abs=1e-6)
    assert abs(row["law.B3"] - truth) <= row["error"] * row["parameters.angle"] * 0.45 / 40
    assert row["parameters.angle"] == pytest.approx(np.rad2deg(a), abs=1e-7)
    assert branch.endings[1, 0].reached
