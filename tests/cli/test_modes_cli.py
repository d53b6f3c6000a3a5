"""The verb `modes`: of a scene or of what was saved; what it tells, writes and refuses."""

import csv
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from branches import COLUMN, SHORT

Run = Callable[..., Any]
#: a straight strip, clamped and free: only bending about d2 has a frequency without inertia
STRIP = """\
name: strip
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free}
transcription: {type: collocation, scheme: gauss, degree: 6, intervals: 10}
"""
BEAM = (3.51601526850, 22.0344915647, 61.6972144136)  # cos a cosh a = -1, omega = a^2
FILES = {"modes.csv", "modes.json", "modes.npz"}
RESULT = {"scene.yaml", "solution.npz", "summary.json"}


@pytest.fixture
def strip(tmp_path: Path) -> str:
    (tmp_path / "strip.yaml").write_text(STRIP)
    return "strip.yaml"


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from ribbonopt.cli import main

    folder = tmp_path_factory.mktemp("saved")
    (folder / "strip.yaml").write_text(STRIP)
    (folder / "column.yaml").write_text(COLUMN + SHORT)
    for verb, name in (("solve", "strip"), ("continue", "column")):
        words = [verb, str(folder / f"{name}.yaml"), "--out", str(folder / name), "--quiet"]
        assert main(words) == 0
    return folder


def table(text: str) -> list[list[str]]:
    """Return number, frequency and error of the rows that were told."""
    rows = [line.split()[:3] for line in text.splitlines()]
    return [row for row in rows if row and row[0].isdigit()]


def test_a_scene_in_one_command(run: Run, strip: str) -> None:
    status, out, err = run("modes", strip, "--count", 3)
    assert (status, err) == (0, "")
    assert out.splitlines()[0].startswith("strip: 3 modes of small vibrations")
    assert "sqrt(Dw/(rho L^4))" in out.splitlines()[0]
    for (number, value, error), truth, i in zip(table(out), BEAM, (1, 2, 3), strict=True):
        assert int(number) == i
        # As many digits as the bar leaves, and the truth within it and the last digit.
        last = 10.0 ** -len(value.partition(".")[2])
        assert abs(float(value) - truth) <= float(error) * truth + 0.51 * last
        assert last < 100 * float(error) * truth
    assert "symmetric" not in out  # one end is held
    assert sorted(path.name for path in Path().iterdir()) == ["strip.yaml"]


