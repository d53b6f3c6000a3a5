"""Stress: verdicts on answers that are right, wrong or of something else; kinds; limits."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ribbonopt.errors import SceneError
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Posed
from ribbonopt.scene import Kirchhoff, Newton, Scene, load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.stress import run as running
from ribbonopt.studies.stress.answer import Answer, gap_between
from ribbonopt.studies.stress.condition import condition_of
from ribbonopt.studies.stress.kinds import KINDS, kinds_of
from ribbonopt.studies.stress.limit import OutOfTimeError, limited
from ribbonopt.studies.stress.numbers import longer
from ribbonopt.studies.stress.run import run
from ribbonopt.studies.stress.trial import Trial
from ribbonopt.studies.stress.verdict import Verdict, judge
from ribbonopt.studies.stress.witness import witnesses

Solved = Callable[[str], Solution]


@pytest.fixture(scope="module")
def scene(configs: Path) -> Scene:
    return replace(load_scene(configs / "cantilever.yaml"), tolerance=1e-9)


@pytest.fixture(scope="module")
def answer(scene: Scene) -> Solution:
    found = solve(scene)
    assert found.verified
    return found


def off(found: Answer, bars: float) -> Answer:
    """The same, its n(0) off by so many of its bars."""
    change = bars * (found.bars["n0"] or 0.0)
    return replace(found, values={**found.values, "n0": found.values["n0"] + change})


def test_what_a_bar_allows_is_solved_and_more_is_wrong(configs: Path) -> None:
    coarse = ["transcription.degree=4", "transcription.intervals=6", "tolerance=1e-5"]
    half = solve(load_scene(configs / "moebius_half.yaml", coarse))
    found = Answer.of(half)
    truth = next(one for one in map(Answer.of, witnesses(half)) if one.tells(found))
    assert gap_between(found, truth).over_bars < 1
    assert judge(found, truth, ()).verdict is Verdict.SOLVED
    assert judge(off(found, 0.5), truth, (truth,)).verdict is Verdict.SOLVED
    judged = judge(off(found, 10), truth, (truth,))
    assert judged.verdict is Verdict.WRONG
    assert judged.over_bars is not None and 9 < judged.over_bars < 11
    assert "n0 is off by" in judged.reason


def test_an_answer_of_other_loads_is_wrong(
    scene: Scene, answer: Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    # It says that it is verified, and its bars are those of what it solves.
    heavier = replace(scene, parameters={"load": 1.0001})
    passed_off = replace(answer, posed=Posed.of(heavier))
    monkeypatch.setattr(running, "_solved", lambda trial: passed_off)
    found = run("loads", Trial("1.0001", heavier, "1.0001"), None, 20.0)
    assert found.verdict is Verdict.WRONG
    assert found.error == pytest.approx(1e-4, rel=0.1)
    assert found.digits_lost == pytest.approx(math.log10(1e-4 / 2.2e-16), abs=0.1)


def test_others_and_what_nobody_confirms(answer: Solution) -> None:
    found = Answer.of(answer)
    another = replace(found, values={**found.values, "energy": found.values["energy"] + 1.0})
    assert judge(found, another, (found,)).verdict is Verdict.OTHER
    assert judge(found, None, (found,)).verdict is Verdict.SOLVED
    assert judge(found, another, ()).verdict is Verdict.UNCONFIRMED
    assert judge(found, None, (another, found)).verdict is Verdict.SOLVED  # one is enough


def test_who_else_finds_a_fault_is_heard(scene: Scene) -> None:
    trial = Trial("as it is", scene, "as it is")
    assert run("mesh", trial, None, 20.0).verdict is Verdict.SOLVED
    found = run("mesh", trial, None, 20.0, lambda solution: "no equilibrium")
    assert (found.verdict, found.message) == (Verdict.WRONG, "no equilibrium")


def test_failures_are_honest_only_if_they_are_told(scene: Scene) -> None:
    def crash(_: object) -> Any:
        raise TypeError("a slip")

    few = Trial("few", replace(scene, guess="auto", solver=Newton(max_iterations=1)), "few")
    found = run("ways", few, None, 20.0)
    assert found.verdict is Verdict.FAILED and found.message
    refused = replace(scene, law=Kirchhoff(B2=-1.0))
    found = run("stiffness", Trial("-1", refused, "-1"), None, 20.0)
    assert (found.verdict, found.status) == (Verdict.FAILED, "refused")
    assert "law.B2" in found.message
    found = run("noise", Trial("crash", scene, "crash", start=crash), None, 20.0)
    assert (found.verdict, found.message) == (Verdict.CRASHED, "TypeError: a slip")


def test_time_is_limited() -> None:
    def endless() -> None:
        try:
            while True:
                sum(range(1000))
        except Exception:  # as libraries do
            pytest.fail("heard by others")

    with pytest.raises(OutOfTimeError), limited(0.02):
        endless()
    with limited(60.0):
        pass


@pytest.mark.parametrize(
    ("name", "by"), [("ribbon_si", 1e-9), ("ring_pressed", 1e6), ("twisted_ring", 1e-9)]
)
def test_another_unit_of_length_is_the_same_ribbon(solved: Solved, name: str, by: float) -> None:
    given = solved(name)
    scene = given.scene
    found = solve(longer(scene, by))
    assert found.verified
    force = by**2 if scene.ribbon else by**-2
    assert found.n0 == pytest.approx(
        force * given.n0, rel=1e-8, abs=1e-8 * force * given.units.force
    )
    moment = force * by
    assert found.energy == pytest.approx(moment * given.energy, rel=1e-8)


def test_the_condition_is_of_the_size_of_the_dense_one(configs: Path) -> None:
    for name in ("cantilever", "moebius_half"):
        prepared = prepare(load_scene(configs / f"{name}.yaml"))
        found = prepared.solve()
        _, jacobian = prepared.nlp.functions.jacobian(found.dense.w, found.dense.p)
        dense = float(np.linalg.cond(np.array(jacobian.full()), np.inf))
        estimate = condition_of(found)
        assert estimate is not None and dense / 30 < estimate < 30 * dense


def test_kinds_say_why_there_are_none(scene: Scene) -> None:
    none = {name for name, kind in KINDS.items() if isinstance(kind.trials(scene, True), str)}
    assert none == {"smoothing", "stiffness", "half-twists", "distance"}
    with pytest.raises(SceneError, match="found 'noises'; expected some of noise"):
        kinds_of(["noises"])


def test_each_trial_has_a_name_of_its_own(configs: Path) -> None:
    for path in ("moebius_whole", "snap", "twisted_ring", "edgewise_clamp", "moebius_epsilon"):
        given = load_scene(configs / f"{path}.yaml")
        for kind in KINDS.values():
            for quick in (True, False):
                trials = kind.trials(given, quick)
                assert isinstance(trials, str) or len({t.value for t in trials}) == len(trials) > 1


def test_gaps_without_bars_are_told(answer: Solution) -> None:
    found = Answer.of(answer)
    unknown = replace(found, bars=dict.fromkeys(found.bars))
    gap = gap_between(unknown, off(found, 1e4))
    assert gap.agree and not gap.known
    n0 = found.values["n0"] + 0.5 * found.sizes["n0"]
    assert not gap_between(unknown, replace(found, values={**found.values, "n0": n0})).agree
