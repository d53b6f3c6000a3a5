"""Wide ribbons by means of its own: the law, energies and loads, numbers of equilibria.

None of this is about the package: `test_wide_confirmed.py` compares with it.
"""

from dataclasses import replace

import numpy as np
import pytest
from independent.curved import Natural
from independent.inplane import InPlane
from independent.joining import clamped, closed
from independent.joints import Joints
from independent.wide import ETA, M, N, P, Wide, phi_of, xi_of
from independent.wide_starts import polished
from mpmath import mp, mpf
from wide_numbers import BENT, CLAMPS, HALVES, IDENTITY, ORIGIN, Known

Array = np.ndarray


@pytest.mark.parametrize("exponent", [-9, -3, -0.5, -0.3907, -0.3906, 0, 2, 12, 40, 250])
def test_the_inverse_of_g(exponent: float) -> None:
    """To rounding, with its slope, where series and exponentials take turns too."""
    G, one = np.array([10.0**exponent]), np.ones(1) + 0j
    h = 1e-20 * G
    found = xi_of(G + 1j * h, one, one)
    with mp.workdps(40):
        x = mpf(found.real[0])

        def logarithm(x: mpf) -> mpf:
            return mp.log((mp.sinh(2 * x) - 2 * x) / (4 * x * x))

        exact = mp.findroot(lambda x: logarithm(x) - mp.log(mpf(G[0])), x)
        slope = 1 / mp.diff(logarithm, exact)
        assert abs(x / exact - 1) < 2e-15
        assert found.imag[0] / h[0] * G[0] == pytest.approx(float(slope), rel=1e-13)
        assert phi_of(found.real)[0] == pytest.approx(float(x * mp.coth(x)), rel=1e-15)
    assert xi_of(-G + 0j, one, one).real == pytest.approx(-found.real, rel=1e-15)


@pytest.mark.parametrize(
    "ribbon",
    [
        Wide(0.1),
        Wide(0.1, Natural(1.5, 0.4, -0.3, 0.3)),
        Wide(0.1, Natural(1.5, 0.4, -0.3, 0.3), inplane=InPlane(20.0, 900.0)),
    ],
    ids=["straight", "curled", "curled and soft"],
)
def test_loads_are_what_the_energy_changes_by(ribbon: Wide) -> None:
    """The force at the end is the energy over the way, which no sign of the law survives."""

    def met(place: Array, start: Joints) -> Joints:
        conditions = clamped((ORIGIN, place), (IDENTITY, BENT[1]), (True, False))
        return closed(replace(start, law=ribbon), conditions)

    place, h, way = BENT[0], 3e-4, np.array([0.36, -0.48, 0.8])
    start = replace(CLAMPS["C, one straight"], width=0.1).start()
    found = met(place, met(place, start))
    energies = [met(place + i * h * way, found).energy for i in (-2, -1, 1, 2)]
    change = (energies[0] - 8 * energies[1] + 8 * energies[2] - energies[3]) / (12 * h)
    assert change == pytest.approx(found.y[N, -1] @ way, abs=2e-9)
    H = ribbon.hamiltonian(found.y, found.s)
    assert H == pytest.approx(H[0], abs=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("name", CLAMPS)
def test_clamps(name: str) -> None:
    """From the ribbon without width; two meshes agree to more digits than are told."""
    known = CLAMPS[name]
    fine, coarse = polished(known.start(), known.conditions)
    agree(fine, known)
    assert fine.energy == pytest.approx(coarse.energy, rel=1e-13)


@pytest.mark.slow
def test_half_bands() -> None:
    """Each from the one before, the narrowest from the ribbon without width."""
    before = None
    for known in HALVES.values():
        found, _ = polished(known.start(before), known.conditions)
        agree(found, known)
        before = found.at


def agree(found: Joints, known: Known) -> None:
    """Compare with numbers that are known to about eleven digits."""
    near = {"rel": 3e-11, "abs": 1e-11}
    assert found.y[N, 0] == pytest.approx(known.n0, **near)
    assert found.y[M, 0] == pytest.approx(known.m0, **near)
    assert found.energy == pytest.approx(known.energy, **near)
    H = found.law.hamiltonian(found.y, found.s)
    assert H == pytest.approx(known.H, rel=1e-10)
    for place, (s, eta, p) in zip(found.ends[1:-1], known.inflections, strict=True):
        at = int(np.abs(found.s - s).argmin())
        assert (place, *found.y[[ETA, P], at]) == pytest.approx((s, eta, p), abs=1e-11)
