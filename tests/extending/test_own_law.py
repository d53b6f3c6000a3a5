"""A law of a user's own, with u1 and natural strains: a rod, solved like any law of the package."""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from clamps import CLAMPED, FORMULATIONS, GENERIC
from user_modules import Import

from ribbonopt import (
    Continuation,
    dump_scene,
    load_solution,
    loads_scene,
    prepare,
    save_solution,
    solve,
    summarize,
)
from ribbonopt.checks.stability import negative_directions
from ribbonopt.errors import ModelError, OutputError, SceneError
from ribbonopt.output.report import report
from ribbonopt.scene import (
    Boundary,
    Collocation,
    ContinuationStage,
    End,
    Loop,
    Scene,
    StrainGuess,
    json_schema,
    validate_scene,
)
from ribbonopt.studies.continuation.recorded import value_of

ROD: dict[str, Any] = {
    "n0": (-1.8666739446, 0.5032061909, -0.5680288001),
    "m0": (0.1092371051, 0.8535486222, 1.2298306407),
    "u": (0.3246011853, 2.6168669231, 0.6153729954),
    "energy": 1.505672122148,
    "H": 1.0258628878,
    "n_dot_m": -0.4729783301,
}
NATURAL = {"k1": 0.4, "k2": 1.0, "k3": -0.5}


def rod(user: Import, **settings: Any) -> Scene:
    law = user("rod").Rod(**NATURAL)
    return Scene("rod", law, GENERIC, **settings)


@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_a_rod_is_solved_from_nothing(user: Import, formulation: Any) -> None:
    mesh = Collocation(intervals=20)
    found = solve(rod(user, formulation=formulation, transcription=mesh))
    assert found.verified
    for name in ("n0", "m0", "energy"):
        np.testing.assert_allclose(getattr(found, name), ROD[name], rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.sample(0.5, "u"), ROD["u"], rtol=0, atol=1e-9)
    s = np.linspace(0, 1, 7)
    for name in ("H", "n_dot_m"):
        np.testing.assert_allclose(found.sample(s, name), ROD[name], rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.sample(s, "u1 ** 2"), found.sample(s, "u")[:, 0] ** 2)
    assert negative_directions(found) == 0


@pytest.mark.parametrize("states", ["reduced", "full"])
def test_constant_natural_strains_are_a_helix_without_stress(user: Import, states: Any) -> None:
    law = user("rod").Rod(**NATURAL)
    boundary = Boundary(CLAMPED, End("free"))
    # No guess: nothing bends it but itself.
    found = solve(Scene("curled", law, boundary, states=states))
    assert found.verified
    np.testing.assert_allclose(found.sample(np.linspace(0, 1, 5), "u"), 5 * [[0.4, 1, -0.5]])
    assert found.energy == pytest.approx(0, abs=1e-12)


def test_numbers_of_a_rod_change_without_building_again(user: Import) -> None:
    scene = rod(user)
    prepared = prepare(scene)
    other = replace(scene, law=replace(scene.law, B1=5.0, k3=0.2))  # type: ignore[type-var]
    np.testing.assert_allclose(prepared.solve(other).n0, solve(other).n0, rtol=0, atol=1e-9)
    with pytest.raises(ModelError, match="more than its numbers"):
        prepared.solve(replace(scene, law=user("tapered").Tapered()))


def test_a_rod_is_continued_in_its_numbers(user: Import) -> None:
    stage = ContinuationStage("law.k1", to=0.8)
    record = {"across": "u1 at 0.5"}
    *_, last = Continuation(rod(user, continuation=stage, record=record))
    end = replace(user("rod").Rod(**NATURAL), k1=0.8)
    direct = solve(replace(rod(user), law=end))
    assert value_of(last.row) == 0.8
    assert last.row["across"] == pytest.approx(float(direct.sample(0.5, "u1")), abs=1e-8)
    assert last.row["u1"] == pytest.approx(direct.u0[0], abs=1e-8)


def test_several_starts_of_a_rod(user: Import) -> None:
    found = solve(rod(user, starts=4, guess=StrainGuess((2.0, 0.5))))
    assert found.verified
    assert found.energy == pytest.approx(ROD["energy"], abs=1e-9)


