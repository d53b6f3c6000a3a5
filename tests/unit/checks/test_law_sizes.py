"""What is told of sizes that a law says itself."""

import pytest

from ribbonopt import solve
from ribbonopt.checks.law_sizes import law_problems
from ribbonopt.scene import loads_scene

SCENE = """
name: sizes
law: {law}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: [{x}, 0, {z}], directors: {{rotation_vector: [0, 2, 0]}}}}
"""
SI = "ribbon: {length: 0.5, width: 0.01, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.4}"


def told(law: str, more: str = "", length: float = 1.0) -> list[str]:
    text = SCENE.format(law=law, x=0.6 * length, z=0.4 * length) + more
    return law_problems(solve(loads_scene(text)))


def extensible(width: float, thickness: float) -> str:
    return f"{{type: extensible, width: {width}, thickness: {thickness}, poisson_ratio: 0.3}}"


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ("sadowsky", []),
        ("{type: wunderlich, width: 0.45}", []),
        ("{type: wunderlich, width: 0.55}", ["length is only 1.82 times the width"]),
        (extensible(0.09, 0.005), []),
        (extensible(0.2, 0.02), ["length is only 5 times the width"]),
        (extensible(0.05, 0.1), ["width is only 0.5 times the thickness"]),
    ],
)
def test_sizes_that_are_none_of_a_ribbon(law: str, words: list[str]) -> None:
    found = told(law)
    assert len(found) == len(words)
    assert all(some in one for some, one in zip(words, found, strict=True))


@pytest.mark.parametrize(
    ("law", "names"),
    [
        ("wunderlich", []),
        ("{type: wunderlich, width: 0.01}", []),
        ("{type: wunderlich, width: 0.02}", ["law.width = 0.02 is not ribbon.width = 0.01"]),
        ("{type: extensible, poisson_ratio: 0.3}", ["law.poisson_ratio = 0.3"]),
        (extensible(0.01, 2e-4), ["law.thickness = 0.0002", "law.poisson_ratio"]),
        ("{type: sano, zeta: 0.3}", []),
    ],
)
def test_sizes_that_are_not_those_of_the_ribbon(law: str, names: list[str]) -> None:
    found = told(law, SI, 0.5)
    assert len(found) == len(names)
    assert all(name in one for name, one in zip(names, found, strict=True))
