"""Any unit of length, and a rod however soft: the same digits as on [0, 1], error bars too."""

import re
from pathlib import Path

import numpy as np
import pytest

from ribbonopt import Continuation
from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.scene.units import in_special_units, units_of
from ribbonopt.solution.solution import Solution

CLAMPED = "boundary:\n  start: {support: clamped, position: [0, 0, 0], directors: identity}\n"
TURNED = "{turns: [{x: 0.7}, {y: -0.9}, {z: 1.5}]}"
#: numbers with dimensions in angle brackets: lengths L, forces F, moments M, B; F = B / L^2
SCENES = {
    "clamps": "law: {type: sadowsky}\ninterval: [0, <1 L>]\n"
    + CLAMPED
    + "  end: {support: clamped, position: [<0.3 L>, <0.2 L>, <0.5 L>], directors: "
    + TURNED
    + "}\n",
    "rod": "law: {type: kirchhoff, B2: <1 B>, B3: <1.5 B>}\ninterval: [0, <1 L>]\n"
    + CLAMPED
    + "  end: {support: clamped, position: [<0.3 L>, <0.2 L>, <0.5 L>], directors: "
    + TURNED
    + "}\n",
    "own weight": "law: {type: kirchhoff, B2: <1 B>, B3: <1.5 B>}\ninterval: [<2 L>, <3 L>]\n"
    + CLAMPED
    + "  end: {support: free, force: [0, 0, 0]}\nloads: {force: [<3 F/L>, 0, 0]}\n",
    "an equation": "law: {type: sadowsky}\ninterval: [0, <1 L>]\n"
    + CLAMPED
    + "  end: {position: {x: 0, y: 0}, directors: identity}\n"
    + "  also: ['dot(r(end), ez) = <0.75 L>']\n"
    + "guess: {force: [0, 0, <-45 F>], moment: [0, <6.5 M>, 0]}\n",
    "half Moebius": "law: {type: variational, delta: 0.1}\ninterval: [0, <0.5 L>]\n"
    "boundary:\n"
    "  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}, moment: {d1: 0}}\n"
    "  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}\n",
}
SIZES = {"L": 1, "F": -2, "M": -1, "F/L": -3, "B": 0}
STIFF = {"F", "M", "F/L", "B"}


def scaled(text: str, length: float, stiffness: float) -> Scene:
    """Return the scene of a text with its numbers in another unit of length and of stiffness."""

    def number(found: re.Match[str]) -> str:
        unit = length ** SIZES[found[2]] * (stiffness if found[2] in STIFF else 1.0)
        return repr(float(found[1]) * unit)

    return loads_scene("name: a\ntolerance: 1e-7\n" + re.sub("<(.+?) (.+?)>", number, text))


def dimensionless(solution: Solution, length: float, stiffness: float) -> dict[str, object]:
    """Return what a solution says, bars too, as if L = B = 1."""
    force = stiffness / length**2
    errors = estimate_error(solution)
    a, b = solution.scene.interval
    o = solution.outputs(a + (b - a) * np.linspace(0, 1, 11))
    return {
        "energy": solution.energy / (force * length),
        "n": o["n"] / force,
        "m": o["m"] / (force * length),
        "r": o["r"] / length,
        "u": o["u"] * length,
        "H": o["H"] / force,
        "bars": [errors[k] / unit for k, unit in (("n0", force), ("m0", force * length))],
        "bar of u": errors["u0"] * length,
    }


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("length", [1e-3, 12.0, 1e3])
def test_the_unit_of_length_changes_no_digit(name: str, length: float) -> None:
    rod = "<1 B>" in SCENES[name]
    stiffness = 1e-9 if rod else 1.0
    near = solve(scaled(SCENES[name], 1.0, 1.0))
    far = solve(scaled(SCENES[name], length, stiffness))
    assert near.verified, near.message
    assert far.verified, far.message
    ours, theirs = dimensionless(far, length, stiffness), dimensionless(near, 1.0, 1.0)
    for key in ("energy", "n", "m", "r", "u", "H"):
        size = float(np.abs(theirs[key]).max())
        np.testing.assert_allclose(ours[key], theirs[key], rtol=0, atol=1e-7 * size + 1e-13)
    # Bars are of the same size, down to rounding: the same meshes, to rounding of the numbers.
    for key in ("bars", "bar of u"):
        np.testing.assert_allclose(ours[key], theirs[key], rtol=1.0, atol=1e-9)