def test_as_json_and_files_beside_the_solution(run: Run, strip: str) -> None:
    status, out, err = run("modes", strip, "--count", 2, "--json", "--out", "new/one")
    assert (status, err) == (0, "")
    told = json.loads(out)
    place = Path("new/one")
    assert {path.name for path in place.iterdir()} == FILES | RESULT
    assert json.loads((place / "modes.json").read_text()) == told
    assert (told["name"], told["verified"], told["negative"]) == ("strip", True, 0)
    for mode, truth in zip(told["modes"], BEAM, strict=False):
        assert mode["frequency"] == pytest.approx(truth, rel=mode["error"])
        assert mode["squared"] == pytest.approx(mode["frequency"] ** 2)
        assert mode["grows"] is False
    with (place / "modes.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["frequency"]) for row in rows] == [m["frequency"] for m in told["modes"]]
    found = np.load(place / "modes.npz")
    # The shape of the cantilever: all along d1 = x, largest displacement one.
    s, moved = found["s"], found["displacement"][0]
    a = BEAM[0] ** 0.5
    k = (np.cosh(a) + np.cos(a)) / (np.sinh(a) + np.sin(a))
    beam = np.cosh(a * s) - np.cos(a * s) - k * (np.sinh(a * s) - np.sin(a * s))
    beam /= np.abs(beam).max()
    assert np.abs(np.abs(moved[:, 0]) - np.abs(beam)).max() < 1e-4
    assert np.abs(moved[:, 1:]).max() < 1e-9


def test_a_saved_result_has_its_modes_beside_it(run: Run, saved: Path) -> None:
    shutil.copytree(saved / "strip", "here")
    before = run("modes", "here", "--count", 3, "--json").out
    assert {path.name for path in Path("here").iterdir()} == FILES | RESULT
    after = run("modes", "here/summary.json", "--count", 3, "--json").out  # any file of it
    assert json.loads(before) == json.loads(after)
    # Nor do they stay beside another solution.
    assert run("solve", saved / "strip.yaml", "--out", "here", "--quiet") == (0, "", "")
    assert {path.name for path in Path("here").iterdir()} == RESULT


@pytest.mark.slow
def test_modes_of_a_result_are_drawn_with_it(run: Run, saved: Path) -> None:
    shutil.copytree(saved / "strip", "here")
    assert run("modes", "here", "--count", 1, "--plot", "--quiet") == (0, "", "")
    assert Path("here/modes.png").stat().st_size > 10_000
    # What is drawn of a result, and looked at, has the modes that stand there.
    out = run("plot", "here").out
    assert "here/modes.png" in out.splitlines()
    assert run("view", "here")[0] == 0
    assert '"modes":{"shape":0' in Path("here/view.html").read_text()
    # A picture of other modes does not stay.
    assert run("modes", "here", "--quiet") == (0, "", "")
    assert not Path("here/modes.png").exists()


def test_modes_are_seen_where_they_are_asked_for(run: Run, saved: Path) -> None:
    shutil.copytree(saved / "strip", "here")
    assert run("view", "here")[0] == 0
    assert '"modes":null' in Path("here/view.html").read_text()
    assert run("view", "here", "--modes")[0] == 0
    assert '"modes":{"shape":0' in Path("here/view.html").read_text()
    assert {path.name for path in Path("here").iterdir()} == RESULT | {"view.html"}


def test_what_has_no_modes_is_kept_and_says_why(run: Run, strip: str) -> None:
    words = ("--set", "law={type: regularized, epsilon: 0.1}", "--out", "kept")
    status, out, err = run("modes", strip, *words)
    assert (status, out) == (3, "")
    assert err == (
        "ribbonopt: strip: there are no modes: the law regularized has no energy; the solution is "
        "in kept\n"
    )
    assert {path.name for path in Path("kept").iterdir()} == RESULT
    status, out, err = run("modes", "kept", "--json")
    assert (status, json.loads(out)["status"]) == (3, "no_modes")
    assert {path.name for path in Path("kept").iterdir()} == RESULT
    status, _, err = run("view", "kept", "--modes")
    assert status == 2
    assert "there are no modes to be seen: the law regularized has no energy" in err


def test_what_was_not_solved_has_none(run: Run, strip: str) -> None:
    words = ("--set", "solver={type: newton, max_iterations: 1}", "--set", "parameters.d=0.2")
    end = "{support: clamped, position: [0, 0, 1 - d], directors: identity}"
    more = ("--set", f"boundary.end={end}")
    status, out, _ = run("modes", strip, *words, *more, "--out", "kept", "--json")
    assert status == 3
    assert json.loads(out)["verified"] is False
    assert not Path("kept").exists()
    assert {path.name for path in Path("kept.not-converged").iterdir()} == RESULT


SIZES = "length: 0.3, width: 0.01, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.3"
LENGTH = ("--set", "interval=[0, 0.3]")


def test_frequencies_are_in_hertz_where_the_mass_is_known(run: Run, strip: str) -> None:
    """Of a strip whose stiffness Dw is E w h^3 / 12 (1 - nu^2), of its mass per length rho w h."""
    words = ("modes", strip, *LENGTH, "--count", 2, "--json")
    told = json.loads(run(*words, "--set", f"ribbon={{{SIZES}, density: 1200}}").out)
    stiffness, mass = 2e9 * 0.01 * 1e-12 / 12 / (1 - 0.3**2), 1200 * 0.01 * 1e-4
    unit = (stiffness / mass) ** 0.5 / 0.3**2
    assert told["unit"] == "Hz"
    for mode, truth in zip(told["modes"], BEAM, strict=False):
        assert mode["frequency"] == pytest.approx(truth * unit / (2 * np.pi), rel=1e-8)
        assert mode["squared"] == pytest.approx((truth * unit) ** 2, rel=1e-8)
    without = json.loads(run(*words, "--set", f"ribbon={{{SIZES}}}").out)
    assert without["unit"] == "sqrt(Dw/(rho L^4))"
    for mode, truth in zip(without["modes"], BEAM, strict=False):
        assert mode["frequency"] == pytest.approx(truth, rel=1e-8)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("nothing.yaml",), "nothing.yaml: no such file"),
        (("strip.yaml", "--count", "0"), "--count: found '0'; expected a whole number from 1"),
        (("strip.yaml", "--count", "1e3"), "--count: found '1e3'; expected a whole number"),
        (("strip.yaml", "--count", "999"), "--count: found '999'; expected at most 200"),
        (("saved", "--set", "tolerance=1e-9"), "--set: saved is a saved result; expected a scene"),
        (("branch",), "branch: is a branch or a batch, expected a scene or the result of one"),
        ((".",), ".: is a folder without a result of ribbonopt"),
    ],
)
def test_bad_input_is_refused(
    run: Run, strip: str, saved: Path, words: tuple[str, ...], told: str
) -> None:
    shutil.copytree(saved / "strip", "saved")
    shutil.copytree(saved / "column", "branch")
    status, out, err = run("modes", *words, "--out", "new")
    assert (status, out) == (2, "")
    assert told in err
    assert len(err.splitlines()) <= 2
    assert not Path("new").exists()


