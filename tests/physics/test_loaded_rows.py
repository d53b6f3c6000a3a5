"""Published rows of loaded, curled and tapered ribbons and rods, found again independently.

What other tests compare with was found by other programs; here `tests/independent`, that shares
nothing with the package, confirms every digit printed.
"""

from collections.abc import Mapping

import loaded_truth
import numpy as np
import pytest
from independent.curved import Material, Natural
from loaded_plane import CANTILEVERS, HANGING, RINGS, SIDEWAYS, cantilever, hanging, sideways
from loaded_plane import pressed_ring as quarter
from loaded_rows import CLAMPS, INFLECTIONS, Row, between_clamps


def assert_as_printed(found: Mapping[str, float], known: Mapping[str, str]) -> None:
    """To one of the last digit, which may have been rounded either way."""
    for name, printed in known.items():
        unit = 10.0 ** -len(printed.partition(".")[2])
        assert found[name] == pytest.approx(float(printed), rel=0, abs=1.05 * unit), name


def names(row: Row) -> str:
    return row.name


@pytest.mark.slow
@pytest.mark.parametrize("row", CLAMPS, ids=names)
def test_between_clamps(row: Row) -> None:
    assert_as_printed(between_clamps(row), row.known)


@pytest.mark.slow
@pytest.mark.parametrize("row", INFLECTIONS, ids=names)
def test_with_a_jump(row: Row) -> None:
    assert_as_printed(between_clamps(row, switched=True), row.known)


@pytest.mark.slow
@pytest.mark.parametrize("row", CANTILEVERS, ids=names)
def test_cantilevers(row: Row) -> None:
    assert_as_printed(cantilever(row), row.known)


@pytest.mark.slow
def test_hanging() -> None:
    assert_as_printed(hanging(), HANGING.known)


@pytest.mark.slow
@pytest.mark.parametrize("pressure", RINGS)
def test_pressed_rings(pressure: float) -> None:
    known = RINGS[pressure]
    near = round(float(known["m2"]), 1), round(float(known["n3"]))
    assert_as_printed(quarter(pressure, near), known)


@pytest.mark.slow
@pytest.mark.parametrize("kind", SIDEWAYS)
def test_sideways(kind: str) -> None:
    """Buckled by as much as printed; and by little, from which the threshold follows."""
    assert_as_printed({kind: sideways(kind)}, {kind: SIDEWAYS[kind]})
    far, near, nearer = (sideways(kind, turned) for turned in (0.04, 0.02, 0.01))
    exact = {
        "weight": loaded_truth.heavy_ribbon_sideways,
        "tip": loaded_truth.loaded_ribbon_sideways,
    }[kind]()
    # In even powers of the amplitude.
    assert (64 * nearer - 20 * near + far) / 45 == pytest.approx(exact, rel=1e-8)


@pytest.mark.slow
def test_touching_ring() -> None:
    """The quarter, integrated under the pressure that a series gives, has no width left."""
    pressure, sharp, flat = loaded_truth.touching_ring()
    found = quarter(pressure, (25.0, -280.0))
    assert found["short"] == pytest.approx(0.0, abs=1e-11)
    assert found["m2"] == pytest.approx(2 * np.pi * sharp, abs=1e-9)
    assert found["m2 at the short axis"] == pytest.approx(2 * np.pi * flat, abs=1e-9)


def test_strains_of_curled_laws() -> None:
    """With Poisson's ratio, and with all three natural strains."""
    m, s = np.array([[0.0], [1.0], [2.0]]), np.zeros(1)
    for k, u, legendre in (
        ((2.5, 0.0, 0.0, 0.3), (3.459373996368, 1.124932428780), 4.191015603883),
        ((2.5, 0.8, -0.4, 0.3), (3.426951175540, 1.448954866780), 4.806128202438),
    ):
        strain, energy = Material("sadowsky", natural=Natural(*k)).strains(1, m, s)
        np.testing.assert_allclose(strain[1:, 0], u, rtol=0, atol=6e-13)
        assert (m * strain).sum() - energy[0] == pytest.approx(legendre, rel=0, abs=6e-13)


def test_smooth_laws_end_in_the_sharp_one() -> None:
    """Delta to zero: Sadowsky's law by its eigenvectors."""
    natural = Natural(2.5, 0.8, -0.4, 0.3)
    m, s = np.array([[0.0], [1.0], [2.0]]), np.zeros(1)
    sharp = Material("sadowsky", natural=natural).strains(1, m, s)[0]
    smooth = Material("variational", 1e-8, natural=natural).strains(1, m, s)[0]
    np.testing.assert_allclose(smooth, sharp, rtol=0, atol=1e-13)


def test_thresholds_are_those_printed() -> None:
    printed = {
        loaded_truth.heavy_column(): "7.83734743894",
        loaded_truth.heavy_ribbon_sideways(): "21.49065961",
        loaded_truth.heavy_rod_sideways(): "12.85376332",
        loaded_truth.loaded_ribbon_sideways(): "6.72934725",
        loaded_truth.loaded_rod_sideways(): "4.01259934",
        loaded_truth.curled_ring(): "7.0000000",
        loaded_truth.curled_ring(0.3): "2.5000000",
        loaded_truth.curled_ring(0.0, 3, 4): "0.125",
        loaded_truth.curled_rod_ring(2 / 1.3): "5.61538462",
        loaded_truth.twisted_ring(): "10.8827961854",
        loaded_truth.twisted_ring(0.8): "13.6034952318",
        loaded_truth.clamped_torque(): "8.9868189",
        loaded_truth.pressed_ring(): "3.000000000000",
        loaded_truth.touching_ring()[0]: "5.2468869625",
    }
    for value, number in printed.items():
        assert_as_printed({"": value}, {"": number})
