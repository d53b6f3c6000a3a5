"""Nothing is silent: what was tried before the answer, and which answer is not where it was sought.

What leads nowhere is made to, so that what comes after is known.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from ribbonopt.output.report import report
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline import prepared as path
from ribbonopt.pipeline.neighbour import Neighbour
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.pipeline.told import judged
from ribbonopt.scene import load_scene, loads_scene
from ribbonopt.solvers import Status
from ribbonopt.starts import automatic
from ribbonopt.starts.homotopy import HomotopyPath
from ribbonopt.studies.batch import family
from ribbonopt.studies.continuation.continuation import Continuation

ARCH = """
name: arch
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0.05, 0.8], directors: {turns: [{z: 0.4}]}}
tolerance: 1e-6
"""


def test_a_shape_that_led_nowhere_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    whole = automatic.Automatic._points
    calls: list[int] = []

    def points(self: Any, *parts: Any) -> list[Any]:
        calls.append(1)
        return [] if len(calls) == 1 else whole(self, *parts)

    assert solve(loads_scene(ARCH)).fell_back == ()
    monkeypatch.setattr(automatic.Automatic, "_points", points)
    found = solve(loads_scene(ARCH))
    assert found.verified
    (told,) = found.fell_back
    assert "the first shape that fits the ends led nowhere" in told
    summary = summarize(found)
    assert summary["fell_back"] == [told]
    assert report(summary).splitlines()[1] == f"  note: {told}"
    save_solution(found, tmp_path)
    assert load_solution(tmp_path).fell_back == (told,)


def test_a_path_that_was_lost_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    whole, calls = automatic.follow, []

    def follow(*parts: Any) -> HomotopyPath:
        calls.append(1)
        found = whole(*parts)
        return replace(found, points=found.points[:1], complete=False) if len(calls) == 1 else found

    monkeypatch.setattr(automatic, "follow", follow)
    found = solve(loads_scene(ARCH.replace("sadowsky", "variational, delta: 0.05")))
    assert found.verified
    (told,) = found.fell_back
    assert told.startswith("the path of the automatic start was lost at delta = 0.3")


def test_a_first_start_that_failed_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = path.Prepared.solve

    def failing(self: Any, *parts: Any, **options: Any) -> Any:
        found = whole(self, *parts, **options)
        return replace(found, status=Status.STALLED, given_up=("the guess",))

    monkeypatch.setattr(path.Prepared, "solve", failing)
    smooth = ARCH.replace("sadowsky", "variational, delta: 0.1")
    found = solve(loads_scene(smooth + "starts: 3\n"))
    assert found.verified
    assert any("the first start led nowhere" in told for told in found.fell_back)
    assert found.given_up == ("the guess",)


def test_phases_that_a_scene_names_and_that_are_not_there_are_told(configs: Path) -> None:
    text = (configs / "moebius_regularized.yaml").read_text(encoding="utf-8")
    base = loads_scene(text)
    right = solve(base)
    assert len(right.sheets) == 2
    assert right.given_up == ()
    named = solve(replace(base, switching=(0.2, 0.4, 0.9)))
    if named.verified:
        assert ("the sign changes that `switching` names" in " ".join(named.given_up)) == (
            len(named.sheets) != 4
        )


def test_strains_that_jump_without_a_phase_are_a_wrong_solution(configs: Path) -> None:
    """Newton's method converges on a whole Moebius ribbon without phases, to a wrong answer."""
    scene = load_scene(configs / "moebius_regularized.yaml", ["law={type: sadowsky}"])
    prepared = prepare(scene)
    right = prepared.solve()
    assert right.sheets
    search = prepared.search()
    plain = replace(right, sheets=())
    found = judged(plain, search)
    assert found.status is Status.WRONG_SOLUTION
    assert "m2 changes sign" in found.message
    assert judged(right, search) is right


def test_a_row_of_a_batch_says_that_a_neighbour_helped(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = loads_scene(ARCH)
    prepared = prepare(scene)
    first = family.solve_beside(prepared, scene, 1, None)
    assert first[2] is not None
    whole = path.Prepared.solve

    def failing(self: Any, *parts: Any, **options: Any) -> Any:
        found = whole(self, *parts, **options)
        return found if "guess" in options else replace(found, status=Status.STALLED)

    monkeypatch.setattr(path.Prepared, "solve", failing)
    monkeypatch.setattr(Neighbour, "solve", lambda *_: None)
    found, start, _ = family.solve_beside(prepared, scene, 2, first[2])
    assert (found.verified, start) == (True, "ribbon 1")
    (told,) = found.fell_back
    assert told == "its own start led nowhere (not-converged): it was solved from ribbon 1"


MOEBIUS = """
name: moebius
law: {type: regularized, epsilon: 0.1}
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}}
  end:
    position: {y: 0, z: 0}
    directors: {d1: [-1, 0, 0], d2: [0, -1, 0], d3: [0, 0, 1]}
guess: {force: [0, 43, 43], moment: [0, 2.1, -8.6]}
continuation: {parameter: law.epsilon, to: 0.05, scale: log}
"""


def notes(text: str) -> Iterator[str]:
    for point in Continuation(loads_scene(text)):
        yield point.row["note"]


def test_a_branch_tells_of_a_guess_that_was_given_up_and_nothing_else() -> None:
    assert not any(notes(MOEBIUS))
    text = ARCH.replace("{type: sadowsky}", "{type: variational, delta: 0.2}")
    text += "guess: {force: [400, -300, 900], moment: [0, 90, 70]}\n"
    text += "continuation: {parameter: law.delta, to: 0.15}\n"
    first, *others = notes(text)
    assert "was given up for the automatic start" in first
    assert not any(others)
