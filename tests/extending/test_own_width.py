"""A law and a load of a user's own that depend on the arclength: a cantilever that tapers."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from clamps import CLAMPED, EQUATIONS, FORMULATIONS
from user_modules import Import

from ribbonopt import save_solution, solve
from ribbonopt.problem import Posed
from ribbonopt.scene import AnyVector, Boundary, Collocation, Directors, End, Loads, Scene, Shooting
from ribbonopt.starts.first_shape import follower_loads
from ribbonopt.studies.comparison.measure import LawResidual
from ribbonopt.studies.comparison.profile import SAMPLES

TIP_LOADED = (-0.356148547888, 0.916335210590)
HEAVY, ROOT = (-0.326452366854, 0.936274162831), -1.28159628887


def tapered(user: Import, **settings: Any) -> Scene:
    """Return a horizontal cantilever under a dead load of 1 at its tip."""
    boundary = Boundary(CLAMPED, End("free", force=(-1.0, 0.0, 0.0)))
    return Scene("tapered", user("tapered").Tapered(), boundary, **settings)


def heavy(user: Import, **settings: Any) -> Scene:
    """Return the same bent by its own weight."""
    loads = Loads(own=(user("weight").Weight(5.0, 0.7),))
    boundary = Boundary(CLAMPED, End("free"))
    return Scene("heavy", user("tapered").Tapered(), boundary, loads=loads, **settings)


@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_a_tapered_cantilever_carries_its_tip(user: Import, formulation: Any) -> None:
    found = solve(tapered(user, formulation=formulation))
    assert found.verified
    np.testing.assert_allclose(found.sample(1.0, "r")[[0, 2]], TIP_LOADED, rtol=0, atol=1e-9)


@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_a_tapered_cantilever_carries_itself(user: Import, formulation: Any) -> None:
    found = solve(heavy(user, formulation=formulation))
    assert found.verified
    np.testing.assert_allclose(found.sample(1.0, "r")[[0, 2]], HEAVY, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.m0, (0, ROOT, 0), rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.n0, (-5 * (1 - 0.35), 0, 0), rtol=0, atol=1e-9)


@pytest.mark.parametrize("formulation", EQUATIONS)
@pytest.mark.parametrize("states", ["reduced", "full"])
def test_whatever_the_scheme(user: Import, formulation: Any, states: Any) -> None:
    schemes = [Collocation(scheme="radau", degree=6), Shooting(scheme="gauss", degree=4)]
    for scheme in schemes if formulation == "algebraic" else [*schemes, Shooting(steps=4)]:
        settings = {"formulation": formulation, "states": states, "transcription": scheme}
        found = solve(heavy(user, **settings))
        np.testing.assert_allclose(found.sample(1.0, "r")[[0, 2]], HEAVY, rtol=0, atol=1e-8)


def test_an_interval_that_starts_elsewhere(user: Import) -> None:
    # The piece behind s = 0.5 of the first one, held as it stands.
    whole = solve(tapered(user))
    d1, d3 = (tuple(map(float, whole.sample(0.5, d))) for d in ("d1", "d3"))
    place = tuple(map(float, whole.sample(0.5, "r")))
    held = End("clamped", place, Directors(d1=d1, d3=d3))  # type: ignore[arg-type]
    for formulation in FORMULATIONS:
        scene = Scene(
            "rest",
            user("tapered").Tapered(),
            Boundary(held, End("free", force=(-1.0, 0.0, 0.0))),
            interval=(0.5, 1.0),
            formulation=formulation,
        )
        found = solve(scene)
        assert found.verified
        np.testing.assert_allclose(found.sample(1.0, "r"), whole.sample(1.0, "r"), atol=1e-9)


def test_what_is_no_invariant_is_not_told_as_one(user: Import, tmp_path: Path) -> None:
    for scene in (tapered(user), heavy(user)):
        found = solve(scene)
        assert np.isnan(found.verification.drift["H"])
        assert np.ptp(found.at_nodes["H"]) > 0.1
    assert "loads.own: Weight" not in "".join(save_solution(found, tmp_path))  # the law is named


def test_the_law_is_compared_where_it_holds(user: Import) -> None:
    found = solve(tapered(user, formulation="differentiated"))
    s = (np.arange(SAMPLES) + 0.5) / SAMPLES
    assert LawResidual(found.posed)(s, found.outputs(s), found.units) < 1e-9


@pytest.mark.parametrize("start", [0.0, 0.2])
def test_loads_that_follow_the_end_are_integrated_under_the_law_of_each_place(
    user: Import, start: float
) -> None:
    """From the thin end back to the clamp: m = B(s) u with the width at that place."""
    end = End(
        "free", force=AnyVector(d1=0.2, d2=0.0, d3=-0.1), moment=AnyVector(d1=0, d2=0.3, d3=0.1)
    )
    boundary = Boundary(CLAMPED, end)
    scene = Scene("follower", user("tapered").Tapered(), boundary, interval=(start, start + 0.8))
    posed = Posed.of(scene)
    guess = follower_loads(posed)
    assert guess is not None
    fraction = np.linspace(0, 1, 401)
    found = guess.fields(fraction)
    m = np.einsum("kij,ki->kj", found.frames, found.m)
    turn = np.einsum("kji,kjl->kil", found.frames[:-2], found.frames[2:])
    h = 2 * 0.8 / 400
    strains = (
        np.stack([turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], axis=1) / 2 / h
    )
    width = 1 - 0.7 * (start + 0.8 * fraction[1:-1, None])
    np.testing.assert_allclose(width * strains, m[1:-1, 1:], atol=1e-4)
