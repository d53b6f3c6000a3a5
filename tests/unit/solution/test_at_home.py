"""What Python shows of a solution and of what has many: a line, a table, a viewer."""

import re
import sys
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from fresh import loaded_by
from references import HALF_MOEBIUS

from ribbonopt import Batch, Branch, Continuation, loads_scene, prepare, solve
from ribbonopt.errors import ModelError, PackageError, ViewError
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
LONGEST = 300
BENT = """\
name: bent
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {P: 36}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {position: {x: 0}, force: {y: 0, z: -P}, d3: {x: 0}, d1: {y: 0}, moment: {d1: 0}}
guess: {force: [0, 0, -36], moment: [0, 0, 0]}
transcription: {type: collocation, degree: 6, intervals: 6}
continuation: {parameter: parameters.P, from: 36, to: 37, largest: 2}
"""


def test_a_solution_is_one_line_with_bars(solved: Solved) -> None:
    text = repr(solved("moebius_half"))
    assert text.startswith(
        "<Solution moebius-half: converged, verified; law sadowsky; n(0) = (0, 43.49"
    )
    for key, name in (("n0", "n"), ("m0", "m")):
        told = re.search(rf"\b{name}\(0\) = \((.*?)\) \+- ([-\de]+)", text)
        assert told
        for digits, truth in zip(told[1].split(", "), HALF_MOEBIUS[key], strict=True):
            rounded = 0.5 * 10.0 ** -len(digits.partition(".")[2]) if "." in digits else 0.0
            assert abs(float(digits) - truth) <= float(told[2]) + rounded


def test_what_is_not_solved_has_no_numbers() -> None:
    text = BENT.replace("0, 0, -36", "0, 0, 9").replace("x: 0}, force", "x: 0.3}, force")
    found = solve(loads_scene(f"{text}solver: {{type: newton, max_iterations: 1}}\n"))
    assert repr(found) == "<Solution bent: max iterations; law kirchhoff>"


def test_all_that_a_prompt_shows_is_short(solved: Solved) -> None:
    scene = loads_scene(BENT.replace("bent", "b" * 120))
    continuation = Continuation(scene)
    points = list(continuation)
    found = points[0].solution
    shown = [scene, found, solved("ribbon_si"), solved("moebius_half"), continuation]
    shown += [points[0], points, prepare(replace(scene, continuation=None))]
    shown += [Branch.of(continuation, points), Batch("b" * 120, 3, ["law.x"] * 90, [])]
    for thing in shown:
        text = repr(thing)
        assert len(text) <= LONGEST, text
        assert "\n" not in text and "object at" not in text
    assert repr(points[0]) == "<Point 0 of stage 0, branch 0: point, parameters.P = 36>"
    assert repr(continuation).endswith(": parameters.P from 36 to 37; 2 points so far>")
    assert repr(Continuation(scene)).endswith("; not begun>")


def test_a_name_that_would_act_on_a_terminal_is_only_seen() -> None:
    scene = replace(loads_scene(BENT), name="\x1b[2Jgone\n")
    assert repr(scene).startswith(r"<Scene \x1b[2Jgone\n: law kirchhoff")


@pytest.mark.parametrize("name", ["clamped_twist", "ribbon_si"])
def test_a_table_along_s_fits_itself(solved: Solved, name: str) -> None:
    """Its columns are of one ribbon: r' = d3, moments along directors, strains."""
    found = solved(name)
    table = found.to_pandas()
    start, end = found.scene.interval
    assert len(table) == 201 and (table.s.iloc[0], table.s.iloc[-1]) == (start, end)
    columns = {
        k: table[[f"{k}x", f"{k}y", f"{k}z"]].to_numpy() for k in ("d1", "d2", "d3", "n", "m")
    }
    r = table[["x", "y", "z"]].to_numpy()
    np.testing.assert_allclose(
        np.gradient(r, table.s, axis=0, edge_order=2), columns["d3"], atol=2e-2
    )
    for i in (1, 2, 3):
        for vector in ("n", "m"):
            along = np.sum(columns[vector] * columns[f"d{i}"], axis=1)
            largest = np.abs(columns[vector]).max()
            np.testing.assert_allclose(table[f"{vector}{i}"], along, atol=1e-12 * largest)
    bent = table[table.u2.abs() > 1e-3 * table.u2.abs().max()]
    np.testing.assert_allclose(bent.eta, bent.u3 / bent.u2, rtol=1e-9)
    np.testing.assert_allclose(table.loc[0, ["mx", "my", "mz"]].astype(float), found.m0, rtol=1e-12)


def test_units_of_columns_are_said(solved: Solved) -> None:
    si = solved("ribbon_si").to_pandas().attrs["units"]
    assert [si[name] for name in ("s", "x", "d1x", "u2", "eta", "nx", "m2", "energy")] == [
        *("m", "m", "1", "m^-1", "1", "N", "N m", "N")
    ]
    special = solved("moebius_half").to_pandas().attrs["units"]
    assert (special["u2"], special["nx"], special["m2"]) == ("L^-1", "(D w/L^2)", "(D w/L^2) L")


def test_rows_are_where_they_are_asked_for(solved: Solved) -> None:
    found = solved("moebius_half")
    asked = np.array([0.1, 0.4])
    table = found.to_pandas(asked)
    np.testing.assert_array_equal(table.s, asked)
    np.testing.assert_array_equal(table.u2, found.sample(asked, "u2"))
    assert len(found.to_pandas(0.25)) == 1 and len(found.to_pandas([])) == 0
    with pytest.raises(ValueError, match="arclengths are expected"):
        found.to_pandas([0.6])


def test_without_pandas_one_message_says_how_to_get_it(
    solved: Solved, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    for thing in (solved("moebius_half"), Batch("b", 0, [], [])):
        with pytest.raises(PackageError, match=r"pip install 'ribbonopt\[pandas\]'"):
            thing.to_pandas()


def test_nothing_is_loaded_for_what_is_not_asked() -> None:
    code = "import ribbonopt\nribbonopt.Solution, ribbonopt.Branch, ribbonopt.Batch, ribbonopt.load"
    assert not {"pandas", "matplotlib", "yaml.cyaml"} & loaded_by(code)


def test_a_notebook_shows_the_viewer_or_words(
    solved: Solved, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = solved("moebius_half")
    page = found._repr_html_()
    assert page is not None and page.startswith("<iframe") and "moebius-half" in page

    def nothing(_: object) -> str:
        raise ViewError("nothing to be seen")

    monkeypatch.setattr("ribbonopt.viewer.embedded", nothing)
    assert found._repr_html_() is None


def test_a_figure_of_each_kind_shows_what_it_says(solved: Solved) -> None:
    found = solved("moebius_half")
    lines = [line.get_ydata() for line in found.plot("strains").axes[0].lines]
    drawn = max(float(np.nanmax(np.abs(values))) for values in lines if len(values))
    s = np.linspace(*found.scene.interval, 2001)
    largest = max(np.abs(found.sample(s, name)).max() for name in ("u2", "u3"))
    assert drawn == pytest.approx(largest, rel=1e-3)
    assert found.plot().axes and found.plot("plane").axes
    with pytest.raises(ModelError, match="kind: found 'shape', expected one of ribbon"):
        found.plot("shape")
