"""Numbers along the ribbon in scenes: formulas of s, tables, files; what of them is refused."""

from pathlib import Path

import numpy as np
import pytest
from half_scene import SCENE, refusal
from scipy.interpolate import CubicSpline

from ribbonopt.scene import Scaled, Table, dump_scene, load_scene, loads_scene, validate_scene
from ribbonopt.scene.cubics import Cubics
from ribbonopt.scene.lens import fault_of, paths_of, with_value
from ribbonopt.scene.units import in_special_units

ROWS = "{s: [0, 0.2, 0.5], values: [1, 2, 1.5]}"


@pytest.mark.parametrize("width", ["0.5", "'1 - turn*s**2'", ROWS])
def test_a_scene_with_one_is_written_and_read_again(width: str) -> None:
    scene = loads_scene(SCENE + f"width: {width}")
    assert scene.width is not None
    assert loads_scene(dump_scene(scene)) == scene == validate_scene(scene)


@pytest.mark.parametrize(
    ("text", "column"),
    [
        ("0, 1\n0.2, 2\n\n0.5, 1.5 # wide\n", ""),
        ("# of the tip\ns, weight\n0, 1\n0.2, 2\n0.5, 1.5\n", ""),
        ("s old new\n0 7 1\n0.2\t8  2\n 0.5 9 1.5", ", column: new"),
    ],
)
def test_a_file_is_read_from_the_folder_of_the_scene(
    tmp_path: Path, text: str, column: str
) -> None:
    (tmp_path / "rows.txt").write_text(text)
    (tmp_path / "s.yaml").write_text(SCENE + f"width: {{file: rows.txt{column}}}")
    scene = load_scene(tmp_path / "s.yaml")
    assert scene.width == Table((0.0, 0.2, 0.5), (1.0, 2.0, 1.5))
    assert loads_scene(dump_scene(scene)) == scene  # without the file


@pytest.mark.parametrize(
    ("text", "rest", "found"),
    [
        (None, "", "no such file"),
        ("0, 1\n0.5, nan\n", "", "line 2: expected 2 numbers"),
        ("0, 1\n0.5\n", "", "line 2: expected 2 numbers"),
        ("0, 1, 2\n0.5, 1, 3\n", "", "has 3 columns, expected two, s and value; of more, name one"),
        ("0, 1, 2\n0.5, 1, 3\n", ", column: old", "names no columns"),
        ("s, new, b\n0.5, 1, 3\n", ", column: old", "has no column old after its first"),
        ("\n".join(f"{i / 400}, 1" for i in range(401)), "", "has 401 rows, expected at most 200"),
        ("", "", "expected from 2 to 200 rows"),
        (
            "s, w\n0, 1\n0.4, 1",
            "",
            "covers s from 0 to 0.4, expected all of the interval",
        ),
    ],
)
def test_what_is_wrong_with_a_file_is_told_and_nothing_of_it_quoted(
    tmp_path: Path, text: str | None, rest: str, found: str
) -> None:
    path = tmp_path / "rows.txt"
    if text is not None:
        path.write_text(text)
    told = refusal(SCENE + f"width: {{file: '{path}'{rest}}}")
    assert "s.yaml, line 15, width." in told and found in told
    assert "nan" not in told and "new" not in told


@pytest.mark.parametrize(
    ("width", "found"),
    [
        ("1 - q*s", "unknown name 'q'; known are turn, s"),
        ("1/(s - 0.25)", "has no finite real value at s = 0.25, expected one from 0 to 0.5"),
        ("sqrt(0.4 - s)", "has no finite real value at s = 0.405, expected"),
        ("1e29**s*1e29**s*1e20", "has no finite real value at s = "),
        ("[1, s, 2]", "found a vector, expected a scalar"),
        ("1 - 3*s", "width: found -0.5, at s = 0.5, expected a width > 0 all along"),
        ("exp(-40*s)", "found 2.06115e-09, at s = 0.5, expected at least 1e-06 of the largest"),
        ("2000*s + 1", "found 1001, expected at most 1000 in size"),
        (-1.0, "width: found -1, expected a width > 0 all along"),
        ([1.0, 0.5], "a formula or a mapping with keys s, values, or file, column"),
        ({"s": [0, 0.5], "values": [1, 2, 3]}, "width.values: found 3, expected as many values"),
        ({"s": [0], "values": [1]}, "width.s: found 1, expected from 2 to 200 rows"),
        ({"s": [0, 0.3, 0.3, 0.5], "values": [1, 1, 1, 1]}, "width.s.2: found 0.3, expected incr"),
        ({"s": [0.1, 0.5], "values": [1, 1]}, "width.s: covers s from 0.1 to 0.5, expected all"),
        # Between its rows the curve is below zero.
        ({"s": [0, 0.1, 0.4, 0.5], "values": [1, 0.01, 0.01, 1]}, "expected a width > 0 all"),
        ({"s": [0, 0.5], "value": [1, 1]}, "width.value: unknown key; did you mean 'values'?"),
        ({"file": "a", "s": [0, 1]}, "width.file: cannot stand beside s, values"),
    ],
)
def test_what_is_no_number_all_along_is_refused(width: object, found: str) -> None:
    assert found in refusal(SCENE + f"width: {width!r}")


def test_a_parameter_s_is_refused_only_beside_a_formula_of_s() -> None:
    with_s = SCENE.replace("{turn: .5}", "{turn: .5, s: 1}")
    assert loads_scene(with_s + "width: 0.5").parameters["s"] == 1
    assert "parameters.s: is the arclength" in refusal(with_s + "width: 1 - turn")


def test_numbers_are_continued_and_tables_are_not() -> None:
    scene = loads_scene(SCENE + "width: 0.5")
    assert with_value(scene, "width", 0.7).width == 0.7 and "width" in paths_of(scene)
    tabled = loads_scene(SCENE + f"width: {ROWS}")
    assert not [path for path in paths_of(tabled) if path.startswith("width")]
    for path in ("width", "width.values.1"):
        assert "is a table, which is not continued; write a formula" in fault_of(tabled, path)
    formula = loads_scene(SCENE + "width: 1 - turn*s")
    assert "parameters.turn: continue that instead" in fault_of(formula, "width")
    assert "has no value: width is not given" in fault_of(loads_scene(SCENE), "width")


def test_in_other_units_a_formula_stands_with_its_units() -> None:
    ribbon = "{length: 0.5, width: 0.01, thickness: 1e-3, youngs_modulus: 1e9, poisson_ratio: 0}"
    scene = loads_scene(SCENE + f"ribbon: {ribbon}\nwidth: 1 - turn*s")
    special = in_special_units(scene)
    assert special.width == Scaled("1 - turn*s", 1.0, 0.5)
    assert in_special_units(special) is special


def test_the_curve_through_a_table_is_the_spline_of_scipy() -> None:
    generator = np.random.default_rng(1)
    s, values = np.cumsum(0.1 + generator.random(9)), generator.normal(size=9)
    known, found = CubicSpline(s, values), Cubics.through(Table(tuple(s), tuple(values)))
    places = np.linspace(s[0] - 0.1, s[-1] + 0.1, 50)
    np.testing.assert_allclose(found.at(places), known(places), atol=1e-13)
