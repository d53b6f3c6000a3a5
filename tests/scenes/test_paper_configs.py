"""The scenes of the paper's figures and misprints: each is solved, and says its truth."""

from collections.abc import Callable
from pathlib import Path

import pytest
from references import HALF_MOEBIUS, REGULARIZED, agrees

from ribbonopt.scene import dump_scene, load_scene, loads_scene
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
PAPER = Path(__file__).parents[2] / "configs" / "paper"
NAMES = sorted(path.stem for path in PAPER.glob("*.yaml"))
each_scene = pytest.mark.parametrize("name", NAMES)


def test_no_scene_of_the_paper_is_missing() -> None:
    figures = {"moebius_sadowsky", "moebius_regularized", "moebius_wunderlich", "moebius_epsilon"}
    assert set(NAMES) == figures | {"printed_half", "printed_whole"}


@each_scene
def test_scene_of_the_paper_is_solved_and_verified(solved: Solved, name: str) -> None:
    found = solved(f"paper/{name}")
    assert found.verification.problems == ()
    assert found.verification.worst_condition < 1e-8


@each_scene
def test_scene_of_the_paper_says_its_truth(name: str) -> None:
    lines = (PAPER / f"{name}.yaml").read_text(encoding="utf-8").splitlines()
    head = [line for line in lines if line.startswith("#")]
    assert head[0] == "# yaml-language-server: $schema=../scene.schema.json"
    assert any(line.startswith("# Truth") for line in head)
    assert all(len(line) <= 100 for line in lines)


@each_scene
def test_scene_of_the_paper_survives_being_written(name: str) -> None:
    scene = load_scene(PAPER / f"{name}.yaml")
    assert loads_scene(dump_scene(scene)) == scene


def test_sadowsky_and_regularized_are_the_references(solved: Solved) -> None:
    for name, exact, u2 in (
        ("moebius_sadowsky", HALF_MOEBIUS, HALF_MOEBIUS["u0"][1]),
        ("moebius_regularized", REGULARIZED[0.01], REGULARIZED[0.01]["u2"][0]),
    ):
        found = solved(f"paper/{name}")
        assert found.n0 == pytest.approx(exact["n0"], rel=1e-9, abs=1e-9)
        assert found.m0 == pytest.approx(exact["m0"], rel=1e-9, abs=1e-9)
        assert found.u0[1] == pytest.approx(u2, rel=1e-9)


def test_wunderlich_has_the_digits_of_two_other_programs(solved: Solved) -> None:
    found = solved("paper/moebius_wunderlich")
    n0, m0 = ("43.38497675", "45.15374415"), ("1.47704983", "-10.12256023")
    assert all(agrees(value, digits) for value, digits in zip(found.n0[1:], n0, strict=True))
    assert all(agrees(value, digits) for value, digits in zip(found.m0[1:], m0, strict=True))
    assert agrees(found.u0[1], "3.39288726")
    assert agrees(float(found.start["H"]), "62.281451")
    assert agrees(2 * found.energy, "59.6772048")
