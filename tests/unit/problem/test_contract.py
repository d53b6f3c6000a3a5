"""The contract refuses parts that do not fit, and counts what the conditions must determine."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from analytic import bvp, double_integrator, implicit, rational, switching

from ribbonopt.errors import ModelError
from ribbonopt.problem import BoundaryValueProblem, Phase


def test_points_must_be_one_more_than_phases() -> None:
    problem = rational()
    with pytest.raises(ModelError, match="1 phases need 2 points, found 1"):
        replace(problem, points=problem.points[:1])


def test_dynamics_must_have_the_shape_of_the_state() -> None:
    problem = rational()
    short = replace(problem.phases[0], dynamics=problem.state[0])
    with pytest.raises(ModelError, match=r"phase 0: dynamics .* \(2, 1\), found \(1, 1\)"):
        replace(problem, phases=(short,))


def test_square_problems_need_as_many_algebraic_equations_as_variables() -> None:
    problem = implicit()
    without = replace(problem.phases[0], algebraic=ca.SX(0, 1))
    with pytest.raises(ModelError, match=r"1 algebraic variables need .* found 0"):
        replace(problem, phases=(without,))


@pytest.mark.parametrize("name", ["algebraic", "path"])
def test_phases_must_have_equally_many_equations(name: str) -> None:
    x, z = ca.SX.sym("x"), ca.SX.sym("z", 2)
    first = Phase(x, ca.SX(1), {}, cost=z[0] ** 2, **{name: z})
    second = replace(first, **{name: z[0]})
    with pytest.raises(ModelError, match="phase 1"):
        bvp(x, (first, second), lambda a, b, c: {"start": a - 1}, z=z)


def test_controls_are_free_where_something_is_minimised() -> None:
    assert double_integrator().algebraic.numel() == 1


@pytest.mark.parametrize(
    ("problem", "square"),
    [(rational(), True), (implicit(), True), (switching(), True), (double_integrator(), False)],
    ids=["equations", "algebraic", "phases", "cost"],
)
def test_square_means_equations_only(problem: object, square: bool) -> None:
    assert problem.square is square  # type: ignore[attr-defined]


def test_an_inequality_alone_is_not_square() -> None:
    problem = rational()
    bounded = replace(problem.phases[0], path=problem.state[0] - 10)
    assert not replace(problem, phases=(bounded,)).square


def test_conditions_determine_states_at_one_point_and_constants() -> None:
    assert rational().unknown_count == 2
    assert switching().unknown_count == 3
    assert implicit().unknown_count == 1


def test_outputs_are_evaluated_by_name() -> None:
    problem = rational()
    x = problem.state
    phase = replace(problem.phases[0], outputs={"both": x, "sum": x[0] + x[1]})
    problem = replace(problem, phases=(phase,))
    assert problem.output_sizes == {"both": 2, "sum": 1}
    for names, expected in (
        (("both", "sum"), [3, 4, 7]),
        (("sum",), [7]),
        (("sum", "both"), [7, 3, 4]),
    ):
        (function,) = problem.output_functions(names)
        found = np.array(function([3.0, 4.0], ca.DM(0, 1), ca.DM(0, 1), 0.0))
        np.testing.assert_array_equal(found.ravel(), expected)


def test_what_is_made_of_a_problem_is_made_once_and_belongs_to_it() -> None:
    made = []

    def make(problem: BoundaryValueProblem) -> list[BoundaryValueProblem]:
        made.append(problem)
        return made

    one = rational()
    other = replace(one, state_names=("a", "b"))
    assert one.kept(make) is one.kept(make)
    other.kept(make)
    assert made == [one, other]
