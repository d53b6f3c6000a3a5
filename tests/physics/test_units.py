"""The same ribbon in SI and in units Dw = L = 1: the same numbers, to rounding, wherever."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.errors import ConvergenceError
from ribbonopt.output.report import report
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.check import check_scene
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.scene.units import in_special_units, units_of
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.comparison.compare import compare
from ribbonopt.views.subject import subject_of

# D = 2.4e9 x 1e-12 / (12 x 0.75) = 8e-4 / 3 N m and L = 0.25 m: D w / L^2 = F N, D w / L = M N m.
L = 0.25
RIBBON = (
    f"ribbon: {{length: {L}, width: 0.01, thickness: 1e-4, youngs_modulus: 2.4e9, "
    "poisson_ratio: 0.5}\n"
)
F = 8e-4 / 3 * 0.01 / L**2
M = F * L
UNITS = {"L": L, "F": F, "M": M, "1/L": 1 / L, "F/L": F / L}
MESH = "transcription: {type: collocation, scheme: gauss, degree: 6, intervals: 12}\n"
SADOWSKY = "law: {type: sadowsky}\n"
MOEBIUS = """interval: [0, <0.5 L>]
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}, moment: {d1: 0}}
  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}
guess: {force: [0, <40 F>, <40 F>], moment: [0, <2 M>, <-9 M>]}
"""
CLAMPED = "boundary:\n  start: {support: clamped, position: [0, 0, 0], directors: identity}\n"
BUCKLED = "guess: {force: [0, 0, <-45 F>], moment: [0, <6.5 M>, 0]}\n"
#: numbers with dimensions in angle brackets
SCENES = {
    "moebius": SADOWSKY + MOEBIUS,
    "moebius, full states": SADOWSKY + "states: full\n" + MOEBIUS,
    "moebius, algebraic": SADOWSKY + "formulation: algebraic\n" + MOEBIUS,
    "moebius, energy": "law: {type: variational, delta: 0.1}\nformulation: energy\n" + MOEBIUS,
    "moebius, shooting": "law: {type: single_sheet, chi: 1}\n"
    "transcription: {type: shooting, scheme: rk8, steps: 4, intervals: 5}\n" + MOEBIUS,
    "moebius, phases": SADOWSKY
    + "interval: [0, <1 L>]\nboundary: {loop: {half_twists: 1}}\nswitching: [<0.5 L>]\n"
    + "guess: {moebius: {half_twists: 1}}\n",
    "moebius, rod": "law: {type: kirchhoff, B2: 1, B3: 1.5}\n" + MOEBIUS,
    "loaded, from strains": SADOWSKY
    + """interval: [<3 L>, <4 L>]
boundary:
  start: {position: [<5 L>, 0, 0], directors: identity}
  end: {force: [<1 F>, 0, 0], moment: [0, <0.5 M>, 0]}
guess: {strains: [<1 1/L>, 0]}
""",
    "formulas": SADOWSKY
    + "interval: [0, <1 L>]\nparameters: {shortening: 0.25, whole: <1 L>}\n"
    + CLAMPED
    + "  end: {position: [0, 0, whole * (1 - shortening)], directors: identity}\n"
    + BUCKLED,
    "sliding": SADOWSKY
    + "interval: [0, <1 L>]\n"
    + CLAMPED
    + """  end:
    support: sliding
    position: [0, 0, <1 L>]
    along: [0, 0, 3]
    directors: identity
    force: {z: <-45.2259556678 F>}
