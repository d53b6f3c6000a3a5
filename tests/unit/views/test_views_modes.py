"""Modes as they are drawn: ribbons moved as the mode says, a panel each, words under it."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from made_modes import made_modes, wave

from ribbonopt import load_scene, solve
from ribbonopt.errors import ModelError, ViewError
from ribbonopt.output.modes_rows import plane_of, rows_of
from ribbonopt.solution.solution import Solution
from ribbonopt.views import Style, plot_modes
from ribbonopt.views.modes import PHASES
from ribbonopt.views.moved import SHARE, TURN, amplitude_of, moved, subject_with, turned_by

CONFIGS = Path(__file__).parents[3] / "configs"


@cache
def solved(name: str) -> Solution:
    return solve(load_scene(CONFIGS / f"{name}.yaml"))


def test_vectors_turn_about_a_rotation() -> None:
    quarter = np.array([[0, 0, np.pi / 2], [0, 0, 0], [np.pi, 0, 0]])
    found = turned_by(quarter, np.array([[1.0, 0, 2], [1, 2, 3], [1, 2, 3]]))
    assert found == pytest.approx(np.array([[0, 1, 2], [1, 2, 3], [1, -2, -3]]), abs=1e-12)


def test_a_ribbon_moves_as_the_mode_says() -> None:
    solution = solved("snap")
    modes = made_modes(solution)
    subject = subject_with(solution, modes)
    found = moved(subject, modes, 2, 0.03)
    for before, after in zip(subject.pieces, found.pieces, strict=True):
        w, slope = wave(before.s, 2)
        assert after.r == pytest.approx(before.r + 0.03 * w[:, None] * before.d1, abs=1e-5)
        # Directors stay directors, and d3 turns as far as the line does.
        frame = np.stack([after.d1, after.d2, after.d3], axis=1)
        assert np.abs(frame @ frame.swapaxes(1, 2) - np.eye(3)).max() < 1e-12
        slopes = np.einsum("ki,ki->k", after.d3, before.d1)
        assert slopes == pytest.approx(np.sin(0.03 * slope), abs=2e-4)


@pytest.mark.parametrize("scale", [1.0, 250.0])
def test_motions_are_well_seen_and_small(scale: float) -> None:
    """Whatever a mode is multiplied by; one that turns much is moved less."""
    solution = solved("snap")
    found = made_modes(solution)
    modes = replace(found, displacement=scale * found.displacement, rotation=scale * found.rotation)
    subject = subject_with(solution, modes)
    line = np.concatenate([piece.r for piece in subject.pieces])
    size = np.linalg.norm(np.ptp(line, axis=0))
    for i in range(4):
        most = amplitude_of(subject, modes, i)
        reach = most * np.linalg.norm(modes.displacement[i], axis=1).max() / size
        turn = most * np.linalg.norm(modes.rotation[i], axis=1).max()
        assert max(reach / SHARE, turn / TURN) == pytest.approx(1)
    still = replace(modes, displacement=0 * modes.displacement)
    turn = np.linalg.norm(modes.rotation[0], axis=1).max()
    assert amplitude_of(subject, still, 0) * turn == pytest.approx(TURN)


def test_a_panel_for_each_mode() -> None:
    solution = solved("snap")
    figure = plot_modes(solution, made_modes(solution))
    words = [axes.get_xlabel() for axes in figure.axes]
    assert words[0].split("\n")[0] == "1   grows, rate 3.2500"
    assert words[1].split("\n")[0] == r"2   $\omega$ = 22.373"
    assert [" ".join(text.split("\n")[1:]) for text in words] == [
        "in plane, symmetric",
        "out of plane, symmetric",
        "25 % in plane, antisymmetric",
        "antisymmetric",
    ]
    # Each panel has as many ribbons as there are phases, the one that is not faded over all.
    (one,) = figure.axes[0].collections
    each = len(one.get_paths()) // len(PHASES)
    assert len(one.get_paths()) == each * len(PHASES)
    faces = np.split(np.asarray(one.get_facecolor()), len(PHASES))
    pale = [part[part[:, 3] > 0, :3].mean() for part in faces]
    assert max(pale[1:3]) < pale[0]
    assert pale[4] < pale[3] - 0.1 < min(pale[:3]) - 0.15
    narrow = plot_modes(solution, made_modes(solution, 3), Style(width=3.35))
    assert len({axes.get_subplotspec().colspan.start for axes in narrow.axes}) == 2


def test_what_only_twists_says_so() -> None:
    solution = solved("snap")
    modes = made_modes(solution)
    still = replace(modes, displacement=1e-12 * modes.displacement)
    words = [row["twist"] for row in rows_of(solution, modes)]
    assert words == 4 * [False]
    assert [plane_of(row) for row in rows_of(solution, still)] == 4 * ["twist"]


def test_in_si_frequencies_are_in_hertz_and_rates_in_seconds() -> None:
    solution = solved("snap")
    figure = plot_modes(solution, made_modes(solution, 2, "Hz"))
    first, second = (axes.get_xlabel().split("\n")[0] for axes in figure.axes)
    assert first == "1   grows, rate 20.420 /s"  # 2 pi 3.25
    assert second == "2   $f$ = 22.373 Hz"


def test_what_cannot_be_drawn_is_told() -> None:
    solution = solved("snap")
    with pytest.raises(ViewError, match="no modes to draw"):
        plot_modes(solution, made_modes(solution, 0))
    with pytest.raises(ModelError, match="color: found 'mass'"):
        plot_modes(solution, made_modes(solution), Style(color="mass"))  # type: ignore[arg-type]
