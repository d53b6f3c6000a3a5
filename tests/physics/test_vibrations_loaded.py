"""Frequencies of what is loaded, naturally curved, tapered or turned, against shooting.

The truth has no energy and no mass matrix: equations of motion, and a determinant
(`tests/independent/vibrating.py`); `test_the_truth_itself` does one again.
"""

import numpy as np
import pytest
from independent.vibrating import IN_PLANE, OUT_OF_PLANE, Ribbon
from map_truth import VIBRATIONS, Vibrations

from ribbonopt.checks.modes import Modes, modes_of
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import loads_scene

#: digits of the truth: ten of each number
DIGITS = 6e-11
MESHES = {
    "as it comes": "",
    "coarse": "transcription: {type: collocation, scheme: gauss, degree: 3, intervals: 5}",
    "of degree 8": "transcription: {type: collocation, scheme: gauss, degree: 8, intervals: 3}",
}


def modes(case: Vibrations, *lines: str) -> Modes:
    inertia = f"inertia: {{d3: {case.inertia}}}" if case.inertia else ""
    head = ("name: vibrating", "law: {type: kirchhoff, B2: 1, B3: 2}", "tolerance: 1e-10")
    found = modes_of(solve(loads_scene("\n".join((*head, case.scene, inertia, *lines)))), 8)
    assert isinstance(found, Modes)
    return found


def assert_agree(found: Modes, case: Vibrations, widest: float) -> None:
    inside = found.in_plane > 0.5
    assert set(np.round(found.in_plane, 6)) <= {0.0, 1.0}
    for truth, chosen in ((case.inside, inside), (case.outside, ~inside)):
        known = min(len(truth), int(chosen.sum()))
        assert known or not truth
        frequencies, bars = found.frequencies[chosen][:known], found.errors[chosen][:known]
        apart = np.abs(frequencies / np.array(truth[:known]) - 1)
        assert (apart <= bars + DIGITS).all()
        assert (bars <= widest).all()
    assert found.negative == 0
    assert found.zero == ()


@pytest.mark.parametrize("name", VIBRATIONS)
def test_frequencies_are_those_of_the_equations_of_motion(name: str) -> None:
    assert_agree(modes(VIBRATIONS[name]), VIBRATIONS[name], 1e-8)


@pytest.mark.parametrize("mesh", list(MESHES)[1:])
@pytest.mark.parametrize("name", ["tapered, heavy", "curled", "arch, turned by 40"])
def test_bars_hold_on_other_meshes(name: str, mesh: str) -> None:
    assert_agree(modes(VIBRATIONS[name], MESHES[mesh]), VIBRATIONS[name], 1e-4)


@pytest.mark.parametrize("formulation", ["algebraic", "differentiated"])
def test_whatever_the_formulation(formulation: str) -> None:
    case = VIBRATIONS["heavy"]
    assert_agree(modes(case, f"formulation: {formulation}"), case, 1e-8)


def test_the_truth_itself() -> None:
    strip = Ribbon(curl=2.5, steps=20)
    case, still = VIBRATIONS["curled"], np.zeros(6)
    assert strip.near(still, case.inside[0], IN_PLANE) == pytest.approx(case.inside[0], rel=1e-8)
    assert strip.near(still, case.outside[0], OUT_OF_PLANE) == pytest.approx(
        case.outside[0], rel=1e-8
    )
