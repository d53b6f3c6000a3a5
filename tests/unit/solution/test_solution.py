"""Solutions: sampled by name or formula, and summarised."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import load_scene, loads_scene
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
SCALARS = ("u2", "u3", "eta", "n1", "n2", "n3", "m1", "m2", "m3", "energy", "H")
VECTORS = ("r", "d1", "d2", "d3", "n", "m", "u")
KEYS = {
    "name", "status", "verified", "message", "formulation", "transcription", "law", "n0", "m0",
    "u0", "H0", "energy", "length", "invariant_drift", "error_estimate", "switch_points",
    "half_twists", "unknowns", "intervals", "degree", "iterations", "path", "skipped", "timings",
    "versions",
}  # fmt: skip
DRIFTS = {"n", "n_dot_m", "H", "orthonormality"}
ESTIMATES = {"n0", "m0", "u0", "energy", "states"}


@pytest.fixture(scope="module")
def half(solved: Solved) -> Solution:
    return solved("moebius_half")


@pytest.mark.parametrize("name", SCALARS)
def test_scalars_have_one_number_per_arclength(half: Solution, name: str) -> None:
    assert half.sample(np.linspace(0, 0.5, 7), name).shape == (7,)
    assert half.sample(0.2, name).shape == ()


@pytest.mark.parametrize("name", VECTORS)
def test_vectors_have_three_numbers_per_arclength(half: Solution, name: str) -> None:
    assert half.sample(np.linspace(0, 0.5, 7), name).shape == (7, 3)
    assert half.sample(0.2, name).shape == (3,)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("m2 / m3", lambda f: f("m2") / f("m3")),
        ("dot(d1, ex)", lambda f: f("d1")[:, 0]),
        ("norm(m)", lambda f: np.linalg.norm(f("m"), axis=1)),
        ("cross(d1, d2) - d3", lambda f: 0 * f("r")),
        ("r.z + 2*pi", lambda f: f("r")[:, 2] + 2 * np.pi),
        ("[u2, 0, u3**2]", lambda f: np.stack([f("u2"), 0 * f("u2"), f("u3") ** 2], axis=1)),
        ("sqrt(m2**2 + m3**2)", lambda f: np.hypot(f("m2"), f("m3"))),
        ("abs(u3) - exp(-u2)", lambda f: np.abs(f("u3")) - np.exp(-f("u2"))),
        ("dot(m, d2) - m2", lambda f: 0 * f("m2")),
        ("2", lambda f: 2 + 0 * f("m2")),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_formulas_of_outputs(half: Solution, formula: str, expected: Any) -> None:
    s = np.linspace(0, 0.49, 11)
    value = expected(lambda name: half.sample(s, name))
    np.testing.assert_allclose(half.sample(s, formula), value, atol=1e-12)
    np.testing.assert_allclose(half.sample(s[3], formula), value[3], atol=1e-12)


def test_no_arclengths_give_no_values(half: Solution) -> None:
    assert half.sample([], "u2").shape == (0,)
    assert half.sample(np.empty(0), "r").shape == (0, 3)


@pytest.mark.parametrize("s", [-1e-6, 0.6, [0.1, 0.6], np.nan, np.inf])
def test_arclengths_outside_the_interval_are_refused(half: Solution, s: Any) -> None:
    with pytest.raises(ValueError, match=r"expected in \[0.0, 0.5\]"):
        half.sample(s, "u2")


@pytest.mark.parametrize("text", ["nonsense", "m2 +", "__import__('os')", "m / m", "d1(start)"])
def test_expressions_that_do_not_parse_are_refused(half: Solution, text: str) -> None:
    with pytest.raises(ValueError, match="formula"):
        half.sample(0.1, text)


def test_samples_at_nodes_are_the_unknowns(half: Solution) -> None:
    nodes, _, _ = half.dense.blocks.layout.unpack(half.dense.w)
    np.testing.assert_array_equal(half.sample(half.nodes, "r"), nodes[:, :3])


def test_strains_are_the_turning_of_the_directors(half: Solution) -> None:
    s, h = np.linspace(0.01, 0.45, 9), 1e-5
    turning = (half.sample(s + h, "d3") - half.sample(s - h, "d3")) / (2 * h)
    expected = half.sample(s, "u2")[:, None] * half.sample(s, "d1")
    np.testing.assert_allclose(turning, expected, atol=1e-7)


def test_energy_is_the_integral_of_its_density(half: Solution) -> None:
    x, weights = np.polynomial.legendre.leggauss(60)
    density = half.sample((1 + x) / 4, "u2**2*(1 + eta**2)**2/2")  # (2.8)
    assert half.energy == pytest.approx(weights @ density / 4, rel=1e-9)


def test_interval_may_start_anywhere(configs: Path, half: Solution) -> None:
    moved = solve(load_scene(configs / "moebius_half.yaml", ["interval=[2, 2.5]"]))
    np.testing.assert_allclose(moved.sample(2.3, "r"), half.sample(0.3, "r"), atol=1e-10)
    assert moved.nodes[0] == 2


def test_summary_keeps_its_keys(half: Solution) -> None:
    summary = summarize(half)
    assert set(summary) >= KEYS
    assert set(summary["invariant_drift"]) == DRIFTS
    assert set(summary["error_estimate"]) >= ESTIMATES
    assert set(summary["timings"]) >= {"build", "evaluate", "linear", "total"}
    assert summary["status"] == "converged"
    assert summary["verified"] is True
    assert summary["length"] == 0.5
    assert summary["law"]["type"] == "sadowsky"
    assert [len(summary[key]) for key in ("n0", "m0", "u0")] == [3, 3, 3]


def test_summary_is_plain_json(half: Solution) -> None:
    summary = summarize(half)
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary


def test_timings_add_up(half: Solution) -> None:
    parts = dict(half.timings)
    total = parts.pop("total")
    assert all(value >= 0 for value in parts.values())
    assert sum(parts.values()) == pytest.approx(total, rel=1e-9)


def test_summary_of_a_failed_solve_says_what_is_not_known(configs: Path) -> None:
    scene = load_scene(configs / "moebius_half.yaml", ["solver={type: newton, max_iterations: 1}"])
    summary = summarize(solve(scene))
    assert summary["status"] == "max_iterations"
    assert summary["verified"] is False
    assert set(summary["error_estimate"].values()) == {None}
    assert set(summary["invariant_drift"].values()) == {None}
    json.dumps(summary, allow_nan=False)


def test_moments_about_another_point_are_not_taken_as_they_are(configs: Path) -> None:
    """The same ribbon elsewhere: its constants are those about where it starts now."""
    found, elsewhere = (
        prepare(load_scene(configs / "helix_clamped.yaml", overrides))
        for overrides in ([], ["boundary.start.position=[0.5, -0.3, 0.2]"])
    )
    solution, fractions = found.solve(), np.linspace(0, 1, 3)
    for prepared, same in ((found, True), (elsewhere, False)):
        theta = prepared.posed().values
        taken = solution.unknowns_for(prepared.problem, theta, fractions)
        assert (taken is not None) == same
        # Either way the guess bears what the solution bears.
        w, p = prepared.start(solution)
        nodes, _, c = prepared.nlp.layout.unpack(w)
        x = prepared.ribbon.section_function(nodes[0], c, prepared.nlp.layout.theta(p), 0.0)
        np.testing.assert_allclose(np.array(x[5]).ravel(), solution.m0, atol=1e-9)


def test_between_nodes_a_stiff_ribbon_is_as_exact_as_at_them() -> None:
    """Where neighbouring solutions part fast, no step from one node may follow another of them."""
    text = """
name: stiff
law: {type: regularized, epsilon: 0.001}
boundary:
  start: {position: [0, 0, 0], directors: identity}
  end:
    position: [0.49401684003735824, -0.7017324343895466, -0.3801103859430068]
    directors:
      quaternion: [0.24885222924377245, -0.532018838269922, -0.411097203666083, -0.69715680651074]
switching: "off"
"""
    exact = solve(loads_scene(text + "tolerance: 1e-6\n"))
    mesh = "transcription: {type: collocation, degree: 6, intervals: 20}\n"
    found = prepare(loads_scene(text + mesh)).solve(guess=exact, fallback=False)
    assert found.status.converged and exact.verified, (found.message, exact.message)
    assert found.dense.growth.max() > 30
    off = []
    for s in (found.nodes, np.linspace(0, 1, 3001)):
        ours, true = found.outputs(s), exact.outputs(s)
        off.append(max(float(np.abs(ours[k] - true[k]).max()) for k in ("r", "d1", "d2", "d3")))
    assert 1e-4 < off[1] < 10 * off[0]
