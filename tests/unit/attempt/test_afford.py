"""Memory: what a program needs against what was measured, and what there is."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from ribbonopt.attempt import afford
from ribbonopt.attempt.structure import Structure
from ribbonopt.pipeline.prepared import solve
from ribbonopt.problem import Posed
from ribbonopt.scene import load_scene

SCENE = Path(__file__).parents[3] / "configs" / "moebius_regularized.yaml"
GIGA = 1 << 30


def posed(intervals: int, *more: str) -> Posed:
    return Posed.of(load_scene(SCENE, [f"transcription.intervals={intervals}", *more]))


@pytest.mark.parametrize(
    ("sparse", "intervals", "measured"),  # peaks of solving, less those of 10 intervals
    [(False, 1000, 178e6), (False, 4000, 673e6), (True, 1000, 1130e6)],
)
def test_estimates_are_as_measured(sparse: bool, intervals: int, measured: float) -> None:
    nlp, _ = Structure.of(posed(intervals)).on((intervals,))
    assert afford.bytes_needed(nlp, sparse=sparse) == pytest.approx(measured, rel=0.25)


def test_what_there_is_no_memory_for_is_refused_before_it_is_built(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(afford, "bytes_there", lambda: GIGA)
    Structure.of(posed(5000)).on((5000,))
    with pytest.raises(afford.TooLargeError) as caught:
        Structure.of(posed(20_000)).on((20_000,))
    message = str(caught.value)
    assert "1,260,013 unknowns on 20,000 intervals need about 3.2 GB of memory" in message
    assert "there are 1.1 GB; choose fewer intervals, such as 3," in message
    assert caught.value.key == "transcription.intervals"
    with pytest.raises(afford.TooLargeError):
        Structure.of(posed(5000, "solver={type: ipopt}")).on((5000,))
    monkeypatch.setattr(afford, "bytes_there", lambda: None)
    Structure.of(posed(20_000)).on((20_000,))


def test_ipopt_is_not_begun_where_its_libraries_would_wait_for_memory(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(afford, "_of_process", lambda: 150_000_000)
    Structure.of(posed(10)).on((10,))  # Newton's method needs none of it
    with pytest.raises(afford.TooLargeError, match=r"IPOPT needs 200 MB .* leaves 150 MB; raise"):
        Structure.of(posed(10, "solver={type: ipopt}")).on((10,))
    monkeypatch.setattr(afford, "_of_process", lambda: None)
    Structure.of(posed(10, "solver={type: ipopt}")).on((10,))


def test_a_finer_mesh_that_is_too_large_leaves_the_coarse_solution(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def limited(nlp: Any, *, sparse: bool) -> None:
        if nlp.layout.element_count > 10:
            raise afford.TooLargeError("too large")

    monkeypatch.setattr("ribbonopt.attempt.structure.refuse_unaffordable", limited)
    coarse = load_scene(SCENE, ["transcription={type: collocation, degree: 3, intervals: 10}"])
    from dataclasses import replace

    found = solve(replace(coarse, tolerance=1e-10, switching="off"))
    assert found.status.name == "TOLERANCE_MISSED"
    assert sum(found.mesh.elements) == 10


def test_the_least_of_all_limits_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "memory.max").write_text("max\n")
    (tmp_path / "memory.current").write_text("5\n")
    assert afford._of_group(str(tmp_path)) is None
    (tmp_path / "memory.max").write_text("1000\n")
    assert afford._of_group(str(tmp_path)) == 995
    sizes = {"_free": 7 * GIGA, "_of_group": None, "_of_process": 3 * GIGA}
    for name, size in sizes.items():
        monkeypatch.setattr(afford, name, lambda size=size: size)
    assert afford.bytes_there() == 3 * GIGA


def test_a_limit_of_the_process_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    resource = pytest.importorskip("resource")
    unlimited = SimpleNamespace(
        RLIMIT_AS=resource.RLIMIT_AS, RLIM_INFINITY=-1, getpagesize=resource.getpagesize
    )
    for most, seen in ((-1, False), (1 << 50, True)):
        unlimited.getrlimit = lambda _, most=most: (most, most)
        monkeypatch.setitem(__import__("sys").modules, "resource", unlimited)
        assert (afford._of_process() is not None) is (seen and Path("/proc/self/statm").exists())
