"""Extensible ribbons and those of Sano and Wada by means of their own: numbers of law and clamp."""

import numpy as np
import pytest
from independent.curved import Material
from independent.loaded import Strip, rotated, state
from independent.plates import Plate, extensible, of_boundary_layers, sano
from independent.shooting import Shooting, held
from mpmath import mp, mpf

Array = np.ndarray
RIBEXT = Plate(1.0, 0.91, 1.4, 0.3)
PLACE, FRAME = np.array([0.68, 0.15, 0.31]), rotated((0.0, 2.4, 0.6))


@pytest.mark.parametrize(
    ("plate", "m", "u"),
    [
        (RIBEXT, (1, 1), (1.098030734467, 0.7130575632455)),
        (RIBEXT, (5, 8), (5.342645185769, 5.342104726819)),
        (RIBEXT, (20, 60), (23.64211743235, 24.7056947196)),
        (RIBEXT, (1, 150), (31.02010994026, 43.19145545676)),
        (sano(1, 2, 10), (1, 1), (1.029917823346, 0.4271908942926)),
        (sano(1, 2, 10), (3, 5), (3.343257530074, 1.893331144929)),
        (sano(1, 2, 10), (0.1, 2), (0.5436546590726, 0.5253866215936)),
    ],
)
def test_strains(plate: Plate, m: tuple[float, float], u: tuple[float, float]) -> None:
    """Numbers by mpmath."""
    found = plate.strains(*(np.array([x, -x]) for x in m))
    assert np.transpose(found)[0] == pytest.approx(u, rel=1e-12)
    assert np.transpose(found)[1] == pytest.approx([-x for x in u], rel=1e-12)


@pytest.mark.parametrize("plate", [RIBEXT, sano(0.91, 1.4, 0.4), extensible(0.05, 0.002, -0.4)])
def test_there_and_back(plate: Plate) -> None:
    """Random moments from small to large; no nearby strains have less energy in all."""
    rng = np.random.default_rng(3)
    m = rng.choice([-1, 1], (2, 400)) * 10 ** rng.uniform(-3, 3, (2, 400)) * plate.unit
    a, b = (u / plate.unit for u in plate.strains(*m))
    gap = np.stack(plate.slope(a, b)) * plate.unit - m
    assert (np.abs(gap) < 1e-13 * np.hypot(*m)).all()

    def total(a: Array, b: Array) -> Array:
        return plate.energy(a, b) - (m[0] * a + m[1] * b) / plate.unit

    least, size = total(a, b), np.hypot(a, b)
    for angle in np.linspace(0, 2 * np.pi, 17):
        for far in (1e-2, 0.3, 2.0):
            moved = total(a + far * size * np.cos(angle), b + far * size * np.sin(angle))
            assert (moved > least).all()


@pytest.mark.parametrize("a", [1e-3, 1.0, 30.0, 39.99, 40.01, 300.0])
def test_the_function_of_the_boundary_layers(a: float) -> None:
    with mp.workdps(40):
        s = mp.sqrt(mpf(a) / 2)
        quotient = (mp.cosh(s) - mp.cos(s)) / (s * (mp.sinh(s) + mp.sin(s)))
        exact = (mpf(1) / 2 - quotient) / s**4
    assert of_boundary_layers(np.array([a]))[0] == pytest.approx(float(exact), rel=3e-15)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("plate", "n0", "m0", "energy"),
    [
        (
            extensible(1 / 20, 1 / 400, 0.3),
            (-3.2860898525, -3.7762068058, -1.7395962384),
            (2.2251158402, 1.6110355251, -0.0653687590),
            2.965209684562,
        ),
        (
            sano(0.91, 1.4, (0.91 / 60) ** 0.5),
            (-3.1206294185, -3.6549489996, -1.6639824222),
            (2.1445705467, 1.6038417010, -0.0598930611),
            2.934277990548,
        ),
    ],
    ids=["extensible", "sano"],
)
def test_the_bent_clamp(
    plate: Plate, n0: tuple[float, ...], m0: tuple[float, ...], energy: float
) -> None:
    """Of width L / 20 and thickness w / 20; the first row is that of two more methods."""
    strip = Strip(Material("plate", plate=plate))

    def end(y: Array) -> Array:
        start = state(np.zeros((3, y.shape[1])), np.eye(3)[:, :, None] + 0 * y[0], y[:3], y[3:])
        return strip.piece(start, 0.0, 1.0, 1, 1e-13)

    near = np.round([*n0, *m0], 2)
    found = Shooting(lambda y: held(end(y), PLACE, FRAME)).solve(near)
    assert found == pytest.approx([*n0, *m0], abs=2e-10)
    assert end(found[:, None])[18, 0] == pytest.approx(energy, rel=1e-12)


@pytest.mark.parametrize("plate", [RIBEXT, sano(1.0, 2.0, 10.0)], ids=["extensible", "sano"])
def test_a_mixture_stays_one(plate: Plate) -> None:
    """Beyond convexity u2 leaps where m2 = 0; arcs of both sides keep m2 = 0, and H."""
    m1, m3, n2 = 0.4, 150.0 if plate is RIBEXT else 2.0, 0.7
    strip, s = Strip(Material("plate", plate=plate)), np.zeros(1)
    u2, u3 = (u[0] for u in plate.strains(np.array([1e-200]), np.array([m3])))
    assert u2 > 0.1
    frame = rotated((0.3, -0.4, 0.7))
    n = frame.T @ [-m1 * u3, n2, 20.0]
    start = state(np.zeros(3), frame, n, frame.T @ [m1, 0.0, m3])
    far = 0.3 / u3
    end = strip.piece(start, 0.0, far, 0, 1e-12)
    assert abs(strip.turn(end, s + far)[0]) < 1e-10 * m3
    assert np.abs(end[3:12] - start[3:12]).max() > 0.1
    H = [strip.energy(y, 0, s)[1, 0] for y in (start, end)]
    assert H[1] == pytest.approx(H[0], rel=1e-10)