def test_a_rod_is_saved_and_loaded_with_its_scene(user: Import, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text("of an older result", encoding="utf-8")
    found = solve(rod(user))
    assert save_solution(found, tmp_path) == (
        "scene.yaml: law 'rod' is declared in Python, which no file can say",
    )
    assert {path.name for path in tmp_path.iterdir()} == {"summary.json", "solution.npz"}
    again = load_solution(tmp_path, found.scene)
    assert again.verified
    np.testing.assert_array_equal(again.n0, found.n0)
    with np.load(tmp_path / "solution.npz") as data:
        np.testing.assert_array_equal(data["u"][:, 0], found.sample(data["s"], "u1"))
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["law"] == {"type": "rod", "B1": 3.0, "B2": 1.0, "B3": 0.8, **NATURAL}
    assert summary["u0"] == found.u0.tolist()
    with pytest.raises(OutputError, match=r"declared in Python, give it: load_solution\(path, sc"):
        load_solution(tmp_path)


def test_the_report_tells_three_strains(user: Import) -> None:
    text = report(summarize(solve(rod(user))))
    assert "law rod (B1 = 3, B2 = 1, B3 = 0.8, k1 = 0.4, k2 = 1, k3 = -0.5)" in text
    assert "strains u(0), directors  (0.43641236837" in text


def test_no_file_can_say_a_rod(user: Import) -> None:
    with pytest.raises(SceneError, match="law 'rod' is declared in Python, which no file can say"):
        dump_scene(rod(user))
    with pytest.raises(SceneError, match=r"found 'homotpy', expected .*did you mean 'homotopy'"):
        loads_scene("{name: a, law: {type: homotpy}, boundary: {}}")
    with pytest.raises(
        SceneError, match=r"law\.type: found 'shaft', expected 'kirchhoff', .* or 'sano'"
    ):
        loads_scene("{name: a, law: {type: shaft}, boundary: {}}")
    assert "OwnLaw" not in str(json_schema())


def test_what_is_no_law_is_refused(user: Import) -> None:
    @dataclass(frozen=True)
    class Nothing:
        type: str = "nothing"

    with pytest.raises(SceneError, match=r"law: found .*Nothing.*expected a mapping whose `ty"):
        validate_scene(Scene("a", Nothing(), GENERIC))  # type: ignore[arg-type]

    @dataclass(frozen=True)
    class Wrong(Nothing):
        def constitutive(self, numbers: Any, position: Any) -> Any:
            return 3

    with pytest.raises(ModelError, match=r"law nothing: constitutive.* returned int, expected a"):
        solve(Scene("a", Wrong(), GENERIC))
    for value in ("stiff", float("nan")):
        with pytest.raises(ModelError, match=r"law\.B1: found .*, expected a number"):
            solve(Scene("a", user("rod").Rod(B1=value), GENERIC))


@pytest.mark.parametrize(
    ("half_twists", "piece", "natural", "refused"),
    [
        (0, "half", {"k2": 3.0}, ""),
        (0, "half", {"k1": 0.1}, "d1"),
        (1, "half", {"k2": 0.1}, "d2"),
        (1, "half", {"k3": 0.1}, ""),
        (2, "half", {"k2": 0.1}, ""),
        (3, "fundamental", {"k2": 0.1}, "d2"),
        (1, "whole", {"k2": 0.1}, ""),
    ],
)
def test_a_piece_stands_for_a_loop_where_the_law_has_its_symmetry(
    user: Import, half_twists: int, piece: Any, natural: dict[str, float], refused: str
) -> None:
    start = End(position=(0.0, 0.0, 0.0), directors="identity")
    boundary = Boundary(start if piece == "whole" else End(), loop=Loop(half_twists, piece))
    scene = Scene("band", user("rod").Rod(**natural), boundary)
    if not refused:
        prepare(scene)
        return
    with pytest.raises(ModelError, match=f"by flips about {refused}, after .*; solve piece: whole"):
        prepare(scene)
