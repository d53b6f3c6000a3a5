"""Formulas of s that are not finite, or widths that vanish, where no sample happens to be."""

import pytest

from ribbonopt.scene.checks.along import check_along, largest

PATH = ("width",)


@pytest.mark.parametrize(
    "formula",
    [
        "1/(s - 0.503)**2",
        "1/(s - 0.503) + 1000*s",
        "log(abs(s - 0.503))",
        "abs(s - 0.503)**-0.5",
        "tan(pi*s*1.01)",
        "1/sin(300*s + 0.1)",
    ],
)
def test_a_pole_between_samples_is_seen(formula: str) -> None:
    samples, problems = check_along({PATH: formula}, (0.0, 1.0), {})
    assert not samples
    (problem,) = problems
    assert "no finite real value at s = " in str(problem)


@pytest.mark.parametrize(
    "formula, most",
    [
        ("exp(-((s - 0.503)/0.002)**2)", 1.0),
        ("1/((s - 0.503)**2 + 1e-8)", 1e8),
        ("sin(30*s)", 1.0),
        ("exp(30*s)", 1.06864745815e13),
        ("abs(s - 0.503)", 0.503),
    ],
)
def test_the_largest_value_is_found_where_it_is_finite(formula: str, most: float) -> None:
    samples, problems = check_along({PATH: formula}, (0.0, 1.0), {})
    assert not problems
    assert abs(largest(samples)[PATH]) == pytest.approx(most, rel=1e-9)


@pytest.mark.parametrize("formula", ["(s - 0.503)**2", "abs(s - 0.503)"])
def test_the_least_value_is_found(formula: str) -> None:
    samples, _ = check_along({PATH: formula}, (0.0, 1.0), {})
    assert 0 <= min(samples[PATH]).value < 1e-14
