"""A scene is posed once, whatever is then asked of it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.errors import ModelError
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Posed, posed
from ribbonopt.scene import Variational, load_scene, loads_scene
from ribbonopt.scene.lens import paths_of, value_at, with_value


def counted(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    calls: list[object] = []
    genuine = posed.conditions_of
    monkeypatch.setattr(posed, "conditions_of", lambda s: calls.append(s) or genuine(s))
    return calls


def test_one_solve_builds_its_conditions_once(
    configs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = counted(monkeypatch)
    found = solve(load_scene(configs / "clamped_arch.yaml", ["tolerance=1e-8"]))
    assert found.verified
    steps = [step["step"] for step in found.steps]
    # Least energy, homotopy, phases: all of one posed scene.
    assert steps[0].startswith("least energy") and len(steps) > 2 and "phases" in steps[-1]
    assert len(calls) == 1


def test_another_scene_of_the_structure_once_more(
    configs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    prepared = prepare(load_scene(configs / "moebius_half.yaml"))
    calls = counted(monkeypatch)
    assert prepared.solve(load_scene(configs / "moebius_half.yaml")).verified
    assert len(calls) == 1


def test_under_another_law_the_ends_are_the_same(configs: Path) -> None:
    first = Posed.of(load_scene(configs / "clamped_arch.yaml"))
    second = first.under(law=Variational(delta=0.3), formulation="energy")
    assert second.conditions is first.conditions
    assert second.theta["law.delta"] == 0.3
    assert second.structure != first.structure
    np.testing.assert_array_equal(second.start[0], first.start[0])


def test_numbers_alone_make_no_other_structure(configs: Path) -> None:
    path = configs / "moebius_regularized.yaml"
    one, two = (Posed.of(load_scene(path, [f"law.epsilon={e}"])) for e in (0.1, 0.2))
    assert one.structure == two.structure
    assert (one.values != two.values).sum() == 1


MOVED = (
    *("clamped_arch", "moebius_whole", "moebius_regularized", "ribbon_si", "tapered_strip"),
    *("heavy_cantilever", "curved_ring", "rod_to_ribbon", "wunderlich_clamps", "curled_strip"),
)


@pytest.mark.parametrize("name", MOVED)
def test_what_has_moved_is_posed_as_if_anew(configs: Path, name: str) -> None:
    """Whatever number it is, and also after another that has moved before."""
    scene = replace(load_scene(configs / f"{name}.yaml"), continuation=None)
    first = last = Posed.of(scene)
    for path in paths_of(scene):
        other = with_value(scene, path, 1.01 * value_at(scene, path) + 0.001)
        expected = Posed.of(other)
        last = last.moved(other)
        for found in (first.moved(other), last):
            assert found.given is other
            assert found.theta == expected.theta, path
            assert list(found.theta) == list(expected.theta), path
            assert found.structure == expected.structure, path
            assert [c.theta() for c in found.conditions] == [c.theta() for c in expected.conditions]
            assert found.units == expected.units
            np.testing.assert_array_equal(found.values, expected.values)


def test_where_the_law_moves_the_ends_stay(configs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load_scene(configs / "moebius_regularized.yaml")
    first, calls = Posed.of(scene), counted(monkeypatch)
    for epsilon in (0.1, 0.2):
        other = with_value(scene, "law.epsilon", epsilon)
        assert first.moved(other).conditions is first.conditions
    first.moved(with_value(scene, "boundary.end.position.y", 0.1))
    assert len(calls) == 1


def test_from_a_scene_to_one_with_other_numbers_of_its_law(
    configs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is posed as if it stood alone, whatever is different, and ends once for all alike."""
    first = Posed.of(load_scene(configs / "moebius_regularized.yaml"))
    scene = first.given
    law = replace(scene.law, epsilon=0.2)  # type: ignore[arg-type]
    others = [
        replace(scene, law=law),
        replace(scene, law=Variational(delta=0.3)),
        replace(scene, law=law, tolerance=1e-5),
        replace(scene, law=law, interval=(0.0, 0.51)),
        replace(scene, law=law, formulation="energy"),
    ]
    calls = counted(monkeypatch)
    for other in others:
        count = len(calls)
        moved = first.moved(other)
        assert (len(calls) == count) == (other is others[0])
        alone = Posed.of(other)
        assert moved.theta == alone.theta and list(moved.theta) == list(alone.theta)
        assert moved.structure == alone.structure
        assert moved.given is other and moved.scene.law == other.law
    again = first.moved(others[0]).moved(scene)
    assert again.theta == first.theta and again.like is first


STRIP = """
name: strip
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {position: [0, 0, 0], directors: identity}
  end: {position: {x: 0.1, y: 0.0}, directors: identity}
  also: ["n3(end) = 2"]
"""
OTHERS = [
    "law={type: variational, delta: 0.5}",
    "formulation=differentiated",
    "states=full",
    "solver={type: newton, max_iterations: 3}",
    "transcription={type: collocation, intervals: 12}",
    "transcription={type: collocation, degree: 5}",
    "boundary.also=['n1(end) = 2']",
    "boundary.end={position: {x: 0.1, z: 0.9}, directors: identity}",
    "loads={force: [0, 1, 0]}",
]


@pytest.mark.parametrize("other", OTHERS)
def test_what_is_built_serves_no_scene_that_is_more_than_other_numbers(other: str) -> None:
    first, second = (loads_scene(STRIP, overrides=more) for more in ([], [other]))
    assert Posed.of(first).structure != Posed.of(second).structure
    with pytest.raises(ModelError, match="more than its numbers"):
        prepare(first).solve(second)


def test_each_plane_has_a_structure_of_its_own() -> None:
    """Of position and force different components are unknown."""
    text = STRIP.replace('  also: ["n3(end) = 2"]\n', "").replace(", y: 0.0}", ", y: 0, z: 0.9}")
    across = "{turns: [{d3: 90*deg}]}"
    turned = text.replace("identity", across).replace("x: 0.1, y: 0", "x: 0, y: 0.1")
    first, second = (loads_scene(each, overrides=["states=planar"]) for each in (text, turned))
    for scene, moved, still in ((first, 0, 1), (second, 1, 0)):
        found = solve(scene)
        assert found.verified, found.message
        assert found.sample(1.0, "r")[moved] == pytest.approx(0.1)
        assert abs(found.sample(1.0, "r")[still]) < 1e-12
    assert Posed.of(first).structure != Posed.of(second).structure
    with pytest.raises(ModelError, match="more than its numbers"):
        prepare(first).solve(second)
