"""docs/exports.md: its Python is one program that runs, its tables are what files hold."""

import csv
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ribbonopt.exports.formats import FORMATS
from ribbonopt.exports.quantities import ROWS
from ribbonopt.scene.units import Units

PAGE = (Path(__file__).parents[2] / "docs" / "exports.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)


def table(first: str) -> list[list[str]]:
    """Return the cells of the rows of a table that begins with a heading."""
    _, _, rest = PAGE.partition(f"| {first} |")
    lines = rest.split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What the first block leaves behind, and its folder."""
    folder = tmp_path_factory.mktemp("page")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        found: dict[str, Any] = {"folder": folder}
        exec(compile(BLOCKS[0], "docs/exports.md", "exec"), found)
    return found


def test_the_other_blocks_run(
    program: dict[str, Any], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        import pandas  # noqa: F401
        import pyvista  # noqa: F401
    except ImportError as error:
        pytest.skip(f"what the page uses is not here: {error}")
    monkeypatch.chdir(program["folder"])
    assert len(BLOCKS) == 3
    for block in BLOCKS[1:]:
        exec(compile(block, "docs/exports.md", "exec"), program)
    found, printed = program["solution"], capsys.readouterr().out
    largest = np.abs(found.outputs(program["rows"]["s"].to_numpy())["m2"]).max()
    assert f"{largest}"[:8] in printed and "Dw/L" in printed
    assert program["arrows"].n_points > 0
    force = program["loads"].loc["boundary.end", ["Fx", "Fy", "Fz"]].to_numpy(float)
    np.testing.assert_allclose(force, found.at_nodes["n"][-1], rtol=1e-12)


def test_formats_are_those_there_are() -> None:
    rows = table("`--format`")
    assert [row[0].strip("`") for row in rows] == list(FORMATS)


def test_files_are_those_that_are_written(program: dict[str, Any]) -> None:
    for row in table("`--format`"):
        kind, files = row[0].strip("`"), re.findall("`(.*?)`", row[1])
        if kind in ("glb", "csv", "npz", "json"):
            found = {path.name for path in (program["folder"] / "files").iterdir()}
            assert {file.replace("NAME", "strip") for file in files} <= found
    assert {path.name for path in program["folder"].glob("*.vtp")} == {
        "strip.vtp",
        "strip-line.vtp",
    }


def test_columns_are_those_of_the_files(program: dict[str, Any]) -> None:
    rows, loads = (part for part in _tables_of_columns())
    files = program["folder"] / "files"
    for name, part in (("strip.csv", rows), ("strip-loads.csv", loads)):
        with open(files / name, encoding="utf-8", newline="") as file:
            columns = next(csv.reader(file))
        assert {column for row in part for column in re.findall("`(.*?)`", row[0])} == set(columns)
    told = json.loads((files / "strip-columns.json").read_text())
    for part, units in ((rows, told["columns"]), (loads, told["loads"])):
        for row in part:
            for column in re.findall("`(.*?)`", row[0]):
                assert row[3] == units[column].get("unit", ""), column


def test_units_are_told_in_si_too() -> None:
    rows, _ = _tables_of_columns()
    told = {c: row[2] for row in rows for c in re.findall("`(.*?)`", row[0])}
    for quantity in ROWS:
        for column in quantity.columns:
            assert told[column].split()[0] == quantity.unit(Units(si=True)).split()[0], column


def _tables_of_columns() -> tuple[list[list[str]], list[list[str]]]:
    first, second = (part.split("\n\n")[0] for part in PAGE.split("| columns |")[1:])
    return _cells(first), _cells(second)


def _cells(text: str) -> list[list[str]]:
    lines = text.splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_options_are_those_of_the_command() -> None:
    from ribbonopt.cli.arguments import parser

    options = [re.findall("`(--[a-z-]+)", row[0])[0] for row in table("option")]
    given = {f"{option}=1" if option != "--piece" else option for option in options}
    found = vars(parser(["export"]).parse_args(["export", "result", *sorted(given)]))
    names = {option[2:].replace("-", "_") for option in options}
    assert set(found) == {"verb", "result", "format", *names}
