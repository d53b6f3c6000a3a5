"""Gravity in SI: the weight per length of the density, at the width there is."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ribbonopt import Continuation
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.solution.potential import potential
from ribbonopt.solution.solution import Solution

Array = np.ndarray
SIZES = "length: 0.5, width: 0.02, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.3"
RIGIDITY = 2e9 * 1e-12 / 12 / (1 - 0.3**2) * 0.02


def test_gravity_is_the_weight_of_the_density() -> None:
    # q = 5 of the reference, by a density that gives it.
    density = 5 * RIGIDITY / 0.5**3 / (0.02 * 1e-4 * 9.81)
    found = solve(film(density))
    np.testing.assert_allclose(
        found.sample(0.5, "r")[[0, 2]],
        0.5 * np.array([-0.495905044622, 0.846657179954]),
        atol=1e-10,
    )
    assert potential(found) == pytest.approx(-0.55803344042 * RIGIDITY / 0.5, rel=1e-9)
    assert summarize(found)["conserved"]["H + f.r"] == pytest.approx(found.start["H"], rel=1e-12)


@pytest.mark.parametrize(("form", "states"), [("inverted", "reduced"), ("energy", "reduced")])
def test_gravity_pulls_at_the_width_there_is(form: str, states: str) -> None:
    density = 5 * RIGIDITY / 0.5**3 / (0.02 * 1e-4 * 9.81)
    found = solve(film(density, width="'1 - 1.4*s'", formulation=form, states=states))
    tip = 0.5 * np.array([-0.326452366854, 0.936274162831])
    np.testing.assert_allclose(found.sample(0.5, "r")[[0, 2]], tip, atol=1e-10)


def film(density: float, **more: str) -> Scene:
    rest = "".join(f"{key}: {value}\n" for key, value in more.items())
    return loads_scene(
        f"""
name: film
law: {{type: sadowsky}}
ribbon: {{{SIZES}, density: {density}}}
gravity: [-9.81, 0, 0]
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free}}
transcription: {{type: collocation, degree: 8, intervals: 16}}
{rest}
"""
    )


@pytest.mark.slow
def test_the_hanging_film_is_integrated_again(solved: Callable[..., Solution]) -> None:
    found = solved("hanging_film")
    sizes = found.scene.ribbon
    assert sizes is not None and sizes.density is not None
    D = sizes.youngs_modulus * sizes.thickness**3 / 12 / (1 - sizes.poisson_ratio**2)
    Dw = D * sizes.width
    f = np.array([0, 0, -9.81 * sizes.density * sizes.width * sizes.thickness])

    def rates(s: float, y: Array, sign: float) -> Array:
        d1, d2, d3, n, m = y.reshape(6, 3)[1:]
        m2, m3 = m @ d2 / Dw, m @ d3 / Dw
        M = np.hypot(m2, m3)
        p = M + sign * m2
        u = sign * p**2 / (4 * M) * d2 + m3 * p / (4 * M) * d3
        return np.concatenate([d3, *(np.cross(u, d) for d in (d1, d2, d3)), -f, np.cross(n, d3)])

    names = ("r", "d1", "d2", "d3", "n", "m")
    y = np.concatenate([found.start[name] for name in names])
    places = [0.0, *found.switch_points, 0.3]
    for a, b, sign in zip(places[:-1], places[1:], found.sheets, strict=True):
        y = solve_ivp(rates, (a, b), y, args=(sign,), method="DOP853", rtol=1e-12, atol=1e-15).y[
            :, -1
        ]
    last = found.outputs(np.array([0.3]))
    np.testing.assert_allclose(y[:12], np.concatenate([last[k][0] for k in names[:4]]), atol=1e-6)


@pytest.mark.parametrize("par", ["gravity.x", "ribbon.density"])
def test_gravity_is_continued(par: str) -> None:
    density = RIGIDITY / 0.5**3 / (0.02 * 1e-4 * 9.81)
    to = -5 * 9.81 if par == "gravity.x" else 5 * density
    *_, last = Continuation(film(density, continuation=f"{{parameter: {par}, to: {to}}}"))
    tip = last.solution.sample(0.5, "r")[[0, 2]]
    np.testing.assert_allclose(tip, 0.5 * np.array([-0.495905044622, 0.846657179954]), atol=1e-7)


CLAMPS = """
name: clamps
law: {{type: sadowsky}}
interval: [0, {length}]
{rest}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: {end}, directors: {{rotation_vector: [0, 2.4, 0.6]}}}}
loads:
  pressure: "{p} * (1 + s/{length})"
  couple: [0, {c}, "{c} * cos(s/{length})"]
  force: {{z: {{s: [0, {middle}, {length}], values: [0, {f}, {p}]}}}}
transcription: {{type: collocation, degree: 8, intervals: 16}}
"""


def test_loads_that_vary_are_the_same_in_any_units() -> None:
    F, M = RIGIDITY / 0.5**2, RIGIDITY / 0.5
    si = {"length": 0.5, "middle": 0.2, "end": "[0.34, 0.075, 0.155]", "p": 2 * F / 0.5}
    si |= {"c": 1.5 * F, "f": 4 * F / 0.5, "rest": f"ribbon: {{{SIZES}}}"}
    plain = {"length": 1, "middle": 0.4, "end": "[0.68, 0.15, 0.31]", "p": 2, "c": 1.5, "f": 4}
    one, other = (solve(loads_scene(CLAMPS.format(**{"rest": ""} | some))) for some in (si, plain))
    assert one.verified
    assert other.verified
    np.testing.assert_allclose(one.n0 / F, other.n0, atol=1e-10)
    np.testing.assert_allclose(one.m0 / M, other.m0, atol=1e-10)
