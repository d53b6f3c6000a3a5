"""What may be prescribed at the ends: equal ways to say one thing, and roots that are no answer."""

from collections.abc import Callable
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from references import HALF_MOEBIUS
from scipy.spatial.transform import Rotation

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.ends.conditions import (
    Component,
    Condition,
    Context,
    CrossSection,
    Direction,
    Frame,
)
from ribbonopt.mechanics.ends.conditions import _across as across
from ribbonopt.mechanics.model import full_model, least_model
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Posed, formulate
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

HALF = "moebius_half.yaml"
MODELS = {"reduced": least_model((), ca.SX.sym), "full": full_model((), ca.SX.sym)}


@pytest.mark.parametrize("states", ["reduced", "full"])
@pytest.mark.parametrize(
    ("override", "equation"),
    [
        ("boundary.end.position={y: 0}", "r(end).z = 0"),
        ("boundary.end.position={y: 0}", "dot(r(end) - r(start), ez) = 0"),
        ("boundary.start.force={}", "n1(start) = 0"),
        ("boundary.start.force={}", "dot(n(start), d1(start)) = 0"),
        ("boundary.start.moment={}", "m1(start) = 0*width"),
        ("boundary.end.d1={}", "d1(end).x = sin(pi)*1e-3"),
        ("boundary.end.d3={}", "norm(cross(d3(end), ex))**2 = 1 + d3(end).x"),
    ],
)
def test_equations_say_what_components_say(
    configs: Path, states: str, override: str, equation: str
) -> None:
    also = f"boundary.also=['{equation}']"
    overrides = [f"states={states}", "parameters={width: 2}", override, also]
    found = solve(load_scene(configs / HALF, overrides))
    assert found.verified, found.message
    np.testing.assert_allclose(found.n0, HALF_MOEBIUS["n0"], rtol=1e-8, atol=1e-8)


def test_vector_equations_are_three_conditions(configs: Path) -> None:
    overrides = ["boundary.start.position={}", "boundary.also=['r(start) = [0, 0, 0]']"]
    _, problem = formulate(Posed.of(load_scene(configs / HALF, overrides)))
    assert sum(name.startswith("boundary.also.0") for name in problem.conditions) == 3


def context(model: str, frame: np.ndarray, theta: dict[str, float]) -> Context:
    """Return the context of a rod whose end has a frame and nothing else of interest."""
    zero = np.zeros((1, 3))
    x, c = MODELS[model].pack(RodFields(zero, frame[None], zero, zero), np.zeros(3))
    rod = MODELS[model].section(ca.DM(x[0]), ca.DM(c), ca.DM(0), ca.DM.zeros(3))
    section = CrossSection(MODELS[model], ca.DM(x[0]), rod, ca.DM.zeros(3))
    return Context({"end": section}, lambda name: ca.DM(theta[name]))


def sizes(condition: Condition, model: str, frame: np.ndarray) -> tuple[float, float]:
    """Return the largest residual and the largest verdict."""
    at = context(model, frame, condition.theta())
    values = [
        max(abs(float(ca.evalf(ca.SX(v)))) for v in part(at).values())
        for part in (condition.residuals, condition.verdicts)
    ]
    return values[0], values[1]


TARGET = Rotation.from_rotvec([0.4, -1.1, 0.3]).as_matrix()
each_model = pytest.mark.parametrize("model", MODELS)


@each_model
def test_frames_hold_where_they_are_prescribed(model: str) -> None:
    condition = Frame.of("end", TARGET)
    assert max(sizes(condition, model, TARGET)) < 1e-14


@each_model
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_half_a_turn_from_the_frame_is_no_answer(model: str, axis: int) -> None:
    condition = Frame.of("end", TARGET)
    turned = TARGET @ Rotation.from_rotvec(np.pi * np.eye(3)[axis]).as_matrix()
    assert sizes(condition, model, turned)[1] > 1


