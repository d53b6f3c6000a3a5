"""Natural strains in phases: folds of tape springs, mixtures, and clamps that another code solves.

Truth: the ribbon integrated again from the loads at its start by DOP853, its law by numpy's own
eigenvalues of [[m2 + K11, c/2], [c/2, K22]]; moments of folds that are known in closed form.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from ribbonopt.checks.stability import why_not
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import (
    Boundary,
    End,
    Natural,
    RotationVector,
    Sadowsky,
    Scene,
    Variational,
    load_scene,
)
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

CONFIGS = Path(__file__).parents[2] / "configs"
Array = np.ndarray


def clamp(position: tuple[float, ...], turn: tuple[float, ...], natural: Natural) -> Scene:
    x, y, z = position
    a, b, c = turn
    start = End(support="clamped", position=(0.0, 0.0, 0.0), directors="identity")
    end = End(support="clamped", position=(x, y, z), directors=RotationVector((a, b, c)))
    return Scene("clamp", Sadowsky(), Boundary(start, end), natural=natural, tolerance=1e-8)


def constants(natural: Natural) -> tuple[float, float, float]:
    """Return K11, K12, K22."""
    k11, k12, k22 = (float(v) for v in (natural.curvature, natural.twist, natural.across))  # type: ignore[arg-type]
    nu = natural.poisson_ratio or 0.0
    return k11 + nu * k22, (1 - nu) * k12, k22 + nu * k11


def misses(found: Solution, natural: Natural) -> float:
    """Return by how much the ribbon, integrated again in its phases, misses its far end."""
    K11, K12, K22 = constants(natural)
    n0, m0 = (found.n0 / found.units.force, found.m0 / found.units.moment)
    length = found.units.length

    def rates(_: float, y: Array, kind: int) -> Array:
        d = y[3:].reshape(3, 3)
        n, m = d @ n0, d @ (m0 + np.cross(n0, y[:3]))
        T, c = m[1] + K11 + K22, m[2] + 2 * K12
        if kind == 0:  # T = 0, n1 + m1 u3 = 0, and that differentiated
            u3 = c / 4
            u2 = (2 * n[1] * u3 + m[1] * u3**2) / (n[2] + m[2] * u3 - m[0] ** 2 / 4)
        else:
            side = kind if kind != 2 else np.sign(T)
            values, vectors = np.linalg.eigh([[m[1] + K11, c / 2], [c / 2, K22]])
            which = 1 if side > 0 else 0
            a, b = vectors[:, which]
            u2, u3 = values[which] * a * a, values[which] * a * b
        turned = np.stack([u3 * d[1] - u2 * d[2], -u3 * d[0], u2 * d[0]])
        return np.concatenate([d[2], turned.ravel()])

    y = np.concatenate([np.zeros(3), np.eye(3).ravel()])
    ends = (np.array([0.0, *found.switch_points, found.scene.interval[1]])) / length
    for kind, a, b in zip(found.sheets or (2,), ends[:-1], ends[1:], strict=True):
        path = solve_ivp(rates, (a, b), y, "DOP853", rtol=1e-12, atol=1e-13, args=(kind,))
        y = path.y[:, -1]
    o = found.outputs(np.array([found.scene.interval[1]]))
    frame = np.stack([o[name][0] for name in ("d1", "d2", "d3")])
    gap = np.abs(y[:3] - o["r"][0] / length).max()
    return float(max(gap, np.abs(y[3:].reshape(3, 3) - frame).max()))


@pytest.mark.parametrize("seed", range(6))
def test_random_clamps_are_solved_from_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    direction = rng.normal(size=3)
    place = rng.uniform(0.3, 0.95) * direction / np.linalg.norm(direction)
    turn = Rotation.random(random_state=rng).as_rotvec()
    k = rng.uniform(-5, 5, 3) * (1, 0.5, 0.5)
    natural = Natural(*map(float, k), poisson_ratio=0.3 * (seed % 2))
    scene = clamp(tuple(place), tuple(turn), natural)
    sharp = solve(scene)
    assert sharp.verified, sharp.message
    assert misses(sharp, natural) < 1e-6
    smooth = solve(replace(scene, law=Variational()))
    assert smooth.verified, smooth.message


def test_fold_of_a_tape_spring_ends_at_the_known_moment() -> None:
    """Against its curvature a fold runs on at -(1 + nu) D w k22; beside it nothing bends."""
    found = solve(load_scene(CONFIGS / "tape_spring.yaml"))
    assert found.verified, found.message
    assert found.sheets == (1, -1, 1)
    ribbon = found.scene.ribbon
    assert ribbon is not None
    rigidity = rigidity_of(found)
    moment = -(1 + ribbon.poisson_ratio) * rigidity * 65
    np.testing.assert_allclose(found.sample(found.switch_points, "m2"), moment, rtol=1e-9)
    first, last = found.switch_points
    for s in (0.5 * first, first - 1e-9, last + 1e-9):
        np.testing.assert_allclose(found.sample(float(s), "u"), 0, atol=1e-6)
    for s in (first + 1e-9, last - 1e-9):
        assert found.sample(float(s), "u2") == pytest.approx(-65, rel=1e-5)
    # In the fold the ribbon is a planar elastica of the stiffness D w, about its natural curvature.
    m2, u2 = (found.sample(0.1, name) for name in ("m2", "u2"))
    K11 = ribbon.poisson_ratio * 65
    assert m2 == pytest.approx(rigidity * (u2 - K11), rel=1e-9)


@pytest.mark.parametrize("pull", [1e-3, 1e-2])
def test_mixture_with_curvature_across(pull: float) -> None:
    """A curl that is pulled straight: T = 0 along its middle, and the smooth laws go there."""
    scene = load_scene(CONFIGS / "curled_strip.yaml", [f"parameters.pull={pull}"])
    found = solve(scene)
    assert found.verified, found.message
    assert found.sheets == (1, 0, 1)
    natural = found.posed.scene.natural
    assert natural is not None
    K11, K12, K22 = constants(natural)
    a, b = found.switch_points
    s, units = np.linspace(a + 1e-9, b - 1e-9, 9), found.units
    u2, u3 = (found.sample(s, name) / units.strain for name in ("u2", "u3"))
    m2, m3 = (found.sample(s, name) / units.moment for name in ("m2", "m3"))
    np.testing.assert_allclose(m2, -K11 - K22, atol=1e-7)
    np.testing.assert_allclose(u3, (m3 + 2 * K12) / 4, atol=1e-7)
    assert (np.abs(u2 + K22 / 2) <= np.hypot(2 * K22, 4 * u3) / 4).all()
    if pull < 5e-3:  # where more is pulled, errors grow too fast along the ribbon
        assert misses(found, natural) < 1e-4
    assert "mixture" in why_not(found)
    smooth = [replace(scene, law=Variational(delta=delta)) for delta in (1e-2, 3e-3)]
    energies = [prepare(one).solve(guess=found).energy for one in smooth]
    gaps = [abs(value - found.energy) / found.energy for value in energies]
    assert gaps[1] < 0.35 * gaps[0] < 7e-4


@pytest.mark.parametrize("weight", ["loads={}", "loads={force: [0.002, 0.001, 0.003]}"])
def test_mixture_where_curvatures_and_width_vary(weight: str) -> None:
    """T = 0 with K', K'', K12' and w' in it: along it, and as the limit of laws without phases."""
    natural = "natural={curvature: '60 + 400*s*s', twist: '15 + 20*s'}"
    changes = ["parameters.pull=0.005", 'width="1 - 1.5*s"', natural, weight]
    scene = load_scene(CONFIGS / "curled_strip.yaml", changes)
    found = solve(scene)
    assert found.verified, found.message
    assert found.sheets == (1, 0, 1)
    s = np.linspace(*found.switch_points, 11)[1:-1]
    k11, nu, width = 60 + 400 * s**2, 0.38, 1 - 1.5 * s
    strains = found.sample(s, "m2") / (width * rigidity_of(found))
    np.testing.assert_allclose(strains, -(1 + nu) * k11, rtol=1e-7)
    smooth = [replace(scene, law=Variational(delta=d), tolerance=1e-6) for d in (1e-2, 1e-3)]
    energies = [prepare(one).solve(guess=found).energy for one in smooth]
    gaps = [abs(value / found.energy - 1) for value in energies]
    assert gaps[1] < 0.12 * gaps[0] < 2e-4


