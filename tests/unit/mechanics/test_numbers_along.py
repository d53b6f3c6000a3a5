"""Numbers along the ribbon as expressions: values, integrals, what they depend on."""

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import CubicSpline

from ribbonopt.mechanics.along import Field
from ribbonopt.scene import Table
from ribbonopt.scene.along import Along, scaled

KNOTS, VALUES = (-0.2, 0.1, 0.3, 0.6, 1.1, 1.6), (1.0, 0.4, 0.7, -0.3, 0.2, 2.0)
SPLINE = CubicSpline(KNOTS, VALUES)
K, START = 0.7, 0.2
CASES = {
    "number": (1.5, lambda s: 1.5),
    "parameter": ("sin(k)/2", lambda s: np.sin(K) / 2),
    "line": ("1 - k*s", lambda s: 1 - K * s),
    "quintic": (
        "s + (1 - k*s)**3*s*(s - 2)/3",
        lambda s: (1 - K * s) ** 3 * (s - 2) * s / 3 + s,
    ),
    "table": (Table(KNOTS, VALUES), lambda s: float(SPLINE(s))),
}
UNIT, LENGTH = 3.0, 0.8
PLACES = np.array([0.2, 0.3, 0.45, 0.6, 1.1, 1.2])  # some are knots


def theta_of(field: Field) -> dict[str, float]:
    return {"parameters.k": K, "interval.start": START, **field.numbers()}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("special", [False, True])
def test_values_and_integrals_are_those_of_numpy_and_quadrature(case: str, special: bool) -> None:
    value: Along
    value, plain = CASES[case]
    unit, length = (UNIT, LENGTH) if special else (1.0, 1.0)
    field = Field("loads.force.z", scaled(value, unit, length))
    theta = theta_of(field)

    def expected(s: float) -> float:
        return float(plain(s * length)) / unit

    np.testing.assert_allclose(field.sampled(PLACES, theta), [*map(expected, PLACES)], rtol=1e-14)
    s = ca.SX.sym("s")
    total = ca.Function("total", [s], [field.total(s, lambda name: ca.SX(theta[name]))])
    for end in PLACES:
        knots = [k / length for k in KNOTS if START < k / length < end] or None
        integral = quad(expected, START, end, points=knots, epsabs=1e-14)[0]
        assert float(total(end)) == pytest.approx(integral, abs=2e-14)


def test_derivatives_along_a_table_are_those_of_the_spline_at_its_rows_too() -> None:
    s = ca.SX.sym("s")
    value = Field("width", Table(KNOTS, VALUES)).at(s, ca.SX.sym)
    slope = ca.Function("slope", [s], [ca.jacobian(value, s)])
    for place in (*KNOTS, 0.5):
        assert float(slope(place)) == pytest.approx(float(SPLINE(place, 1)), abs=1e-13)


@pytest.mark.parametrize("text", ["1/s", "abs(s - 0.5)", "s**0.5", "2**s", "cos(s)", "s**13"])
def test_what_is_no_polynomial_has_no_closed_integral(text: str) -> None:
    field = Field("width", text)
    assert field.total(ca.SX.sym("s"), ca.SX.sym) is None
    assert not field.uniform


def test_numbers_are_parameters_and_texts_and_tables_are_structure() -> None:
    assert Field("width", 0.5).numbers() == {"width": 0.5}
    assert Field("width", 0.5).structure == Field("width", 0.7).structure
    assert Field("width", "1 - k*s").numbers() == {}
    assert Field("width", "1 - k*s").structure != Field("width", "1 - s").structure
    table, other = Table(KNOTS, VALUES), Table(KNOTS, (*VALUES[:-1], 1.0))
    assert Field("width", table).structure != Field("width", other).structure
    scales = [Field("width", scaled("1 - k*s", 1.0, length)) for length in (2.0, 3.0)]
    assert scales[0].structure == scales[1].structure
    assert scales[0].numbers() == {"width.unit": 1.0, "width.length": 2.0}
    assert Field("width", "1 - k").uniform and not Field("width", table).uniform