@each_model
@pytest.mark.parametrize("director", ["d1", "d2", "d3"])
def test_the_opposite_direction_is_a_root_but_no_answer(model: str, director: str) -> None:
    column = int(director[1]) - 1
    target = TARGET[:, column]
    condition = Direction("end", director, tuple(target.tolist()))
    assert max(sizes(condition, model, TARGET)) < 1e-14
    across = np.eye(3)[(column + 1) % 3]
    residual, verdict = sizes(
        condition, model, TARGET @ Rotation.from_rotvec(np.pi * across).as_matrix()
    )
    assert residual < 1e-14
    assert verdict == pytest.approx(2)


@each_model
def test_components_are_of_the_frame_they_name(model: str) -> None:
    lab = Component("end", "d2", "z", float(TARGET[2, 1]))
    assert max(sizes(lab, model, TARGET)) < 1e-14
    assert sizes(Component("end", "d2", "z", 0.0), model, TARGET)[0] == pytest.approx(
        abs(TARGET[2, 1])
    )


def test_strains_beyond_eta_one_are_no_answer(configs: Path) -> None:
    # The other sheet meets the same loads with |eta| = 2, which eq. (4.1) forbids.
    guess = "guess={force: [0, 12, 6], moment: [0, 3.7, 5]}"
    scene = load_scene(configs / "helix.yaml", ["law={type: single_sheet, chi: -1}", guess])
    found = solve(scene)
    assert found.status is Status.WRONG_SOLUTION
    assert "eta" in found.message
    assert not found.verified


@pytest.mark.parametrize("states", ["reduced", "full"])
def test_one_force_prescribed_at_both_ends_is_refused(configs: Path, states: str) -> None:
    # Without loads n is constant: the second says nothing new, and the moment stays free.
    overrides = [
        f"states={states}",
        "boundary.start={position: [0, 0, 0], directors: identity, force: [1, 0, 0]}",
        "boundary.end={force: [1, 0, 0]}",
    ]
    with pytest.raises(ModelError, match="force"):
        solve(load_scene(configs / "cantilever.yaml", overrides))


def test_other_numbers_are_solved_without_building_again(configs: Path) -> None:
    elastica = configs / "elastica_clamped.yaml"
    prepared = prepare(load_scene(elastica))
    found = prepared.solve(load_scene(elastica, ["parameters.shortening=0.3"]))
    direct = solve(load_scene(elastica, ["parameters.shortening=0.3"]))
    np.testing.assert_allclose(found.n0, direct.n0, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize(
    "override",
    [
        "law={type: kirchhoff}",
        "states=full",
        "transcription.intervals=13",
        "transcription.degree=5",
        "solver={type: newton}",
        "boundary.also=['norm(d1(end)) = 1']",
    ],
)
def test_another_structure_is_refused(configs: Path, override: str) -> None:
    elastica = configs / "elastica_clamped.yaml"
    prepared = prepare(load_scene(elastica, ["solver={type: ipopt}"]))
    with pytest.raises(ModelError, match="more than its numbers"):
        prepared.solve(load_scene(elastica, ["solver={type: ipopt}", override]))


def test_the_guess_need_not_be_near(configs: Path, solved: Callable[..., Solution]) -> None:
    far = "guess={force: [0, 30, 30], moment: [0, 3, -7]}"
    found = solved("moebius_half", far, "solver={type: ipopt}")
    np.testing.assert_allclose(found.n0, HALF_MOEBIUS["n0"], rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("seed", range(6))
def test_directions_across_another_are_right_handed_wherever_it_points(seed: int) -> None:
    """So that equations have one sign all along a branch that turns the direction about."""
    rng = np.random.default_rng(seed)
    for target in (*rng.normal(size=(20, 3)), *np.eye(3), *-np.eye(3)):
        target = target / np.linalg.norm(target)
        frame = np.vstack([across(target), target])
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(frame) == pytest.approx(1)
