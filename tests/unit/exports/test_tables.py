"""Tables for colleagues: rows along s, what acts and reacts, and what every column means."""

import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.arrays import Array
from ribbonopt.exports.quantities import ROWS
from ribbonopt.exports.writing import export
from ribbonopt.scene.quantities import QUANTITIES
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
FORCE = ("Fx", "Fy", "Fz")


def read(path: Path) -> tuple[list[str], list[dict[str, str]]]:
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file)
        return list(rows.fieldnames or ()), list(rows)


def column(rows: list[dict[str, str]], *names: str) -> Array:
    return np.array([[float(row[name]) for name in names] for row in rows]).squeeze()


@pytest.fixture
def tables(solved: Solved, tmp_path: Path) -> Callable[[str], Path]:
    def made(name: str) -> Path:
        paths = export(solved(name), tmp_path / f"{name}.csv", complete=False)
        assert [path.name for path in paths] == [
            f"{name}.csv",
            f"{name}-loads.csv",
            f"{name}-columns.json",
        ]
        return tmp_path / name

    return made


def test_rows_are_the_solution(solved: Solved, tables: Callable[[str], Path]) -> None:
    solution = solved("ribbon_si")
    names, rows = read(tables("ribbon_si").with_suffix(".csv"))
    told = solution.outputs(column(rows, "s"))
    for name in ("u1", "u2", "u3", "energy", "n1", "n3", "m2", "m3"):
        size = np.abs(told[name]).max() or 1.0
        np.testing.assert_allclose(column(rows, name), told[name], atol=1e-9 * size)
    np.testing.assert_allclose(column(rows, "x", "y", "z"), told["r"], atol=1e-12)
    for name in ("n", "m", "d1", "d2", "d3"):
        components = column(rows, *(f"{name}{axis}" for axis in "xyz"))
        size = np.abs(told[name]).max()
        np.testing.assert_allclose(components, told[name], atol=1e-12 * size)
    assert names[0] == "s" and len(set(names)) == len(names)
    assert all(name.isidentifier() for name in names)
    # A sum over the rows is the energy in joules, known by the scheme's own quadrature.
    energy, s = column(rows, "energy"), column(rows, "s")
    assert np.diff(s) @ (energy[1:] + energy[:-1]) / 2 == pytest.approx(solution.energy, rel=1e-3)


def test_every_column_has_a_meaning_and_a_unit(tables: Callable[[str], Path]) -> None:
    stem = tables("ribbon_si")
    told = json.loads(stem.with_name(f"{stem.name}-columns.json").read_text())
    assert set(told["columns"]) == set(read(stem.with_suffix(".csv"))[0])
    assert set(told["loads"]) == set(read(stem.with_name(f"{stem.name}-loads.csv"))[0])
    assert all(column["means"] for column in told["columns"].values())
    units = {name: column["unit"] for name, column in told["columns"].items()}
    assert (units["x"], units["u2"], units["nx"], units["m3"]) == ("m", "1/m", "N", "N m")
    assert (units["d1x"], units["eta"], units["energy"]) == ("1", "1", "N")  # J/m
    assert told["about"]["units"].startswith("SI")


def test_units_are_those_of_the_dimensions() -> None:
    for quantity in ROWS:
        if quantity.name in QUANTITIES:
            known = QUANTITIES[quantity.name]
            assert (quantity.length, quantity.force) == (known.length, known.force)
            assert quantity.vector == (known.shape == "vector")


@pytest.mark.parametrize("name", ["heavy_cantilever", "three_supports", "hanging_film"])
def test_forces_add_up_to_nothing(tables: Callable[[str], Path], name: str) -> None:
    stem = tables(name)
    _, rows = read(stem.with_name(f"{stem.name}-loads.csv"))
    forces = column(rows, *FORCE)
    assert np.abs(forces).max() > 0
    np.testing.assert_allclose(forces.sum(axis=0), 0, atol=1e-6 * np.abs(forces).max())
    assert {row["kind"] for row in rows} >= {"reaction", "along"}


def test_weights_are_what_was_asked_for(tables: Callable[[str], Path]) -> None:
    stem = tables("heavy_cantilever")
    _, rows = read(stem.with_name(f"{stem.name}-loads.csv"))
    (along,) = [row for row in rows if row["kind"] == "along"]
    assert column([along], *FORCE) == pytest.approx([-5, 0, 0], abs=1e-9)
    assert along["s"] == ""
    (start,) = [row for row in rows if row["name"] == "boundary.start"]
    assert column([start], *FORCE) == pytest.approx([5, 0, 0], abs=1e-8)


def test_what_has_no_value_has_no_column(solved: Solved, tmp_path: Path) -> None:
    from dataclasses import replace

    from ribbonopt.exports.carried import Carried
    from ribbonopt.exports.colours import Colours
    from ribbonopt.exports.formats import FORMATS
    from ribbonopt.views.shape import shape_of

    shape = shape_of(solved("helix"))
    shape = replace(shape, energy=np.full(len(shape.s), np.nan))
    carried = Carried(shape, solved("helix"), "helix", Colours("energy", 0.0))
    for kind in FORMATS:
        for ending, content in FORMATS[kind].write(carried).items():
            (tmp_path / f"helix{ending}").write_bytes(content)
    assert "energy" not in read(tmp_path / "helix.csv")[0]
    assert "energy" not in json.loads((tmp_path / "helix.json").read_text())["rows"]
    assert b'"energy"' not in (tmp_path / "helix.vtp").read_bytes()
    assert np.isnan(np.load(tmp_path / "helix.npz")["energy"]).all()
