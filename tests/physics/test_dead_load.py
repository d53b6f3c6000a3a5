"""A dead load along the ribbon, end to end: references of two methods, by every formulation."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ribbonopt import Continuation, load_solution, save_solution
from ribbonopt.checks.stability import negative_directions
from ribbonopt.errors import ModelError, SceneError
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import Scene, load_scene, loads_scene
from ribbonopt.solution.solution import Solution

Array = np.ndarray
FORMS = ("inverted", "algebraic", "{type: algebraic, bounds: false}", "differentiated", "energy")
each_form = pytest.mark.parametrize("form", FORMS)
# tip (x, z) and m2(0) of the heavy cantilever, f = -q ex (shooting of order 8, and energy)
HEAVY = {
    1: ((-0.123471401983, 0.991246395347), -0.49693339993),
    5: ((-0.495905044622, 0.846657179954), -2.22689255381),
    50: ((-0.907917123477, 0.245014756321), -9.52846852058),
}
F = np.array([2.0, 4.0, -4.0])
E = np.array([1.0, 2.0, -2.0]) / 3


def heavy(q: float = 5, law: str = "{type: sadowsky}", **more: str) -> Scene:
    """Return a strip clamped along z that bears its own weight along -x."""
    lines = {"formulation": "inverted", "states": "reduced"} | more
    rest = "\n".join(f"{key}: {value}" for key, value in lines.items())
    return loads_scene(
        f"""
name: heavy
law: {law}
parameters: {{q: {q}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free}}
loads: {{force: {{x: -q}}}}
transcription: {{type: collocation, degree: 8, intervals: 20}}
{rest}
"""
    )


@each_form
@pytest.mark.parametrize("law", ["{type: kirchhoff}", "{type: sadowsky}"])
def test_heavy_cantilever_by_every_formulation_from_nothing(form: str, law: str) -> None:
    found = solve(heavy(5, law, formulation=form))
    assert found.verified, found.message
    tip, m2 = HEAVY[5]
    np.testing.assert_allclose(found.sample(1.0, "r")[[0, 2]], tip, atol=1e-10)
    assert found.sample(0.0, "m2") == pytest.approx(m2, abs=1e-10)


@pytest.mark.parametrize("q", HEAVY)
@pytest.mark.parametrize("states", ["reduced", "full", "planar"])
def test_heavy_cantilever_by_every_set_of_states(q: int, states: str) -> None:
    found = solve(heavy(q, states=states))
    tip, m2 = HEAVY[q]
    np.testing.assert_allclose(found.sample(1.0, "r")[[0, 2]], tip, atol=1e-10)
    assert found.sample(0.0, "m2") == pytest.approx(m2, abs=1e-9)
    drift = found.verification.drift
    assert max(drift[name] for name in ("H + f.r", "e.(m + r x n)", "e x n")) < 1e-12
    assert np.isnan([drift[name] for name in ("n", "n_dot_m", "H")]).all()  # none is conserved


def clamps(form: str = "inverted", states: str = "reduced", **more: str) -> Scene:
    rest = "\n".join(f"{key}: {value}" for key, value in more.items())
    return loads_scene(
        f"""
name: clamp-c
law: {{type: sadowsky}}
formulation: {form}
states: {states}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end:
    support: clamped
    position: [0.68, 0.15, 0.31]
    directors: {{rotation_vector: [0, 2.4, 0.6]}}
