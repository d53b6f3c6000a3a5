"""A support that a user declares in a module of their own: a roller, solved like any other."""

import importlib.util
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from ribbonopt.errors import SceneError
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import (
    AnyVector,
    Boundary,
    End,
    Kirchhoff,
    LabVector,
    LoadGuess,
    Scene,
    Support,
    dump_scene,
    json_schema,
    validate_scene,
)

MODULE = '''
"""A roller: it carries a load across its rail and nothing else."""

from ribbonopt.scene.supports import LoadVector, Position, Support

ROLLER = Support(
    "roller",
    "the lab component x of the position is held; no force along y and z, no moment",
    (Position("x"), LoadVector("force", "yz"), LoadVector("moment")),
)
'''
ROLLED = LabVector(x=0.3)
CLAMP = End("clamped", (0.0, 0.0, 0.0), "identity")


@pytest.fixture
def roller(tmp_path: Path) -> Support:
    path = tmp_path / "my_supports.py"
    path.write_text(MODULE, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("my_supports", path)
    assert spec is not None and spec.loader is not None
    module: ModuleType = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    support: Support = module.ROLLER
    return support


def propped(end: End) -> Scene:
    """Return a cantilever along z whose tip is pushed aside."""
    return Scene(
        "propped", Kirchhoff(), Boundary(CLAMP, end), guess=LoadGuess((1.0, 0.0, 0.0), (0, 1.0, 0))
    )


def test_a_roller_is_solved(roller: Support) -> None:
    found = solve(propped(End(roller, ROLLED)))
    plain = solve(propped(End(None, ROLLED, force=AnyVector(y=0, z=0), moment=(0, 0, 0))))
    assert found.verified
    np.testing.assert_allclose(found.n0, plain.n0, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.m0, plain.m0, rtol=0, atol=1e-9)
    assert abs(found.sample([1.0], "r")[0, 0] - 0.3) < 1e-9
    np.testing.assert_allclose(found.n0[1:], 0, atol=1e-9)
    assert found.n0[0] > 0.8


def test_a_roller_takes_a_load_along_its_rail(roller: Support) -> None:
    end = End(roller, ROLLED, force=AnyVector(y=0, z=0.5))
    assert solve(propped(end)).n0[2] == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"position": None}, 'support: roller needs position; add for example "position: {x: 0}"'),
        ({"position": LabVector(x=0, y=0)}, 'only; write for example "position: {x: 0}"'),
        (
            {"force": AnyVector(x=0)},
            'y and z, and no other; write for example "force: {y: 0, z: 0}',
        ),
        ({"directors": "identity"}, "contradicts support: roller, which takes only position,"),
    ],
)
def test_bad_rollers_are_refused_as_other_supports_are(
    roller: Support, change: dict[str, object], message: str
) -> None:
    with pytest.raises(SceneError) as caught:
        validate_scene(propped(replace(End(roller, ROLLED), **change)))
    assert message in str(caught.value)


def test_no_file_can_say_a_roller(roller: Support) -> None:
    with pytest.raises(SceneError, match="'roller' is declared in Python"):
        dump_scene(propped(End(roller, ROLLED)))
    assert "roller" not in str(json_schema())


def test_files_take_names_only() -> None:
    with pytest.raises(SceneError, match=r"support: found .*expected 'clamped', .* or 'flip'"):
        validate_scene(propped(End({"name": "roller"})))  # type: ignore[arg-type]
    assert "LoadVector" not in str(json_schema())
