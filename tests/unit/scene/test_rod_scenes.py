"""What a scene says of a rod: units, limits, messages, and back to a file."""

from dataclasses import dataclass

import numpy as np
import pytest

from ribbonopt import solve
from ribbonopt.errors import SceneError
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.scene import Boundary, Rod, Scene, dump_scene, loads_scene, validate_scene
from ribbonopt.scene.units import in_special_units

#: clamp C of SCIENCE-NEXT, section 4, in units of length L, stiffness B D w and D w / L^2 = F
CLAMP = """
name: clamp
law: {{type: rod, B: [{B1}, {B2}, {B3}], natural: [{k1}, {k2}, {k3}]}}
interval: [0, {L}]
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end:
    support: clamped
    position: [{x}, {y}, {z}]
    directors: {{rotation_vector: [0, 2.4, 0.6]}}
tolerance: 1e-11
{sizes}
"""
N0 = np.array([-1.8666739446, 0.5032061909, -0.5680288001])
M0 = np.array([0.1092371051, 0.8535486222, 1.2298306407])


def clamp(L: float = 1.0, B: float = 1.0, sizes: str = "") -> Scene:
    stiffnesses = {f"B{i + 1}": B * b for i, b in enumerate((3.0, 1.0, 0.8))}
    strains = {f"k{i + 1}": k / L for i, k in enumerate((0.4, 1.0, -0.5))}
    places = {name: L * value for name, value in zip("xyz", (0.68, 0.15, 0.31), strict=True)}
    return loads_scene(CLAMP.format(L=L, sizes=sizes, **stiffnesses, **strains, **places))


@pytest.mark.parametrize(("L", "B"), [(1.0, 1.0), (250.0, 3e-5), (2e-4, 7e6)])
def test_any_size_and_stiffness(L: float, B: float) -> None:
    found = solve(clamp(L, B))
    assert found.verified
    np.testing.assert_allclose(found.n0 * L**2 / B, N0, rtol=0, atol=2e-10)
    np.testing.assert_allclose(found.m0 * L / B, M0, rtol=0, atol=2e-10)
    assert found.energy * L / B == pytest.approx(1.505672122148, abs=1e-10)


def test_in_si() -> None:
    """D = 12 x 1e-3 / (12 x 0.75) and w = 0.375: D w = 5e-4; L = 2."""
    sizes = "ribbon: {length: 2, width: 0.375, thickness: 0.1, youngs_modulus: 12,"
    this = clamp(2.0, 4.0, f"{sizes} poisson_ratio: 0.5}}")
    special = in_special_units(this).law
    assert isinstance(special, Rod)
    np.testing.assert_allclose(special.B, (12, 4, 3.2), rtol=1e-15)
    np.testing.assert_allclose(special.natural, (0.4, 1.0, -0.5), rtol=1e-15)
    found = solve(this)
    np.testing.assert_allclose(found.n0, 4 * 1.25e-4 * N0, rtol=0, atol=1e-13)
    np.testing.assert_allclose(found.m0, 4 * 2.5e-4 * M0, rtol=0, atol=2e-13)
    assert found.sample(1.0, "u1") == pytest.approx(0.3246011853 / 2, abs=1e-9)


def test_a_report_names_its_numbers() -> None:
    text = report(summarize(solve(clamp())))
    assert "law rod (B = (3, 1, 0.8), natural = (0.4, 1, -0.5)), inverted formulation" in text
    assert "strains u(0), directors  (0.43641236837" in text


@pytest.mark.parametrize(
    ("law", "message"),
    [
        ("B: [1, 2]", r"law\.B: found \[1, 2\], expected a list of 3 items"),
        ("B: 2", r"law\.B: found 2, expected a list of 3 items, each a number > 0"),
        ("B: [1, 0, 2]", r"law\.B\.1: found 0, expected a number > 0"),
        ("B: [1, 1, -1]", r"law\.B\.2: found -1, expected a number > 0"),
        ("B1: 3", r"law\.B1: unknown key; did you mean 'B'\?"),
        ("natural: [0, 1]", r"law\.natural: found \[0, 1\], expected a list of 3 items"),
        ("natural: [0, k, 1]", r"law\.natural\.1: found 'k', expected a number"),
        ("natural: [0, .nan, 1]", r"law\.natural\.1: found"),
        ("B: [1e-14, 1, 1]", r"law\.B\.0: found 1e-14, which is 1e-14 times law\.B\.1; expected"),
        ("B: [1, 1, 1e14]", r"law\.B\.2: found 1e\+14, which is 1e\+14 times law\.B\.1"),
        ("natural: [0, 0, 1e9]", r"law\.natural\.2: found 1e\+09, expected at most 1e\+06 1 / L"),
    ],
)
def test_bad_numbers(law: str, message: str) -> None:
    text = f"{{name: a, law: {{type: rod, {law}}}, boundary: {{}}}}"
    with pytest.raises(SceneError, match=message):
        loads_scene(text)


def test_written_and_read_again() -> None:
    this = Scene("a", Rod(B=(3, 1, 0.8), natural=(0.4, 1, -0.5)), Boundary())
    assert loads_scene(dump_scene(this)) == validate_scene(this)


def test_a_class_of_the_same_name_is_still_a_users_own() -> None:
    @dataclass(frozen=True)
    class Kirchhoff:
        B: float = 1.0
        type: str = "kirchhoff"

        def constitutive(self, numbers: object, position: object) -> object:
            return None

    assert isinstance(validate_scene(Scene("a", Kirchhoff(), Boundary())).law, Kirchhoff)