def rigidity_of(found: Solution) -> float:
    """Return D w of a scene in SI."""
    ribbon = found.scene.ribbon
    assert ribbon is not None
    bending = ribbon.youngs_modulus * ribbon.thickness**3 / (12 * (1 - ribbon.poisson_ratio**2))
    return bending * ribbon.width


def test_free_curl_has_the_strains_of_no_moment() -> None:
    """The eigenvalue of largest modulus of [[K11, K12], [K12, K22]], and its eigenvector."""
    scene = load_scene(CONFIGS / "curled_strip.yaml", ["parameters.pull=0"])
    found = solve(scene)
    assert found.verified, found.message
    K11, K12, K22 = constants(Natural(60.0, 15.0, 0.0, 0.38))
    values, vectors = np.linalg.eigh([[K11, K12], [K12, K22]])
    a, b = vectors[:, 1]
    expected = (values[1] * a * a, values[1] * a * b)
    np.testing.assert_allclose(expected, (58.9123589491, 13.9073214268), atol=1e-9)
    np.testing.assert_allclose(found.at_nodes["u"][:, 1:] - expected, 0, atol=1e-8)


def test_planar_folds_that_no_phase_can_end_are_told() -> None:
    """Bent with its curvature a planar strip leaps at R = 0: the smooth law stands for it."""
    natural = Natural(across=2.0, poisson_ratio=0.3)
    found = solve(clamp((0.45, 0.0, 0.1), (0.0, 3.0, 0.0), natural))
    assert found.status is Status.REGULARIZED
    assert found.scene.law.type == "variational"
    # A fold of that kind runs on at (1 - nu) k22, where u2 goes from 0 to K22.
    o = found.outputs(np.linspace(0, 1, 2001))
    leap = np.abs(np.diff(o["u2"] > 1.0)).nonzero()[0]
    assert len(leap) > 0
    np.testing.assert_allclose(o["m2"][leap], (1 - 0.3) * 2.0, atol=0.02)
