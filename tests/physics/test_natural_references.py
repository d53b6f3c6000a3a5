"""Natural curvature: the tables of two programs that share no equations, by several formulations.

Clamp C: far end at (0.68, 0.15, 0.31), turned by the vector (0, 2.4, 0.6). Clamp S: at
(0.3, 0.06, 0.9), turned by (0, -0.6, 0.5); T = m2 + K11 + K22 changes its sign once along it.
Order-8 shooting, and collocation of the energy alone. Numbers as printed, each with its bar.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.checks.stability import negative_directions, second_variation
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import (
    Boundary,
    Collocation,
    Directors,
    End,
    Kirchhoff,
    Natural,
    RotationVector,
    Sadowsky,
    Scene,
    SingleSheet,
    Variational,
)
from ribbonopt.scene.laws import Law
from ribbonopt.solution.solution import Solution

Triple = tuple[float, float, float]
C = ((0.68, 0.15, 0.31), (0.0, 2.4, 0.6))
S = ((0.3, 0.06, 0.9), (0.0, -0.6, 0.5))
DIGITS = 6e-11  # ten are printed


def clamp(ends: tuple[Triple, Triple], natural: Natural | None, law: Law | None = None) -> Scene:
    position, vector = ends
    start = End(support="clamped", position=(0.0, 0.0, 0.0), directors="identity")
    end = End(support="clamped", position=position, directors=RotationVector(vector))
    return Scene(
        name="clamp",
        law=law or Sadowsky(),
        boundary=Boundary(start=start, end=end),
        natural=natural,
        transcription=Collocation(intervals=20),
        tolerance=1e-11,
    )


@dataclass(frozen=True)
class Row:
    """A row of the table: loads at the start, strains in the middle, energy, invariant."""

    natural: Natural
    n0: Triple
    m0: Triple
    middle: tuple[float, float]
    W: float
    H: float | None


ROWS = {
    "1.5": Row(
        Natural(1.5),
        (-3.7045691120, -3.8045322158, -1.8701054982),
        (3.0607903669, 0.2439408333, -0.0886255948),
        (2.6176130580, 0.8427802639),
        0.824306719058,
        -1.4724776923,
    ),
    "1.5, nu": Row(
        Natural(1.5, poisson_ratio=0.3),
        (-3.6721204048, -3.4891829129, -1.7818003105),
        (2.6445203912, 0.2477201173, -0.1065043345),
        (2.6205174929, 0.8382196768),
        0.759813203481,
        -1.3757223975,
    ),
    "4": Row(
        Natural(4.0),
        (-3.5899534785, -2.0094843653, -1.3788404009),
        (2.8142120362, -2.2507412979, -0.0612802946),
        (2.6179860331, 0.8468437020),
        1.661396462699,
        -7.8479487227,
    ),
    "1 + 3 s, nu": Row(
        Natural("1 + 3*s", poisson_ratio=0.3),
        (-2.2794713616, -1.6175967627, -4.7475980576),
        (1.8206504040, 0.5674784918, 0.1018224728),
        (2.6292099179, 0.8270796529),
        0.574101987347,
        None,
    ),
}
each_row = pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)


def verified(scene: Scene) -> Solution:
    found = solve(scene)
    assert found.verified, found.message
    return found


def agrees(found: Solution, row: Row, more: float = 0.0) -> None:
    """Compare to the digits printed and `more`."""
    np.testing.assert_allclose(found.n0, row.n0, atol=DIGITS + more)
    np.testing.assert_allclose(found.m0, row.m0, atol=DIGITS + more)
    np.testing.assert_allclose(found.sample(0.5, "u")[1:], row.middle, atol=DIGITS + more)
    assert found.energy == pytest.approx(row.W, abs=6e-13 + more)
    if row.H is not None:
        assert found.at_nodes["H"][0] == pytest.approx(row.H, abs=DIGITS + more)


@each_row
def test_rows_from_nothing(row: Row) -> None:
    """The inverted form, its bars, and what it conserves."""
    found = verified(clamp(C, row.natural))
    agrees(found, row)
    bars = estimate_error(found)
    assert np.abs(found.n0 - row.n0).max() <= bars["n0"] + DIGITS
    assert np.abs(found.m0 - row.m0).max() <= bars["m0"] + DIGITS
    assert abs(found.energy - row.W) <= bars["energy"] + 6e-13
    assert max(bars.values()) < 1e-8
    drift = found.verification.drift
    assert drift["n_dot_m"] < 1e-13
    # H' = k11' (u2 (1 + nu eta^2) - k11): of a curvature that varies H is no invariant.
    assert drift["H"] < 1e-12 if row.H is not None else np.isnan(drift["H"])
    assert negative_directions(found) == 0


@each_row
@pytest.mark.parametrize("formulation", ["algebraic", "differentiated", "energy"])
def test_rows_by_other_formulations(row: Row, formulation: str) -> None:
    scene = replace(clamp(C, row.natural), formulation=formulation, tolerance=None)
    found = verified(scene)
    agrees(found, row, more=2e-11 if formulation != "energy" else 5e-9)


def test_one_sheet_has_the_same_numbers() -> None:
    row = ROWS["1.5, nu"]
    agrees(verified(clamp(C, row.natural, SingleSheet(chi=1))), row)


@pytest.mark.parametrize(("name", "within"), [("1.5, nu", 5e-4), ("1 + 3 s, nu", 5e-4)])
def test_smooth_law_is_near(name: str, within: float) -> None:
    row, apart = ROWS[name], []
    for delta in (0.01, 0.003):
        found = verified(clamp(C, row.natural, Variational(delta=delta)))
        apart.append(abs(found.energy - row.W))
    assert apart[0] < within
    assert apart[1] < 0.2 * apart[0]


@dataclass(frozen=True)
class Jump:
    """A row of the table of one switch."""

    natural: Natural | None
    n0: Triple
    m0: Triple
    switch: float
    leap: float
    W: float


JUMPS = {
    "0": Jump(
        None,
        (16.8669462259, 10.1262292991, 21.2015089038),
        (-12.6192283011, 1.5751389102, 5.9469006056),
        0.42758397060,
        0.5765587387,
        3.916012637747,
    ),
    "0.6": Jump(
        Natural(0.6),
        (16.8879031617, 10.0693088718, 21.2151084119),
        (-12.4948410008, 0.9806797511, 5.9405252136),
        0.42791806584,
        0.5745882791,
        4.458500088088,
    ),
}


@pytest.mark.parametrize("jump", JUMPS.values(), ids=JUMPS)
def test_switch_where_T_is_zero(jump: Jump) -> None:
    """Both sides of the switch, where it is, and that the energy is a minimum."""
    found = verified(clamp(S, jump.natural))
    assert found.sheets == (1, -1)
    np.testing.assert_allclose(found.n0, jump.n0, atol=DIGITS)
    np.testing.assert_allclose(found.m0, jump.m0, atol=DIGITS)
    assert found.energy == pytest.approx(jump.W, abs=6e-13)
    (s,) = found.switch_points
    assert s == pytest.approx(jump.switch, abs=6e-12)
    for side, sign in ((-1e-12, 1), (1e-12, -1)):
        _, u2, u3 = found.sample(float(s) + side, "u")
        assert (u2, u3) == (
            pytest.approx(sign * jump.leap, abs=1e-9),
            pytest.approx(-jump.leap, abs=1e-9),
        )
    assert negative_directions(found) == 0


def test_switch_leaps_unevenly_with_curvature_across() -> None:
    """At T = 0 u2 goes from (D + R)/4 to (D - R)/4, and the limit of smooth laws is the answer."""
    natural = Natural(1.0, 0.5, 0.7, 0.3)
    found = verified(clamp(S, natural))
    assert found.sheets == (1, -1)
    (s,) = found.switch_points
    K22, c = 0.7 + 0.3, found.sample(float(s), "m3") + 2 * 0.7 * 0.5
    R = np.hypot(2 * K22, c)
    sides = [found.sample(float(s) + off, "u2") for off in (-1e-12, 1e-12)]
    np.testing.assert_allclose(sides, [(-2 * K22 + R) / 4, (-2 * K22 - R) / 4], atol=1e-9)
    assert found.sample(float(s), "u3") == pytest.approx(c / 4, abs=1e-9)
    energies = [
        verified(replace(clamp(S, natural, Variational(delta=d)), tolerance=1e-9)).energy
        for d in (3e-3, 1e-3)
    ]
    assert 0 < found.energy - energies[1] < 0.2 * (found.energy - energies[0]) < 1e-4
    variation = second_variation(found)
    assert not isinstance(variation, str), variation
    assert variation.negative == 0


def test_mirror_image_and_any_frame() -> None:
    """Mirrored in y the twist changes sign; turned as a whole nothing changes but the frame."""
    natural = Natural(1.5, 0.6, 0.4, 0.3)
    plain = verified(clamp(C, natural))
    mirrored = replace(natural, twist=-0.6)
    image = verified(clamp(((0.68, -0.15, 0.31), (0.0, 2.4, -0.6)), mirrored))
    np.testing.assert_allclose(image.n0, plain.n0 * (1, -1, 1), atol=1e-9)
    np.testing.assert_allclose(image.m0, plain.m0 * (-1, 1, -1), atol=1e-9)
    assert image.energy == pytest.approx(plain.energy, abs=1e-12)


def test_from_the_other_end() -> None:
    """Seen from its end the ribbon has the same curvatures, and what varies runs backwards."""
    plain = verified(clamp(C, Natural("1 + 3*s", poisson_ratio=0.3)))
    end = plain.outputs(np.array([1.0]))
    frame = np.stack([end[d][0] for d in ("d1", "d2", "d3")], axis=1)
    turn = np.diag([1.0, -1.0, -1.0])  # d1 stays, so that the curvature keeps its sign
    scene = clamp(C, Natural("1 + 3*(1 - s)", poisson_ratio=0.3))
    ends = replace(
        scene.boundary,
        start=replace(scene.boundary.start, position=tuple(map(float, end["r"][0]))),
    )
    first, last = frame @ turn, turn
    named = [{f"d{i + 1}": tuple(map(float, m[:, i])) for i in (0, 1)} for m in (first, last)]
    back = replace(
        scene,
        boundary=replace(
            ends,
            start=replace(ends.start, directors=Directors(**named[0])),
            end=End(support="clamped", position=(0.0, 0.0, 0.0), directors=Directors(**named[1])),
        ),
    )
    found = verified(back)
    assert found.energy == pytest.approx(plain.energy, abs=1e-11)
    np.testing.assert_allclose(found.n0, -plain.n0, atol=1e-8)


@pytest.mark.parametrize(
    "law", [Sadowsky(), Variational(delta=0.05), Kirchhoff()], ids=lambda v: v.type
)
def test_helices_are_equilibria(law: Law) -> None:
    """n = mu' u, m = mu' d3 + mu u with mu = m2 / u2, mu' = m3 - m2 u3 / u2: constant strains."""
    u = np.array([0.0, 2.0, 0.7])
    natural = Natural(1.2, 0.3) if law.type == "kirchhoff" else Natural(1.2, 0.3, 0.2, 0.3)
    size = float(np.linalg.norm(u))
    axis = u / size
    turned = np.array([[0, -axis[2], axis[1]], [axis[2], 0, 0], [-axis[1], 0, 0]])
    integral = np.eye(3) + (1 - np.cos(size)) / size * turned
    integral = integral + (1 - np.sin(size) / size) * turned @ turned
    vector = (float(u[0]), float(u[1]), float(u[2]))
    x, y, z = (float(v) for v in integral[:, 2])
    found = verified(clamp(((x, y, z), vector), natural, law))
    strains = found.at_nodes["u"]
    np.testing.assert_allclose(strains, np.tile(u, (len(strains), 1)), atol=1e-7)
    start = found.start
    m2, m3 = start["m"][1], start["m"][2]
    mu, rate = m2 / u[1], m3 - m2 * u[2] / u[1]
    np.testing.assert_allclose(start["n"], rate * u, atol=1e-7)
    np.testing.assert_allclose(start["m"], rate * np.eye(3)[2] + mu * u, atol=1e-7)
