"""The independent integrator under loads: mixtures stay ones, what is wrong is seen."""

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from independent.confirm import confirm, examine
from independent.curved import Material, Natural
from independent.loaded import Strip, rotated, state

from ribbonopt import solve
from ribbonopt.scene import Boundary, End, Loads, RotationVector, Sadowsky, Scene
from ribbonopt.solution.solution import Solution

Array = np.ndarray
GENERIC = Boundary(
    End("clamped", (0.0, 0.0, 0.0), "identity"),
    End("clamped", (0.68, 0.15, 0.31), RotationVector((0.0, 2.4, 0.6))),
)
UNIFORM = Strip(Material("sadowsky"), (3.0, -2.0, 4.0), (0.4, 0.7, -0.5), 2.0)
CURLED = Natural(lambda s: 0.3 + s**2, lambda s: 0.2 * s, lambda s: 0.4 - s / 4, 0.3)


@pytest.mark.parametrize(
    "strip",
    [
        UNIFORM,
        replace(UNIFORM, material=Material("sadowsky", width=lambda s: 1 - 0.4 * s + s**2 / 5)),
        replace(UNIFORM, material=Material("sadowsky", natural=CURLED)),
        replace(UNIFORM, material=Material("sadowsky", natural=CURLED, width=lambda s: 1 - s / 3)),
    ],
    ids=["loads", "width", "natural strains", "both"],
)
def test_a_mixture_stays_one(strip: Strip) -> None:
    """Where T and its rate vanish they vanish along the arc, whatever varies."""
    law, s = strip.material, np.zeros(1)
    w, G, K12 = law.mixing(s)[:, 0]
    m1, m3, frame = 0.8, 6.0, rotated((0.3, -0.4, 0.7))
    rate = (law.mixing(s + 1e-5) - law.mixing(s - 1e-5))[1, 0] / 2e-5
    c2 = float(np.array(strip.couple) @ frame[1])
    n1 = rate - c2 - m1 * (m3 / w + 2 * K12) / 4
    start = state(np.zeros(3), frame, frame.T @ [n1, 1.5, 20.0], frame.T @ [m1, -G, m3])
    end = strip.piece(start, 0.0, 0.3, 0, 1e-12)
    assert abs(strip.turn(start, s)[0]) < 1e-12
    assert abs(strip.turn(end, s + 0.3)[0]) < 1e-10
    assert np.linalg.norm(end[:3]) > 0.1


@pytest.mark.parametrize("force", [(3.0, -2.0, 4.0)])
def test_a_mixture_keeps_what_loads_keep(force: tuple[float, float, float]) -> None:
    strip, s = Strip(Material("sadowsky"), force), np.zeros(1)
    m1, m3 = 0.8, 6.0
    start = state(
        np.zeros(3), np.eye(3), np.array([-m1 * m3 / 4, 1.5, 20.0]), np.array([m1, 0, m3])
    )
    (end,) = strip.along(start, (0.0, 0.5), (0,))
    kept = [strip.energy(y, 0, s)[1, 0] + force @ y[:3, 0] for y in (start, end)]
    assert kept[1] == pytest.approx(kept[0], abs=1e-11)


@pytest.fixture(scope="module")
def pulled() -> Solution:
    return solve(Scene("pulled", Sadowsky(), GENERIC, loads=Loads(force=(2.0, 4.0, -4.0))))


def test_a_solution_is_confirmed(pulled: Solution) -> None:
    assert confirm(pulled) < 1e-11


@pytest.mark.parametrize("name", ["n", "m", "r"])
def test_what_is_a_little_off_is_seen(pulled: Solution, name: str) -> None:
    """Everywhere the same: the ends, the growth of it, or the equations show it."""

    def outputs(fraction: Array) -> Mapping[str, Array]:
        at = dict(pulled.trajectory.outputs(fraction))
        return at | {name: at[name] + 1e-6 * np.array([1.0, -2.0, 1.5])}

    assert confirm(altered(pulled, outputs)) > 2e-8


def test_another_load_is_seen(pulled: Solution) -> None:
    scene = replace(pulled.posed.scene, loads=Loads(force=(2.0, 4.0, -4.0001)))
    assert confirm(altered(pulled, pulled.trajectory.outputs, scene)) > 1e-7


def test_the_wrong_sheet_is_refused(pulled: Solution) -> None:
    """Turned about d3 by half a turn, directors say m2 < 0 where the phases are of one sheet."""

    def outputs(fraction: Array) -> Mapping[str, Array]:
        at = dict(pulled.trajectory.outputs(fraction))
        flip = np.where(fraction > 0.5, -1.0, 1.0)[:, None]
        return at | {"d1": flip * at["d1"], "d2": flip * at["d2"]}

    found = examine(altered(pulled, outputs))
    assert found.worst == np.inf
    assert "T changes its sign" in found.where


def altered(found: Solution, outputs: Any, scene: Scene | None = None) -> SimpleNamespace:
    trajectory = SimpleNamespace(outputs=outputs, ends=found.trajectory.ends)
    posed = SimpleNamespace(scene=scene or found.posed.scene)
    return SimpleNamespace(posed=posed, trajectory=trajectory)
