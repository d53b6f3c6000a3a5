"""Timing on clocks made up: turns, what is repeated, quartiles, failures, whose time counts."""

import gc
import sys
import time
from collections.abc import Iterator
from types import SimpleNamespace

import numpy as np
import pytest

from ribbonopt.scene.units import Units
from ribbonopt.studies.comparison import timing
from ribbonopt.studies.comparison.peers import Peer, rows_of_peers
from ribbonopt.studies.comparison.profile import Profile
from ribbonopt.studies.comparison.timing import Conditions, Contender, Times, cpu, interleaved

LOADS = ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0))


class Clock:
    """CPU time that passes only where somebody works."""

    def __init__(self) -> None:
        self.now = 0.0
        self.log: list[str] = []

    def work(self, name: str, *seconds: float) -> Contender:
        taken = iter(seconds)

        def call() -> str:
            self.log.append(name)
            self.now += next(taken)
            return name

        return Contender(call, enough=np.inf)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[Clock]:
    clock = Clock()
    monkeypatch.setattr(timing, "cpu", lambda: clock.now)
    yield clock


def test_contenders_take_turns(clock: Clock) -> None:
    a, b = clock.work("a", 1, 2, 9, 4, 5), clock.work("b", 3, 3, 3, 3, 3)
    (first, second), conditions = interleaved([a, b], 5)
    assert clock.log == ["a", "b"] * 5
    assert first.answers == ("a",) * 5
    low, middle, high = np.quantile([1, 2, 9, 4, 5], (0.25, 0.5, 0.75))
    assert first.numbers == {"solve": middle, "low": low, "high": high, "rounds": 5}
    assert second.numbers == {"solve": 3, "low": 3, "high": 3, "rounds": 5}
    assert conditions.rounds == 5
    assert gc.isenabled()


def test_what_is_quick_is_done_again_within_a_sample(clock: Clock) -> None:
    (found,), _ = interleaved([clock.work("a", *[3e-4] * 100)], 2)
    assert found.seconds == pytest.approx((3e-4, 3e-4))
    assert len(clock.log) == 2 * 4  # until a millisecond is full


def test_a_clock_that_stands_still_ends_all_the_same(clock: Clock) -> None:
    (found,), _ = interleaved([clock.work("a", *[0.0] * 1000)], 1)
    assert len(clock.log) == timing.MOST
    assert found.numbers["solve"] > 0  # logarithms are taken of it


def test_what_is_slow_is_timed_less_often(clock: Clock) -> None:
    slow = Contender(clock.work("a", *[1.0] * 9).call, enough=2.5)
    (found,), _ = interleaved([slow], 9)
    assert found.numbers == {"solve": 1.0, "low": None, "high": None, "rounds": 3}


def test_children_that_have_ended_count(monkeypatch: pytest.MonkeyPatch) -> None:
    used = SimpleNamespace(ru_utime=20.0, ru_stime=3.0)
    fake = SimpleNamespace(RUSAGE_CHILDREN=-1, getrusage={-1: used}.get)
    monkeypatch.setattr(time, "process_time", lambda: 0.5)
    monkeypatch.setitem(sys.modules, "resource", fake)
    assert cpu() == 23.5
    monkeypatch.setitem(sys.modules, "resource", None)  # as on Windows
    assert cpu() == 0.5


def test_peers_that_fail_are_rows(clock: Clock) -> None:
    answers = iter([LOADS, None])

    def later() -> tuple[tuple[float, ...], tuple[float, ...]]:
        clock.now += 1
        return next(answers) or (1 / 0, 0)  # type: ignore[return-value]

    def said(n0: object) -> Peer:
        return Peer("said", "", lambda: (n0, LOADS[1], 0.5))  # type: ignore[arg-type, return-value]

    peers = [
        Peer("later", "", later),
        said((1.0, 2.0)),
        said((1.0, 2.0, float("nan"))),
        said("a word"),
        Peer("no time", "", lambda: (*LOADS, -1.0)),
        Peer("good", "", lambda: (*LOADS, 0.5)),
    ]
    times, _ = interleaved([peer.contender for peer in peers], 4)
    *failed, good = rows_of_peers(peers, times, None)
    assert [(row.solve, row.error, row.rounds) for row in failed] == [(None, None, 0)] * 5
    assert [row.message.split(":")[0] for row in failed] == [
        "ZeroDivisionError",
        *["ValueError"] * 4,
    ]
    assert "three finite numbers" in failed[1].message
    assert "expected CPU seconds, found -1.0" in failed[4].message
    assert (good.solve, good.low, good.rounds, good.message) == (0.5, 0.5, 4, "")


def test_the_error_of_a_peer_is_the_worst_of_its_rounds(clock: Clock) -> None:
    truth = Profile(np.array(LOADS[0]), np.array(LOADS[1]), np.ones((3, 3)), Units())
    moved = iter([0.0, 1e-3, 1e-6, 0.0])
    peer = Peer("moves", "", lambda: ((1.0 + next(moved), 2.0, 3.0), LOADS[1], 0.5))
    times, _ = interleaved([peer.contender], 4)
    (found,) = rows_of_peers([peer], times, truth)
    assert found.error == pytest.approx(1e-3 / np.sqrt(14))
    assert found.frontier


def test_a_failure_has_no_times() -> None:
    assert Times((1.0, 2.0), ("a", "b"), "ValueError: no").numbers == {}


@pytest.mark.parametrize(
    ("conditions", "words"),
    [
        (Conditions(11, 1.31, 2.55, 2), "CPU ms, median of 11, load 1.3 to 2.5, 2 cores"),
        (Conditions(7, 1.31, 1.32, 1), "CPU ms, median of 7, load 1.3, 1 core"),
        (Conditions(7, None, None, 8), "CPU ms, median of 7, 8 cores"),
    ],
)
def test_conditions_in_words(conditions: Conditions, words: str) -> None:
    assert conditions.words == words


def test_no_load_is_known_where_the_system_does_not_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr("os.getloadavg", raising=False)
    assert timing.load() is None
