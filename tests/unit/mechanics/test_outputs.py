"""The outputs of a cross section are exactly the quantities that the scene's list names."""

from pathlib import Path

import casadi as ca
import numpy as np

from ribbonopt.mechanics.outputs import outputs
from ribbonopt.pipeline.prepared import solve
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import Boundary, Sadowsky, Scene, load_scene
from ribbonopt.scene.formulas.parsing import parse_equation
from ribbonopt.scene.formulas.words import RESERVED
from ribbonopt.scene.quantities import ANSWERS, AT_ENDS, OUTPUTS, QUANTITIES, VECTORS, dimension

CONFIGS = Path(__file__).parents[3] / "configs"


def test_outputs_are_those_listed() -> None:
    ribbon = Ribbon.of(Posed.of(Scene("any", Sadowsky(), Boundary())))
    x, c = (ca.SX.sym("x", len(names)) for names in (ribbon.model.states, ribbon.model.constants))
    section = ribbon.section(x, c)
    had = outputs(section, ribbon.law, section.u)
    shapes = {1: "scalar", 3: "vector"}
    assert {name: shapes[found.numel()] for name, found in had.items()} == {
        name: quantity.shape for name, quantity in QUANTITIES.items()
    }


def test_formulas_know_all_but_the_checks() -> None:
    assert QUANTITIES.keys() - OUTPUTS.keys() == {"law_residual", "orthonormality"}
    assert AT_ENDS.keys() <= RESERVED
    for name, shape in AT_ENDS.items():
        right = "[0, 0, 0]" if shape == "vector" else "0"
        assert parse_equation(f"{name}(start) = {right}").shape == shape


def test_names_of_files_and_columns_stay() -> None:
    assert VECTORS == ("r", "d1", "d2", "d3", "n", "m", "u")
    start = "n0x n0y n0z m0x m0y m0z u1 u2 u3".split()
    assert ANSWERS == ("energy", "potential", "H0", *start)


def test_dimensions() -> None:
    assert dimension("m2") == dimension("m") == (1, 1)
    assert dimension("u1") == (-1, 0)
    assert dimension("n_dot_m") == tuple(map(sum, zip(dimension("n"), dimension("m"), strict=True)))
    assert dimension("deflection") == (0, 0)


def test_u1_is_sampled_like_the_other_strains() -> None:
    solution = solve(load_scene(CONFIGS / "helix.yaml"))
    assert np.abs(solution.sample([0.0, 0.5], "u1 - u.x")).max() < 1e-9
