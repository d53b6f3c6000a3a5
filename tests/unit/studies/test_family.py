"""Several equilibria of a ribbon, each followed from ribbon to ribbon; the lowest is the row's."""

import json
from typing import Any

import numpy as np
import pytest

from ribbonopt.pipeline.neighbour import Neighbour
from ribbonopt.pipeline.prepared import Prepared, solve
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.studies.batch import family
from ribbonopt.studies.batch.processes import message
from ribbonopt.studies.batch.study import Source, StudyRibbon
from ribbonopt.studies.batch.worker import Worker

ARCH = """\
name: arch
law: {type: variational, delta: 0.1}
parameters: {distance: 0.85, turn: 0.2}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0.05, distance], directors: {turns: [{z: turn}]}}
transcription: {type: collocation, degree: 6, intervals: 10}
tolerance: 1e-6
"""
TURNS = (-0.9, -0.6, -0.3, -0.1, 0.1, 0.3, 0.6, 0.9)


def rows_of(inputs: list[dict[str, Any]]) -> list[dict[str, Any]]:
    ribbons = [
        StudyRibbon(i, Source("arch", ARCH), {}, row) for i, row in enumerate(inputs, start=1)
    ]
    work = message(ribbons, [], (), "none", "")
    return [
        answer["row"]
        for answer in Worker().answers(json.loads(json.dumps(work)))
        if "row" in answer
    ]


@pytest.fixture(scope="module")
def rows() -> list[dict[str, Any]]:
    return rows_of([{"parameters.turn": turn, "starts": 4} for turn in TURNS])


def test_the_lowest_energies_are_symmetric(rows: list[dict[str, Any]]) -> None:
    # A mirror takes (y, turn) to (-y, -turn), half a turn about z the former back to y.
    energies = np.array([row["energy"] for row in rows])
    np.testing.assert_allclose(energies, energies[::-1], rtol=1e-6)
    assert all(row["verified"] and row["error"] <= 1e-6 for row in rows)


def test_none_is_above_what_as_many_starts_find_alone(rows: list[dict[str, Any]]) -> None:
    for i in (1, 4, 6):
        turn = TURNS[i]
        alone = solve(loads_scene(ARCH, "arch", [f"parameters.turn={turn}", "starts=4"]))
        assert rows[i]["energy"] <= alone.energy * (1 + 1e-6)


def test_one_start_follows_one_equilibrium_only(rows: list[dict[str, Any]]) -> None:
    alone = rows_of([{"parameters.turn": turn} for turn in TURNS])
    several = np.array([row["energy"] for row in rows])
    energies = np.array([row["energy"] for row in alone])
    assert (energies >= several * (1 - 1e-6)).all()
    assert (energies > several * 1.01).any()  # what several starts are for
    assert "equilibria" not in alone[0]
    assert all(row["equilibria"] >= 2 for row in rows)


def test_mirror_images_are_followed_both(monkeypatch: pytest.MonkeyPatch) -> None:
    # At y = 0 the arch bows to either side with one energy; beside it one of the two is lower,
    # the one or the other: half a turn about z takes y to -y and leaves the turn as it is.
    whole = family._started

    def only_first(prepared: Prepared, scene: Scene, numbers: range) -> list[Neighbour]:
        return whole(prepared, scene, numbers) if len(numbers) > 1 else []

    monkeypatch.setattr(family, "_started", only_first)
    lowest = []
    for sign in (1, -1):
        places = [{"boundary.end.position.1": sign * y} for y in (0.0, 0.02, 0.05)]
        rows = rows_of([place | {"parameters.turn": 0.1, "starts": 2} for place in places])
        assert [row["start"] for row in rows] == ["own", "ribbon 1", "ribbon 2"]
        assert [row["equilibria"] for row in rows] == [1, 2, 2]
        lowest.append([row["energy"] for row in rows])
    np.testing.assert_allclose(*lowest, rtol=1e-6)


def test_where_all_starts_fail_the_row_says_so() -> None:
    far = {"parameters.distance": 1.2, "starts": 3}
    near, beyond, again = rows_of([{"starts": 3}, far, {"starts": 3}])
    assert near["verified"] and again["verified"]
    assert not beyond["verified"] and "1.20104 apart" in beyond["message"]
    assert again["start"] == "ribbon 1"


def test_settings_of_starts_may_differ_in_a_chunk() -> None:
    one, many, other = rows_of([{"starts": 1}, {"starts": 3}, {"starts": 1}])
    assert many["energy"] <= one["energy"] * (1 + 1e-6)
    assert other["energy"] == pytest.approx(many["energy"], rel=1e-6)  # goes on from the lowest


def test_neighbours_are_started_in_every_way_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """What one way of starting misses another may find: each has its turn within as many rows."""
    whole, tried = family._started, []

    def started(prepared: Prepared, scene: Scene, numbers: range) -> list[Neighbour]:
        tried.append(list(numbers))
        return whole(prepared, scene, numbers)

    monkeypatch.setattr(family, "_started", started)
    rows_of([{"parameters.turn": 0.2 + 0.01 * i, "starts": 3} for i in range(7)])
    first, *others = tried
    assert first == [0, 1, 2]
    for i in range(4):
        assert sorted(others[i : i + 3]) == [[0], [1], [2]]
