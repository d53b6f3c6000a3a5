"""A load of a user's own that follows the ribbon: pressure."""

from typing import Any

import numpy as np
import pytest
from clamps import EQUATIONS, GENERIC
from user_modules import Import

from ribbonopt import Continuation, dump_scene, loads_scene, solve
from ribbonopt.checks.stability import negative_directions, why_not
from ribbonopt.errors import ModelError, SceneError
from ribbonopt.scene import (
    ContinuationStage,
    Loads,
    RibbonSizes,
    Sadowsky,
    Scene,
    json_schema,
    validate_scene,
)
from ribbonopt.scene.units import in_special_units
from ribbonopt.studies.continuation.recorded import value_of

PRESSED = (-3.4489154847, -4.8918439300, -5.3525944828)
BENT = (3.2151020023, 1.7627574234, -0.1085666133)
MIDDLE = (0, 2.6206831018, 0.8408084000)
H = -3.7959923331


def pressed(user: Import, p: float = 8.0, **settings: Any) -> Scene:
    loads = Loads(own=(user("pressure").Pressure(p),))
    return Scene("pressed", Sadowsky(), GENERIC, loads=loads, **settings)


@pytest.mark.parametrize("formulation", EQUATIONS)
@pytest.mark.parametrize("states", ["reduced", "full"])
def test_pressure_is_solved_from_nothing(user: Import, formulation: Any, states: Any) -> None:
    found = solve(pressed(user, formulation=formulation, states=states))
    assert found.verified
    np.testing.assert_allclose(found.n0, PRESSED, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.m0, BENT, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.sample(0.5, "u"), MIDDLE, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.at_nodes["H"], H, rtol=0, atol=1e-9)
    assert found.verification.drift["H"] < 1e-12


def test_what_follows_has_no_energy(user: Import) -> None:
    with pytest.raises(ModelError, match=r"energy: loads\.pressure follows the ribbon"):
        solve(pressed(user, formulation="energy"))
    found = solve(pressed(user))
    assert negative_directions(found) is None
    assert why_not(found)


def test_pressure_is_continued(user: Import) -> None:
    stage = ContinuationStage("loads.own.0.p", to=8.0)
    *_, last = Continuation(pressed(user, 2.0, continuation=stage))
    assert value_of(last.row) == 8.0
    assert last.row["n0z"] == pytest.approx(PRESSED[2], abs=1e-7)


def test_numbers_of_a_load_stay_in_special_units(user: Import) -> None:
    sizes = RibbonSizes(0.2, 0.01, 1e-4, 2e9, 0.3)
    si = pressed(user, interval=(0.0, 0.2), ribbon=sizes)
    assert in_special_units(si).loads == si.loads


def test_bad_loads_are_refused(user: Import) -> None:
    with pytest.raises(SceneError, match=r"loads\.own\.0: found 3, expected what only Python can"):
        validate_scene(Scene("a", Sadowsky(), GENERIC, loads=Loads(own=(3,))))  # type: ignore[arg-type]
    one = user("pressure").Pressure(1.0)
    with pytest.raises(ModelError, match=r"two have a number 'loads\.pressure\.p'; name"):
        solve(Scene("a", Sadowsky(), GENERIC, loads=Loads(own=(one, one))))

    class Something:
        def numbers(self) -> dict[str, float]:
            return {}

        def force(self, section: Any, theta: Any) -> Any:
            return None

    with pytest.raises(ModelError, match="found Something, expected a subclass of"):
        solve(Scene("a", Sadowsky(), GENERIC, loads=Loads(own=(Something(),))))


def test_no_file_can_say_it(user: Import) -> None:
    with pytest.raises(SceneError, match=r"loads\.own: Pressure is declared in Python"):
        dump_scene(pressed(user))
    keys = r"force, couple, pressure, points"
    with pytest.raises(SceneError, match=rf"unknown key.* \(known keys: {keys}\)"):
        loads_scene("{name: a, law: {type: sadowsky}, boundary: {}, loads: {pres: 3}}")
    assert "own" not in json_schema()["properties"]["loads"]["properties"]