@pytest.mark.parametrize(
    ("name", "change", "told"),
    [
        ("modes.json", lambda data: data[:40], "no JSON"),
        ("modes.json", lambda data: data.replace(b'"negative": 0', b'"negative": -1'), "negative"),
        ("modes.npz", lambda data: data[:-400], "no archive of arrays"),
        ("modes.npz", lambda data: b"", "no archive of arrays"),
    ],
)
def test_damaged_modes_are_told(
    run: Run, saved: Path, name: str, change: Callable[[bytes], bytes], told: str
) -> None:
    shutil.copytree(saved / "strip", "here")
    assert run("modes", "here", "--count", 1, "--quiet")[0] == 0
    path = Path("here", name)
    path.write_bytes(change(path.read_bytes()))
    for verb in ("view", "plot"):
        before = {path.name for path in Path("here").iterdir()}
        status, out, err = run(verb, "here")
        assert {path.name for path in Path("here").iterdir()} == before
        assert (status, out) == (2, "")
        assert f"here/{name}: is damaged" in err
        assert told in err
        assert "compute them again (ribbonopt modes)" in err
    assert run("modes", "here", "--count", 1, "--quiet")[0] == 0
    assert run("view", "here")[0] == 0


def test_modes_of_another_ribbon_are_refused(run: Run, saved: Path) -> None:
    shutil.copytree(saved / "strip", "here")
    assert run("modes", "here", "--count", 2, "--quiet")[0] == 0
    found = dict(np.load("here/modes.npz"))
    for name, value, said in (
        ("s", found["s"] * 2 + 0.5, "s: expected arclengths along the ribbon"),
        ("rotation", found["rotation"][:1], "rotation: expected a vector for each mode"),
        ("errors", found["errors"][:1], "errors: expected one for each mode"),
        ("displacement", np.nan * found["displacement"], "not finite"),
        ("squared", found["squared"].astype("S8"), "squared: found an array"),
        ("displacement", found["displacement"][0], "displacement: found an array"),
    ):
        np.savez("here/modes.npz", **{**found, name: value})
        status, _, err = run("view", "here")
        assert status == 2
        assert said in err
