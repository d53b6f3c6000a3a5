"""Bars at layers: elements that step over one, stiff arcs between nodes, and rounding.

Each case stands for a kind that once was told a bar far below its error. The truth is from the
independent integrator.
"""

from dataclasses import replace

import independent
import numpy as np
import pytest

from ribbonopt.accuracy.estimate import analyse, estimate_error, relative_error
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

Array = np.ndarray
END = "  end: {{support: clamped, position: {}, directors: {{quaternion: {}}}}}\n"
CLAMPS = {
    # sign changes of m2 thinner than the spacing of the stages
    "layer": (
        [0.04565873644194006, -0.039742021553987754, -0.018086907913453597],
        [-0.6166203078877909, 0.55915650457392, 0.46352504827697544, 0.3037563643989532],
    ),
    # arcs next to m2 = 0, along which the law is stiff
    "stiff": (
        [0.49401684003735824, -0.7017324343895466, -0.3803101859430068],
        [0.24885222924377245, -0.5320188382699241, -0.4110972036660829, -0.6971568065107394],
    ),
    "inflection": ([0.3, 0.06, 0.9], [0.925, 0.0, -0.292, 0.244]),
}


def clamped(name: str, law: str, tolerance: float) -> Scene:
    position, q = CLAMPS[name]
    q = (np.array(q) / np.linalg.norm(q)).tolist()
    text = f"name: {name}\nlaw: {law}\nboundary:\n"
    text += "  start: {support: clamped, position: [0, 0, 0], directors: identity}\n"
    return loads_scene(text + END.format(position, q) + f"tolerance: {tolerance}\n")


def truth_of(found: Solution) -> independent.Truth:
    law = found.scene.law
    number = getattr(law, "epsilon", getattr(law, "delta", 0.0))

    def start(s: Array) -> tuple[Array, Array]:
        o = found.outputs(s)
        return o["r"], np.stack([o["d1"], o["d2"], o["d3"]], axis=1)

    places, frames = start(np.array([1.0]))
    kind = independent.Law(law.type, number)
    truth = independent.polish(kind, found.n0, found.m0, start, (places[0], frames[0]))
    assert truth.verdict == "found", truth.reason
    return truth


def true_errors(found: Solution, truth: independent.Truth) -> dict[str, float]:
    s = np.linspace(0, 1, 1201)
    ours, theirs = found.outputs(s), truth.path.at(s)
    errors = {
        "n0": np.abs(found.n0 - truth.path.n).max(),
        "m0": np.abs(found.m0 - truth.path.m0).max(),
        "H0": abs(found.start["H"] - theirs["H"][0]),
        "energy": abs(found.energy - truth.path.energy),
        "states": max(np.abs(ours[k] - theirs[k]).max() for k in ("r", "d1", "d2", "d3")),
        "u": np.abs(ours["u"] - theirs["u"]).max(),
    }
    return {name: float(error) for name, error in errors.items()}


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("layer", "{type: variational, delta: 0.01}"),
        ("layer", "{type: variational, delta: 0.003}"),
        ("inflection", "{type: variational, delta: 0.002}"),
        ("inflection", "{type: regularized, epsilon: 0.0003}"),
        ("stiff", "{type: regularized, epsilon: 0.001}"),
        ("stiff", "{type: variational, delta: 0.005}"),
    ],
)
@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_bars_hold_at_layers_and_between_nodes(name: str, law: str, tolerance: float) -> None:
    found = solve(clamped(name, law, tolerance))
    assert found.verified, found.message
    bars, errors = estimate_error(found), true_errors(found, truth_of(found))
    for what, error in errors.items():
        assert error <= bars[what] + 1e-12, what
    strains = float(np.abs(found.at_stages["u"]).max())
    loads = max(np.abs(found.n0).max(), np.abs(found.m0).max())
    assert errors["states"] <= tolerance
    assert errors["u"] <= tolerance * strains
    assert errors["H0"] <= tolerance * max(loads, abs(found.start["H"]))


def test_the_invariant_of_the_layer_case() -> None:
    found = solve(clamped("layer", "{type: variational, delta: 0.01}", 1e-6))
    error = abs(found.start["H"] - 47.32158726)
    assert error <= estimate_error(found)["H0"] + 1e-8


def test_a_mesh_that_steps_over_a_layer_gives_no_bar() -> None:
    """On ten intervals both schemes agree to 1e-6 and are wrong by more: that is not known."""
    scene = clamped("layer", "{type: variational, delta: 0.001}", 1e-6)
    found = solve(replace(scene, tolerance=None))
    assert np.isnan(list(estimate_error(found).values())).all()
    summary = summarize(found)
    assert set(summary["error_estimate"].values()) == {None}
    text = report(summary)
    assert "+- not known" in text
    assert "its errors not known (see the warnings)" in text
    assert any("give a tolerance, or take more intervals" in words for words in summary["warnings"])


def half_with(epsilon: float, tolerance: float) -> Solution:
    text = f"""
name: half
law: {{type: regularized, epsilon: {epsilon}}}
interval: [0, 0.5]
boundary:
  start: {{position: [0, 0, 0], directors: identity, force: {{d1: 0}}, moment: {{d1: 0}}}}
  end: {{position: {{y: 0, z: 0}}, d1: {{x: 0}}, d3: {{x: 0}}}}
tolerance: {tolerance}
"""
    return solve(loads_scene(text))


@pytest.mark.parametrize("epsilon", [1e-4, 1e-5, 1e-6])
def test_bars_hold_at_a_layer_at_the_end(epsilon: float) -> None:
    found = half_with(epsilon, 1e-6)
    law = independent.Law("regularized", epsilon)
    start = independent.shot(law, found.n0, found.m0, np.zeros(3), np.eye(3), 0.5)

    def ends(r: Array, d: Array, n: Array, m0: Array) -> Array:
        return np.array([r[1], r[2], d[0, 0], d[2, 0], n[0], m0[0]])

    truth = independent.polish(law, found.n0, found.m0, start, ends, length=0.5, kinds=(1,))
    assert truth.verdict == "found", truth.reason
    bars = estimate_error(found)
    assert np.abs(found.n0 - truth.path.n).max() <= bars["n0"] + 1e-11
    assert np.abs(found.m0 - truth.path.m0).max() <= bars["m0"] + 1e-11


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("inflection", "{type: kirchhoff, B2: 1, B3: 2}"),
        ("inflection", "{type: variational, delta: 0.1}"),
        ("inflection", "{type: regularized, epsilon: 0.01}"),
    ],
)
def test_a_tolerance_beyond_rounding_is_told(name: str, law: str) -> None:
    """The best mesh is kept: where every element is exact, finer ones only add their rounding."""
    found = solve(clamped(name, law, 1e-13))
    assert found.status is Status.ROUNDED, found.message
    assert "rounding" in found.message
    assert "raise the tolerance" in found.message
    assert len(found.nodes) - 1 <= 200
    assert relative_error(found)[0] < 1e-11
    assert analyse(found).local.max() < 1e-13