def test_digits_are_those_of_algebra() -> None:
    """A planar roll of length L under a moment M = 2 pi B / L: E = 2 pi^2 B / L, tip at zero."""
    for length, stiffness in ((1e3, 1e-9), (1e-3, 1e6), (1.0, 1e-9)):
        moment = 2 * np.pi * stiffness / length
        scene = loads_scene(
            f"name: roll\nlaw: {{type: kirchhoff, B2: {stiffness!r}, B3: {2 * stiffness!r}}}\n"
            f"interval: [0, {length!r}]\n{CLAMPED}"
            f"  end: {{support: free, moment: [0, {moment!r}, 0]}}\n"
        )
        found = solve(scene)
        assert found.verified, found.message
        assert found.energy == pytest.approx(2 * np.pi**2 * stiffness / length, rel=1e-12)
        assert np.abs(found.sample(length, "r")).max() < 1e-9 * length


def test_units_go_over_continuously_and_are_1_inside() -> None:
    sizes = np.concatenate([np.geomspace(1e-6, 1e6, 25), [1e-2, 10.0, 10.0 + 1e-12]])
    for size in sizes:
        scene = scaled(SCENES["rod"], float(size), float(size))
        special = in_special_units(scene)
        assert units_of(special).length == units_of(special).force == 1
        assert in_special_units(special) is special
        (start, end), law = special.interval, special.law
        assert 1e-2 <= end - start <= 10
        assert 1e-2 * (1 - 1e-12) <= law.B2 <= 1e2  # type: ignore[union-attr]
        near = units_of(scaled(SCENES["rod"], float(size * (1 + 1e-9)), float(size)))
        assert near.length == pytest.approx(units_of(scene).length, rel=1e-8)


def test_files_are_in_the_units_of_the_scene(tmp_path: Path) -> None:
    scene = scaled(SCENES["clamps"], 1e3, 1.0)
    found = solve(scene)
    save_solution(found, tmp_path)
    with np.load(tmp_path / "solution.npz") as data:
        np.testing.assert_allclose(data["r"][-1], [300, 200, 500], rtol=1e-9)
        np.testing.assert_allclose(data["m"][0], found.m0, rtol=1e-12)
    again = load_solution(tmp_path)
    s = np.linspace(0, 1e3, 7)
    np.testing.assert_allclose(again.sample(s, "n"), found.sample(s, "n"), rtol=1e-12)
    assert summarize(again)["energy"] == pytest.approx(found.energy, rel=1e-12)


def test_a_branch_is_the_same_in_any_unit_of_length() -> None:
    """A clamped strip that is shortened: bow over length and force times length squared."""
    found = []
    for length in (1.0, 1e3):
        branch = list(
            Continuation(
                scaled(
                    "law: {type: sadowsky}\nparameters: {gap: <0.9 L>}\ninterval: [0, <1 L>]\n"
                    + CLAMPED
                    + "  end: {support: clamped, position: [0, 0, gap], directors: identity}\n"
                    + "continuation: {parameter: parameters.gap, from: <0.9 L>, to: <0.6 L>}\n",
                    length,
                    1.0,
                )
            )
        )
        found.append([(p.position / length, p.solution.n0[2] * length**2) for p in branch])
    np.testing.assert_allclose(found[1], found[0], rtol=1e-7)


def test_a_length_that_grows_out_of_its_unit_is_followed(tmp_path: Path) -> None:
    """The tip force 1 on a cantilever that grows from 1 to 40: m2(0)^2 / 2 = sin(angle of tip)."""
    scene = loads_scene(
        "name: growing\nlaw: {type: sadowsky}\ninterval: [0, 1]\n"
        + CLAMPED
        + "  end: {support: free, force: [1, 0, 0]}\ntolerance: 1e-7\n"
        + "continuation: {parameter: interval.end, from: 1, to: 40, largest: 2}\n"
    )
    points = list(Continuation(scene))
    assert points[-1].position == 40
    for point in points:
        solution = point.solution
        end = solution.scene.interval[1]
        sine = float(solution.sample(end, "dot(d3, ex)"))
        assert solution.start["m2"] ** 2 / 2 == pytest.approx(sine, rel=1e-5, abs=1e-7)
    save_solution(points[-1].solution, tmp_path)
    np.testing.assert_allclose(load_solution(tmp_path).m0, points[-1].solution.m0, rtol=1e-12)
