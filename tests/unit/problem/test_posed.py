"""A scene is posed once, whatever is then asked of it."""

from pathlib import Path

import numpy as np
import pytest

from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Posed, posed
from ribbonopt.scene import Variational, load_scene


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
    assert len(found.steps) > 3  # least energy, homotopy, phases or meshes: all of one posed scene
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
