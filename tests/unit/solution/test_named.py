"""Outputs by name: each its own expression at its own place, however many are asked for."""

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest

from ribbonopt.pipeline.prepared import prepare
from ribbonopt.solution.named import Choice, Choices, Named, Places
from ribbonopt.solution.solution import Solution

Array = np.ndarray
Solved = Callable[..., Solution]

SCENES = {
    "one phase": ("moebius_half",),
    "two phases": ("moebius_regularized", "law={type: sadowsky}"),
    "another width": ("tapered_strip",),
    "loads": ("heavy_cantilever",),
    "strains as unknowns": ("moebius_half", "formulation=differentiated"),
    "algebraic strains": ("moebius_half", "formulation=algebraic"),
    "natural strains": ("curled_strip",),
    "SI": ("ribbon_si",),
}

each_scene = pytest.mark.parametrize("scene", list(SCENES.values()), ids=list(SCENES))


def alone(solution: Solution, name: str, phase: int, v: Array, fraction: float) -> Array:
    """One output at one place, by its own expression."""
    problem, dense = solution.problem, solution.dense
    inputs = [ca.vertcat(problem.state, problem.algebraic), problem.constants, problem.parameters]
    expression = problem.phases[phase].outputs[name]
    function = ca.Function("alone", [*inputs, problem.position], [expression])
    start, end = solution.posed.scene.interval
    s = start + (end - start) * fraction
    found: Array = np.array(function(v, dense.constants, dense.theta, s)).ravel()
    return found


@each_scene
def test_outputs_are_their_expressions_at_their_places(
    solved: Solved, scene: tuple[str, ...]
) -> None:
    solution = solved(*scene)
    trajectory = solution.trajectory
    v, fractions, _, phases = trajectory.stages
    where = [(trajectory.at_stages, v, fractions, phases)]
    if not solution.problem.algebraic.numel():
        nodes = trajectory.nodes
        at_nodes = trajectory.at_nodes, solution.dense.at_nodes, nodes, trajectory.phase_of(nodes)
        where.append(at_nodes)
    for outputs, v, fractions, phases in where:
        for name, values in outputs.items():
            for k in (0, len(v) // 3, len(v) // 2, len(v) - 1):
                expected = alone(solution, name, int(phases[k]), v[k], float(fractions[k]))
                np.testing.assert_allclose(np.ravel(values[k]), expected, rtol=1e-13, atol=1e-13)


@each_scene
def test_the_order_of_asking_is_no_matter(solved: Solved, scene: tuple[str, ...]) -> None:
    solution = solved(*scene)
    places = (solution.trajectory.at_nodes, solution.trajectory.at_stages)
    for kept, fraction in zip(
        places, (solution.trajectory.nodes, solution.trajectory.stages[1]), strict=True
    ):
        names = list(kept)
        assert len(kept) == len(names) == len(solution.problem.output_sizes)
        ways = (names, names[::-1], [*names[::2], *names[1::2]])
        fresh = [Named(kept.places, *kept._choices) for _ in ways]
        found = [{n: np.array(one[n]) for n in way} for one, way in zip(fresh, ways, strict=True)]
        for name in names:
            assert name in kept
            for one in found:
                np.testing.assert_array_equal(one[name], kept[name])
            assert kept.largest(name) == np.abs(kept[name]).max()
            assert len(kept[name]) == len(fraction)
    assert "nonsense" not in places[0]
    with pytest.raises(KeyError):
        places[0]["nonsense"]


def test_a_number_that_is_none_is_the_largest(solved: Solved) -> None:
    """Else what failed would look as small as the rest."""
    choice = Choices(solved("moebius_half").problem).nodes
    numbers = np.zeros(choice.width)
    numbers[choice.columns["m"]] = 1, np.nan, 2
    found = choice.largest(numbers)
    assert np.isnan(found["m"]) and found["n"] == found["H"] == 0
    # Of the first columns alone, too.
    assert list(choice.largest(numbers[: choice.before("u")])) == ["r", "d1", "d2", "d3"]


def test_names_that_a_problem_has_not_are_left_out(solved: Solved) -> None:
    choice = Choice.of(solved("moebius_half").problem, ("m", "nonsense", "H", "m"))
    assert dict(choice.columns) == {"m": slice(0, 3), "H": 3}
    assert choice.width == 4


def test_nobody_pays_for_what_is_not_asked(solved: Solved, monkeypatch: pytest.MonkeyPatch) -> None:
    """A solve with its bar evaluates a part of all outputs, and each once."""
    prepared = prepare(solved("moebius_half", "tolerance=1e-9").scene)
    asked: list[tuple[Places, Choice]] = []
    columns = Places.columns

    def counted(places: Places, choice: Choice) -> Array:
        asked.append((places, choice))
        return columns(places, choice)

    monkeypatch.setattr(Places, "columns", counted)
    assert prepared.solve().verified
    every = sum(prepared.problem.output_sizes.values())
    assert max(choice.width for _, choice in asked) < every
    pairs = {(id(places), id(choice)) for places, choice in asked}
    assert len(pairs) == len(asked) <= 4


def test_outputs_at_the_start_are_those_at_the_first_node(solved: Solved) -> None:
    for scene in (("moebius_half",), ("ribbon_si",)):
        found = solved(*scene)
        sampled = found.outputs(np.array(found.scene.interval))
        assert list(found.start) == list(found.at_nodes) == list(sampled)
        assert len(found.start) == len(sampled)
        for name, values in sampled.items():
            np.testing.assert_allclose(found.start[name], values[0], rtol=1e-14, atol=0)
            np.testing.assert_allclose(found.at_nodes[name][-1], values[1], rtol=1e-14, atol=0)


def test_twist_is_the_integral_of_its_density(solved: Solved) -> None:
    for scene in (("moebius_half",), ("ribbon_si",)):
        found = solved(*scene)
        assert found.twist == pytest.approx(found.integral("u3") / (2 * np.pi), rel=1e-13)