loads: {{force: [2, 4, -4]}}
transcription: {{type: collocation, degree: 8, intervals: 16}}
{rest}
"""
    )


@each_form
def test_loaded_clamps_by_every_formulation_from_nothing(form: str) -> None:
    check_clamps(solve(clamps(form)))


def test_loaded_clamps_by_the_papers_states() -> None:
    check_clamps(solve(clamps(states="full")))


def check_clamps(found: Solution) -> None:
    assert found.verified, found.message
    n0, m0 = (
        (-4.1881657369, -3.0727523281, -4.7864697120),
        (2.8470743636, 1.7145038741, -0.0415239075),
    )
    np.testing.assert_allclose(found.n0, n0, atol=1e-10)
    np.testing.assert_allclose(found.m0, m0, atol=1e-10)
    np.testing.assert_allclose(found.sample(0.5, "u")[1:], (2.6038842867, 0.8392531311), atol=1e-10)
    s = np.linspace(0, 1, 7)
    o = found.outputs(s)
    np.testing.assert_allclose(o["H"] + o["r"] @ F, -3.3162769178, atol=1e-10)
    about = o["m"] + np.cross(o["r"], o["n"])
    np.testing.assert_allclose(about @ E, 2.1197099756, atol=1e-10)
    weights, r = found.trajectory.stages[2], found.trajectory.at_stages["r"]
    assert found.energy - weights @ r @ F == pytest.approx(3.885127825565, abs=1e-11)


def test_integrated_again_by_code_of_its_own() -> None:
    found = solve(clamps())

    def rates(s: float, y: Array) -> Array:
        d1, d2, d3, n, m = y.reshape(6, 3)[1:]
        m2, m3 = m @ d2, m @ d3
        M = np.hypot(m2, m3)
        p = M + abs(m2)
        u = np.sign(m2) * p**2 / (4 * M) * d2 + m3 * p / (4 * M) * d3
        return np.concatenate([d3, *(np.cross(u, d) for d in (d1, d2, d3)), -F, np.cross(n, d3)])

    start = np.concatenate([np.zeros(3), np.eye(3).ravel(), found.n0, found.m0])
    end = solve_ivp(rates, (0, 1), start, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    last = found.outputs(np.array([1.0]))
    names = ("r", "d1", "d2", "d3", "n", "m")
    np.testing.assert_allclose(end, np.concatenate([last[k][0] for k in names]), atol=1e-8)


def test_mirrored_and_turned() -> None:
    # Gravity to the other side, the clamp turned about its axis: the same shape, mirrored.
    plain, other = solve(heavy(5)), solve(heavy(-5))
    s = np.linspace(0, 1, 9)
    mirror = np.diag([-1.0, 1.0, 1.0])
    np.testing.assert_allclose(other.sample(s, "r"), plain.sample(s, "r") @ mirror, atol=1e-11)


def test_in_si_it_is_a_weight_per_length() -> None:
    # D w / L^3 = 1.2e-4 N/m: q = 5 is 6e-4 N/m.
    sizes = "{length: 0.5, width: 0.02, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.3}"
    rigidity = 2e9 * 1e-12 / 12 / (1 - 0.3**2) * 0.02
    q = 5 * rigidity / 0.5**3
    found = solve(heavy(q, ribbon=sizes, interval="[0, 0.5]"))
    (x, z), m2 = HEAVY[5]
    np.testing.assert_allclose(found.sample(0.5, "r")[[0, 2]], [0.5 * x, 0.5 * z], atol=1e-10)
    assert found.sample(0.0, "m2") == pytest.approx(m2 * rigidity / 0.5, rel=1e-9)


def test_it_is_continued_and_its_stability_judged() -> None:
    stage = "{parameter: parameters.q, from: 1, to: 50}"
    scene = heavy(1, "{type: variational, delta: 0.1}", continuation=stage)
    points = list(Continuation(scene))
    np.testing.assert_allclose(
        points[-1].solution.sample(1.0, "r")[[0, 2]], HEAVY[50][0], atol=1e-9
    )
    assert {point.row["negative"] for point in points} == {0}


def test_a_heavy_column_falls_at_its_critical_length() -> None:
    # Greenhill: straight, f = -q ez; q_c = 7.83734743894.
    line = "loads: {force: {z: -q}}"
    for q, negative in ((7.8, 0), (7.9, 1)):
        text = "\n".join(
            [
                "name: column\nlaw: {type: kirchhoff}\nstates: reduced",
                f"parameters: {{q: {q}}}\n{line}\nguess: {{strains: [0, 0]}}",
                "boundary:\n  start: {support: clamped, position: [0, 0, 0], directors: identity}",
                "  end: {support: free}",
            ]
        )
        found = solve(loads_scene(text))
        assert found.verified
        assert np.abs(found.sample(1.0, "r") - [0, 0, 1]).max() < 1e-12
        assert negative_directions(found) == negative


def test_saved_loaded_and_started_from(tmp_path: Path) -> None:
    found = solve(heavy(5))
    save_solution(found, tmp_path)
    loaded = load_solution(tmp_path)
    np.testing.assert_array_equal(loaded.n0, found.n0)
    assert loaded.scene.loads == found.scene.loads
    more = prepare(heavy(6)).solve(guess=loaded, fallback=False)
    assert more.verified


def test_other_loads_are_another_theta_not_another_problem() -> None:
    prepared = prepare(heavy(1))
    for q, (tip, _) in HEAVY.items():
        found = prepared.solve(heavy(q))
        np.testing.assert_allclose(found.sample(1.0, "r")[[0, 2]], tip, atol=1e-10)
    with pytest.raises(ModelError, match="more than its numbers"):
        prepared.solve(loads_scene("name: x\nlaw: {type: sadowsky}\nboundary: {}"))


@pytest.mark.parametrize(
    ("override", "error", "match"),
    [
        ("loads={weight: 3}", SceneError, r"loads\.weight: .*force"),
        ("loads={force: {q: 3}}", SceneError, r"loads\.force"),
        ("loads={force: [1, 2]}", SceneError, r"loads\.force"),
        ("loads={force: {x: unknown}}", SceneError, r"loads\.force\.x.*unknown"),
    ],
)
def test_bad_loads_are_refused(
    tmp_path: Path, override: str, error: type[Exception], match: str
) -> None:
    path = tmp_path / "heavy.yaml"
    path.write_text(
        "name: heavy\nlaw: {type: sadowsky}\nboundary: {start: {support: clamped, "
        "position: [0, 0, 0], directors: identity}, end: {support: free}}\n",
        encoding="utf-8",
    )
    with pytest.raises(error, match=match):
        prepare(load_scene(path, [override]))


@each_form
def test_a_load_on_a_free_start(form: str) -> None:
    text = f"""
name: upside-down
law: {{type: kirchhoff}}
formulation: {form}
boundary:
  start: {{support: free}}
  end: {{support: clamped, position: [0, 0, 1], directors: identity}}
loads: {{force: {{x: 1}}}}
transcription: {{type: collocation, degree: 6, intervals: 12}}
"""
    found = solve(loads_scene(text))
    assert found.verified
    assert np.abs(found.n0).max() < 1e-9
    assert found.sample(0.0, "dot(r, ex)") == pytest.approx(0.123471401983, abs=1e-9)
