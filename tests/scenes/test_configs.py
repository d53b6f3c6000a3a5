"""Every shipped scene loads, solves, says what it is, and survives being written."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.scene import dump_scene, json_schema, load_scene, loads_scene
from ribbonopt.solution.solution import Solution

CONFIGS = Path(__file__).parents[2] / "configs"
EXPECTED = {
    "cantilever",
    "elastica_clamped",
    "extensible_clamped",
    "helix",
    "moebius_half",
    "moebius_half_full",
    "moebius_kirchhoff",
    "moebius_regularized",
    "moebius_variational",
    "ribbon_si",
    "sano_clamped",
}
NAMES = sorted(path.stem for path in CONFIGS.glob("*.yaml"))
each_scene = pytest.mark.parametrize("name", NAMES)


def test_no_scene_is_missing() -> None:
    assert set(NAMES) >= EXPECTED


@each_scene
@pytest.mark.parametrize("solver", ["ipopt", "newton", "auto"])
def test_scene_is_solved_and_verified(
    solved: Callable[..., Solution], name: str, solver: str
) -> None:
    found = solved(name, f"solver={{type: {solver}}}")
    assert found.verification.problems == ()
    assert found.verification.worst_condition < 1e-8


@each_scene
def test_solvers_agree(solved: Callable[..., Solution], name: str) -> None:
    a, b = (solved(name, f"solver={{type: {solver}}}") for solver in ("ipopt", "newton"))
    scale = max(np.abs(a.n0).max(), np.abs(a.m0).max())
    np.testing.assert_allclose(a.n0, b.n0, atol=1e-10 * scale)
    np.testing.assert_allclose(a.m0, b.m0, atol=1e-10 * scale)


@each_scene
def test_scene_says_what_it_is(name: str) -> None:
    lines = (CONFIGS / f"{name}.yaml").read_text(encoding="utf-8").splitlines()
    head = lines[: next(i for i, line in enumerate(lines) if not line.startswith("#"))]
    assert head[0] == "# yaml-language-server: $schema=scene.schema.json"
    assert len(head) >= 3
    assert any(word in " ".join(head) for word in ("Truth", "truth", "Exact", "exact"))


@each_scene
def test_scene_written_and_read_again_is_the_same(name: str) -> None:
    scene = load_scene(CONFIGS / f"{name}.yaml")
    assert loads_scene(dump_scene(scene)) == scene


def test_schema_for_editors_is_the_one_of_the_code() -> None:
    text = (CONFIGS / "scene.schema.json").read_text(encoding="utf-8")
    assert json.loads(text) == json_schema()
