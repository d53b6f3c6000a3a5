"""docs/theory.md: its numbers of the Moebius ribbon, and its laws as they stand there."""

import re
from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS, agrees

from ribbonopt import load_scene, solve

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8").replace("\N{MINUS SIGN}", "-")
NUMBER = r"-?\d+\.\d+"


def numbers(row: str, column: int) -> list[str]:
    """Numbers in a column of the table of the Moebius ribbon."""
    cells = next(line for line in TEXT.splitlines() if line.startswith(f"| {row} |")).split("|")
    return re.findall(NUMBER, cells[1 + column])


@pytest.mark.parametrize("column", [1, 2])
@pytest.mark.parametrize(
    ("row", "exact"),
    [
        (r"$\mathbf n(0)$", HALF_MOEBIUS["n0"][1:]),
        (r"$\mathbf m(0)$", HALF_MOEBIUS["m0"][1:]),
        ("$u_2(0)$", HALF_MOEBIUS["u0"][1:2]),
    ],
)
def test_numbers_of_the_moebius_ribbon(row: str, exact: tuple[float, ...], column: int) -> None:
    found = numbers(row, column)
    assert len(found) == len(exact)
    assert all(agrees(value, text) for value, text in zip(exact, found, strict=True))


def test_the_paper_rounds_its_invariant_the_wrong_way() -> None:
    (printed,), (right,) = numbers("$H$", 1), numbers("$H$", 2)
    assert agrees(HALF_MOEBIUS["H"], right)
    assert not agrees(HALF_MOEBIUS["H"], printed)
    assert numbers("energy of the whole band", 2) == [right]  # E = H L


@pytest.mark.parametrize("torsion", [1.2, -0.7, 2.3])
def test_the_inverse_of_sadowskys_law(torsion: float) -> None:
    # an exact helix has any u2, u3 with |eta| <= 1
    strains = [f"parameters={{curvature: 2.4, torsion: {torsion}}}", "guess=auto"]
    found = solve(load_scene(str(ROOT / "configs" / "helix.yaml"), strains))
    s = np.linspace(0.1, 0.9, 5)
    u2, u3, m2, m3 = (found.sample(s, name) for name in ("u2", "u3", "m2", "m3"))
    eta = u3 / u2
    M, mu = np.hypot(m2, m3), np.abs(m2)
    np.testing.assert_allclose(m2, u2 * (1 - eta**4), rtol=1e-9)
    np.testing.assert_allclose(m3, 2 * u3 * (1 + eta**2), rtol=1e-9)
    np.testing.assert_allclose(u2, np.sign(m2) * (M + mu) ** 2 / (4 * M), rtol=1e-9)
    np.testing.assert_allclose(u3, m3 * (M + mu) / (4 * M), rtol=1e-9)
    np.testing.assert_allclose(found.sample(s, "H - n3"), (mu + M) ** 2 / 8, rtol=1e-9)


def test_signs_as_drawn() -> None:
    """u2 turns the tangent towards d1, u3 turns d1 towards d2, and m' = n x d3."""
    found = solve(load_scene(str(ROOT / "configs" / "helix.yaml")))
    s, h = 0.4, 1e-5

    def rate(name: str) -> np.ndarray:
        return (found.sample(s + h, name) - found.sample(s - h, name)) / (2 * h)

    d1, d2, d3, n = (found.sample(s, name) for name in ("d1", "d2", "d3", "n"))
    assert rate("d3") @ d1 == pytest.approx(found.sample(s, "u2"), rel=1e-8)
    assert rate("d1") @ d2 == pytest.approx(found.sample(s, "u3"), rel=1e-8)
    np.testing.assert_allclose(np.cross(d1, d2), d3, atol=1e-12)
    np.testing.assert_allclose(rate("m"), np.cross(n, d3), atol=1e-7)


def test_what_acts_on_the_start_is_minus_n() -> None:
    # a cantilever pulled at its tip: n is the tip load all along, the clamp pulls back
    found = solve(load_scene(str(ROOT / "configs" / "cantilever.yaml")))
    tip = found.sample(1.0, "r")
    # moments about the clamp: what acts there, -m(0), balances the tip's force
    np.testing.assert_allclose(-found.m0 + np.cross(tip, found.sample(1.0, "n")), 0, atol=1e-9)
