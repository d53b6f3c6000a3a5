"""The numbers beside the figures of the paper, against the references and closed forms."""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from mpmath import mp
from references import HALF_MOEBIUS, REGULARIZED, agrees

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
import paper_figures
from paper import figure2, figure3, figure4, figure5
from paper.found import Found, half_of
from paper.numbers import Number, Table, write_numbers
from paper.page import Panel

#: Wunderlich's ribbon, w/L = 0.2/pi: two programs that share nothing with this one
WUNDERLICH = {
    "n_y(0)": "43.38497675",
    "n_z(0)": "45.15374415",
    "m_y(0)": "1.47704983",
    "m_z(0)": "-10.12256023",
    "u_2(0)": "3.39288726",
    "H": "62.281451",
    "energy of the whole": "59.6772048",
}


@pytest.fixture(scope="module")
def found() -> Found:
    return Found()


def by_name(panels: Sequence[Panel]) -> dict[str, Number]:
    """Numbers by their names without dollars."""
    return {row.name.replace("$", ""): row for panel in panels for row in panel.rows}


def bounded(number: Number, exact: float) -> None:
    """Assert that the bar of a number holds, and that it is small."""
    assert number.bar is not None
    assert abs(number.value - exact) <= number.bar + 4e-15 * abs(exact)
    assert number.bar < 1e-7 * abs(exact)


def test_figure_2_has_both_solutions_of_the_law() -> None:
    for u in figure2.both():
        eta = u[1] / u[0]
        # (2.4), (2.5)
        np.testing.assert_allclose(u[0] * (1 - eta**4), figure2.EXAMPLE[0], rtol=1e-14)
        np.testing.assert_allclose(2 * u[1] * (1 + eta**2), figure2.EXAMPLE[1], rtol=1e-14)
    assert figure2.worst_round_trip() < 1e-13


def test_figure_3_has_circles_for_levels_and_the_hull_of_two() -> None:
    assert figure3.worst_level() < 1e-12
    u2, u3 = figure3.level(2.0, 1, np.linspace(-1.5, 1.5, 50))
    np.testing.assert_allclose((u2 - 1) ** 2 + u3**2, 1, rtol=1e-13)
    where, least = figure3.least_at_twist(0.7)
    assert where == pytest.approx(0.7, rel=1e-4)
    assert least == pytest.approx(2 * 0.7**2, rel=1e-8)


def test_figure_4_has_the_numbers_of_the_references(found: Found) -> None:
    rows = by_name(figure4.panels(found))
    for name, exact in (
        ("n_y(0)", HALF_MOEBIUS["n0"][1]),
        ("n_z(0)", HALF_MOEBIUS["n0"][2]),
        ("m_y(0)", HALF_MOEBIUS["m0"][1]),
        ("m_z(0)", HALF_MOEBIUS["m0"][2]),
        ("u_2(0)", HALF_MOEBIUS["u0"][1]),
        ("x(1/2)", HALF_MOEBIUS["x_end"]),
        ("H", HALF_MOEBIUS["H"]),
        ("energy of the whole", HALF_MOEBIUS["H"]),
    ):
        bounded(rows[name], exact)
    assert agrees(rows["u_3(1/2)"].value, "4.934876749")
    assert agrees(rows["twist of the whole, turns"].value, "0.323311779125")


def test_figure_4_is_as_the_paper_prints_it_but_for_one_number(found: Found) -> None:
    rows = [*by_name(figure4.panels(found)).values(), *by_name(figure5.panels(found)).values()]
    printed = [row for row in rows if row.paper]
    assert len(printed) == 14
    assert [row.name for row in printed if row.as_printed != row.paper] == ["$H$"]


def test_figure_5_has_the_numbers_of_the_references(found: Found) -> None:
    rows = by_name(figure5.panels(found))
    exact = REGULARIZED[1e-2]
    for group in ("n0", "m0"):
        for axis, value in zip("yz", exact[group][1:], strict=True):
            bounded(rows[f"{group[0]}_{axis}(0)"], value)
    bounded(rows["u_2(0)"], exact["u2"][0])
    bounded(rows[r"at \varepsilon = 10^{-2}"], exact["u2"][0])
    bounded(rows[r"at \varepsilon = 10^{-3}"], REGULARIZED[1e-3]["u2"][0])
    assert rows[r"order in \varepsilon"].value == pytest.approx(1, abs=0.01)
    for name, digits in WUNDERLICH.items():
        assert agrees(rows[f"Wunderlich: {name}"].value, digits)


def test_the_mirrored_half_is_the_other_half(found: Found) -> None:
    rest = half_of(found.regularized).mirrored()
    for name in ("u2", "u3", "m2", "m3"):
        direct = found.regularized.sample(rest.s, name)
        np.testing.assert_allclose(getattr(rest, name), direct, atol=1e-7)


def test_the_regularised_ribbon_enters_where_its_law_says(found: Found) -> None:
    with mp.workdps(30):
        # a = m2/m3: 2 a = 1 - lambda + epsilon where u2 = u3; and 2 a sqrt(lambda) = 1 - lambda
        root = mp.findroot(lambda r: (1 - r**2) / r - (1 - r**2 + mp.mpf("0.01")), (0.9, 0.95))
        ratio = float((1 - root**2) / root / 2)
    assert figure5.border() == pytest.approx(ratio, rel=1e-10)
    s = figure5.entry(found.regularized)
    m2, m3 = (float(found.regularized.sample(s, name)) for name in ("m2", "m3"))
    assert m2 / m3 == pytest.approx(ratio, rel=1e-8)


@pytest.mark.parametrize(
    ("value", "bar", "written"),
    [
        (57.4495031138, 3e-10, "57.4495031 ± 3e-10"),
        (57.4495031138, 3e-3, "57.45 ± 3e-03"),
        (-8.9, 0.4, "-9 ± 4e-01"),
        (1e-12, 1e-9, "0 ± 1e-09"),
        (0.48, None, "0.48"),
    ],
)
def test_digits_are_those_that_the_bar_leaves(value: float, bar: float, written: str) -> None:
    assert Number("", value, "", bar).written == written


def test_numbers_are_written_twice(tmp_path: Path) -> None:
    table = Table("figure4", "c", [Number("$H$", 57.4495, "57.5", 1e-4)])
    write_numbers([table], tmp_path)
    row = json.loads((tmp_path / "numbers.json").read_text(encoding="utf-8"))[0]
    assert (row["name"], row["value"], row["rounded"]) == ("H", 57.4495, "57.4")
    lines = (tmp_path / "numbers.csv").read_text(encoding="utf-8").splitlines()
    assert lines[1] == "figure4,c,H,57.4495,0.0001,57.5,57.4"


@pytest.mark.slow
def test_all_is_drawn_and_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["paper_figures.py", "--out", str(tmp_path / "new")])
    paper_figures.main()
    pictures = {f"figure{i}{suffix}" for i in (2, 3, 4, 5) for suffix in (".png", ".pdf")}
    tables = {f"{name}.csv" for name in ("figure4", "figure5", "numbers", "misprints")}
    written = {path.name for path in (tmp_path / "new").iterdir()}
    assert written == pictures | tables | {"numbers.json", "misprints.json"}
    curve = np.genfromtxt(tmp_path / "new" / "figure4.csv", delimiter=",", names=True)
    # (2.4), (2.5) along all of it
    eta = curve["u3"] / curve["u2"]
    np.testing.assert_allclose(curve["u2"] * (1 - eta**4), curve["m2"], atol=1e-7)
    np.testing.assert_allclose(2 * curve["u3"] * (1 + eta**2), curve["m3"], atol=1e-7)