"""
    + BUCKLED,
    "held by a string": SADOWSKY
    + """interval: [0, <1 L>]
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: held, distance: <0.8 L>}
guess: {arc: 2}
""",
}
#: each leads to the clamped elastica shortened by a quarter
EQUATIONS = {
    "length": "norm(r(end)) = <0.75 L>",
    "length of unknown dimension": "2 * dot(r(end), ez) / <1.5 L> - 1 = 0",
    "area": "dot(r(end), r(end)) = <0.75 L>**2",
    "force": "dot(n, ez) = <-45.2259556678 F>",
    "spring": "n3(end) = -stiffness * (whole - dot(r(end), ez))",
    "work": "dot(n(end), r(end)) = <-33.91946675085 M>",
    "strain": "u2(start) = <6.61180050 1/L>",
}


def both(text: str) -> tuple[Scene, Scene]:
    """Return a scene in SI and in special units."""
    text += "" if "transcription" in text else MESH
    number = re.compile("<(.+?) (.+?)>")
    si = number.sub(lambda found: repr(float(found[1]) * UNITS[found[2]]), text)
    special = number.sub(lambda found: found[1], text)
    return loads_scene("name: si\n" + RIBBON + si), loads_scene("name: special\n" + special)


def with_equation(name: str) -> tuple[Scene, Scene]:
    """Return the clamped elastica whose shortening follows from an equation."""
    return both(
        SADOWSKY
        + "interval: [0, <1 L>]\nparameters: {whole: <1 L>, stiffness: <180.9038226712 F/L>}\n"
        + CLAMPED
        + "  end: {position: {x: 0, y: 0}, directors: identity}\n"
        + f"  also: ['{EQUATIONS[name]}']\n"
        + BUCKLED
    )


def assert_same(si: Solution, special: Solution, rtol: float = 1e-11) -> None:
    """Assert that two solutions are the same ribbon in the units of this file."""
    assert si.verified, si.message
    assert special.verified, special.message
    scales = {"r": L, "n": F, "m": M, "u": 1 / L, "d1": 1, "energy": F, "H": F, "eta": 1, "m2": M}
    scales |= {"n_dot_m": F * M, "n3": F, "u3": 1 / L}
    fraction = np.linspace(0, 1, 31)
    (a, b), (c, d) = si.scene.interval, special.scene.interval
    ours = si.outputs(a + (b - a) * fraction)
    theirs = special.outputs(c + (d - c) * fraction)
    for name, scale in scales.items():
        atol = rtol * np.abs(theirs[name]).max() + 1e-13
        np.testing.assert_allclose(ours[name] / scale, theirs[name], rtol=0, atol=atol)
    np.testing.assert_allclose(si.nodes / L, special.nodes, rtol=1e-14)
    np.testing.assert_allclose(si.n0 / F, special.n0, atol=rtol * np.abs(special.n0).max())
    np.testing.assert_allclose(si.m0 / M, special.m0, atol=rtol * np.abs(special.m0).max())
    assert si.energy / M == pytest.approx(special.energy, rel=rtol)
    assert si.twist == pytest.approx(special.twist, rel=rtol, abs=1e-13)


@pytest.mark.parametrize("name", SCENES)
def test_si_and_special_units_are_the_same_ribbon(name: str) -> None:
    si, special = both(SCENES[name])
    # Two minimisations agree as well as the energy's own conditions.
    assert_same(solve(si), solve(special), 1e-8 if "energy" in name else 1e-11)


@pytest.mark.parametrize("name", EQUATIONS)
def test_equations_are_in_si(name: str) -> None:
    si, special = with_equation(name)
    ours, theirs = solve(si), solve(special)
    assert_same(ours, theirs, 1e-9)
    assert ours.sample(L, "dot(r, ez)") / L == pytest.approx(0.75, rel=1e-7)
    # What is solved is scaled, so that tolerances and iterations are.
    assert ours.iterations == theirs.iterations
    assert {n for n in Posed.of(si).theta if "units." in n} == {
        "parameters.units.length",
        "parameters.units.force",
    }


def test_scenes_without_equations_have_the_parameters_that_they_had() -> None:
    si, special = both(SCENES["moebius"])
    assert list(Posed.of(si).theta) == list(Posed.of(special).theta)
    assert si.parameters == in_special_units(si).parameters


def test_truth_by_hand() -> None:
    found = solve(both(SCENES["moebius"])[0])
    assert units_of(found.scene).force == pytest.approx(F, rel=1e-15)
    np.testing.assert_allclose(found.n0, [0, 43.4964080174 * F, 42.0522517130 * F], rtol=1e-11)
    np.testing.assert_allclose(found.m0[1:], [2.00545099623 * M, -8.86920396210 * M], rtol=1e-11)
    assert found.sample(L / 2, "dot(r, ex)") == pytest.approx(0.212697811153 * L, rel=1e-11)
    assert float(found.start["H"]) == pytest.approx(57.4495031138 * F, rel=1e-11)


def test_numbers_are_those_of_the_special_units() -> None:
    posed = Posed.of(both(SCENES["moebius"])[0])
    assert posed.theta["interval.end"] == pytest.approx(0.5)
    assert posed.given.interval[1] == pytest.approx(L / 2)
    assert posed.units == units_of(posed.given)


def test_errors_and_summary_are_in_si() -> None:
    si, special = (solve(scene) for scene in both(SCENES["moebius"]))
    ours, theirs = estimate_error(si), estimate_error(special)
    units = {"n0": F, "m0": M, "u0": 1 / L, "H0": F, "energy": M, "states": 1.0}
    for name, unit in units.items():
        # They are rounding of the residuals by a tenth or so.
        assert ours[name] / unit == pytest.approx(theirs[name], rel=0.2), name
    summary = summarize(si)
    assert summary["units"] == "SI (m, N, N m, J)"
    assert summary["length"] == L / 2
    assert summary["warnings"] == []
    assert summarize(special)["units"] == "Dw = L = 1"
    assert summarize(special)["warnings"] == []
    for name in ("worst_condition", "residual_between_nodes", "law_residual"):
        assert summary[name] == pytest.approx(summarize(special)[name], rel=1e-3, abs=1e-14)
    text = report(summary)
    assert "units SI (m, N, N m, J)" in text
    # Of small numbers no digit is lost.
    assert f"{43.4964080174 * F:.15f}"[:13] in text
    assert f"{-8.86920396210 * M:.15e}"[:11] in text


def test_results_on_disk_are_in_si_and_come_back(tmp_path: Path) -> None:
    si, special = both(SCENES["moebius"])
    found, expected = solve(si), solve(special)
    save_solution(found, tmp_path)
    with np.load(tmp_path / "solution.npz") as data:
        rows = expected.outputs(data["s"] / L)
        for name, unit in {"r": L, "d2": 1, "n": F, "m": M, "u": 1 / L}.items():
            atol = 1e-11 * np.abs(rows[name]).max()
            np.testing.assert_allclose(data[name] / unit, rows[name], rtol=0, atol=atol)
    assert json.loads((tmp_path / "summary.json").read_text())["energy"] == found.energy
    loaded = load_solution(tmp_path)
    assert loaded.scene == found.scene
    s = np.linspace(0, L / 2, 7)
    for name in ("r", "n", "m", "u", "H", "energy"):
        np.testing.assert_array_equal(loaded.sample(s, name), found.sample(s, name))
    # In whatever units a guess was found, it is one for any scene.
    for scene in (si, special):
        again = solve(replace(scene, guess=loads_scene(_saved(tmp_path)).guess))
        assert again.iterations < found.iterations
    np.testing.assert_allclose(again.n0, expected.n0, rtol=1e-10, atol=1e-10)


def _saved(folder: Path) -> str:
    return f"name: a\nlaw: {{type: sadowsky}}\nboundary: {{}}\nguess: {{solution: {folder}}}\n"


def test_equations_come_back_from_disk(tmp_path: Path) -> None:
    si, _ = with_equation("length")
    found = solve(si)
    save_solution(found, tmp_path)
    loaded = load_solution(tmp_path)
    assert loaded.scene.parameters == si.parameters
    np.testing.assert_array_equal(loaded.n0, found.n0)


def test_what_is_built_serves_other_materials_and_other_units() -> None:
    si, special = both(SCENES["moebius"])
    prepared = prepare(si)
    expected = prepared.solve()
    thicker = replace(si, ribbon=replace(si.ribbon, thickness=2e-4))
    found = prepared.solve(thicker, guess=expected)
    np.testing.assert_allclose(found.n0, 8 * expected.n0, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(found.u0, expected.u0, rtol=1e-11, atol=1e-9)
    assert_same(expected, prepared.solve(special))


def test_scenes_are_checked_in_si() -> None:
    si, special = both(SCENES["moebius"])
    ours, theirs = check_scene(si), check_scene(special)
    assert ours | {"name": ""} == theirs | {"name": ""}
    far, _ = both(SCENES["formulas"])
    with pytest.raises(ConvergenceError, match=r"0\.3 apart.*0\.25 long"):
        check_scene(replace(far, parameters={"shortening": -0.2, "whole": L}))


def test_comparisons_measure_the_same_relative_errors() -> None:
    rows = [
        compare(scene, ["inverted"], ["gauss"], [1e-6]).rows[0] for scene in both(SCENES["moebius"])
    ]
    ours, theirs = rows
    for name in ("error_n0", "error_m0", "error_u", "drift_invariant", "estimate"):
        assert getattr(ours, name) == pytest.approx(getattr(theirs, name), rel=1e-4), name
    assert ours.drift_law < 1e-12


def test_figures_are_in_metres_and_as_wide_as_the_ribbon() -> None:
    from ribbonopt.views.plane import draw_plane
    from ribbonopt.views.ribbon import draw_ribbon
    from ribbonopt.views.strains import draw_strains

    si, special = (subject_of(solve(scene), True) for scene in both(SCENES["moebius"]))
    assert si.half_width == 0.005
    assert si.end == L
    shown = {draw: [_texts(draw(s)) for s in (si, special)] for draw in (draw_plane, draw_strains)}
    for ours, theirs in shown.values():
        assert "[1/m]" in ours
        assert "SI units" in ours
        assert "[" not in theirs
        assert "Dw = L = 1" in theirs
    assert "half-width 0.005 m, the ribbon's own" in _texts(draw_ribbon(si))
    assert "half-width 0.01 m along" in _texts(draw_ribbon(si, 0.01))
    assert "half-width 0.05 along" in _texts(draw_ribbon(special))


def _texts(figure: object) -> str:
    from matplotlib.text import Text

    return "\n".join(text.get_text() for text in figure.findobj(Text))
