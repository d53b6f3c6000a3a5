"""Comparisons: rows agree with the truth, failures are rows, findings follow from the rows."""

import csv
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS

from ribbonopt.errors import SceneError
from ribbonopt.scene import Newton, Regularized, Scene, load_scene
from ribbonopt.studies.comparison.benchmark import Peer, PeerRow, benchmark, slopes_of
from ribbonopt.studies.comparison.compare import Comparison, compare
from ribbonopt.studies.comparison.files import save_study
from ribbonopt.studies.comparison.findings import cheapest
from ribbonopt.studies.comparison.pairs import FORMULATIONS, TRANSCRIPTIONS, pairs_of
from ribbonopt.studies.comparison.rows import COLUMNS, PairRow, with_frontiers
from ribbonopt.studies.comparison.table import table
from ribbonopt.studies.comparison.truth import SourcedLoads
from ribbonopt.views.comparison import plot_study, save_figure

REFERENCE = SourcedLoads(HALF_MOEBIUS["n0"], HALF_MOEBIUS["m0"], source="28 digits")
TOLERANCES = (1e-5, 1e-7)


@pytest.fixture(scope="module")
def half(configs: Path) -> Scene:
    return load_scene(configs / "moebius_half.yaml")


@pytest.fixture(scope="module")
def compared(half: Scene) -> Comparison:
    return compare(half, ["inverted"], ["gauss", "radau"], TOLERANCES)


def row(
    pair: str, error: float, solve: float, verified: bool = True, spread: float = 0.1
) -> PairRow:
    formulation, states, transcription = pair.split()
    return PairRow(
        *(formulation, states, transcription, 4, 10, 1),
        solve=solve,
        error_n0=error,
        error_m0=error / 2,
        verified=verified,
        low=(1 - spread) * solve,
        high=(1 + spread) * solve,
    )


MADE_UP = (
    row("inverted reduced gauss", 1e-5, 0.002),
    row("inverted reduced gauss", 1e-7, 0.003),
    row("inverted full gauss", 1e-7, 0.006),
    row("energy reduced gauss", 1e-9, 0.030),
    row("algebraic reduced gauss", 1e-12, 0.001, verified=False),
)


def test_errors_agree_with_the_reference(half: Scene, compared: Comparison) -> None:
    by_reference = compare(half, ["inverted"], ["gauss", "radau"], TOLERANCES, REFERENCE)
    assert by_reference.truth == "28 digits"
    assert "by its own estimate" in compared.truth
    assert len(by_reference.rows) == len(compared.rows)
    for found, known in zip(compared.rows, by_reference.rows, strict=True):
        for name in ("error_n0", "error_m0"):
            assert found.plain()[name] == pytest.approx(known.plain()[name], rel=1e-3, abs=1e-13)


def test_every_pair_meets_the_tightest_tolerance(compared: Comparison) -> None:
    names = {r.name for r in compared.rows}
    assert len(names) == 4
    for name in names:
        last = [r for r in compared.rows if r.name == name][-1]
        assert last.meets(1e-7), last
        assert last.error_u is not None and last.error_u < 1e-5


def test_rows_say_what_solving_cost(compared: Comparison) -> None:
    for r in compared.rows:
        assert r.unknowns and r.nonzeros and r.iterations
        assert r.nonzeros > r.unknowns
        assert r.build and r.solve
        if not r.verified:  # the time of the whole try is known
            assert r.rounds == 0
            continue
        assert r.evaluate and r.linear and r.rounds
        assert r.evaluate + r.linear <= r.solve
        assert r.drift_law == 0.0  # the inverted form takes its strains from the law
        assert r.estimate and r.error and 0.1 < r.estimate / r.error < 10


def test_what_does_not_converge_is_a_row(half: Scene) -> None:
    found = compare(
        replace(half, solver=Newton(max_iterations=1)), ["inverted"], ["gauss"], (1e-6,), REFERENCE
    )
    assert found.rows
    assert not found.solved
    for r in found.rows:
        assert (r.status, r.verified, r.error) == ("max_iterations", False, None)
        assert r.message.startswith("the iterations ran out")
    assert found.sentences == ("To 1e-06: no pair gets there.",)
    assert "the iterations ran out" in table(found)


def test_what_makes_no_sense_is_a_row(half: Scene) -> None:
    found = compare(replace(half, law=Regularized(1e-2)), ["energy"], ["gauss"], (1e-2,))
    assert [r.status for r in found.rows] == ["refused", "refused"]
    assert all(r.message and "\n" not in r.message for r in found.rows)


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ((["inverse"], None), "formulations: found 'inverse'; expected some of inverted"),
        ((None, ["gauss", "rk5"]), "transcriptions: found 'rk5'; expected some of gauss"),
        (([], None), "formulations: found none"),
    ],
)
def test_unknown_names_are_refused(
    names: tuple[list[str] | None, list[str] | None], expected: str
) -> None:
    with pytest.raises(SceneError, match=expected):
        pairs_of(*names)


def test_all_pairs_are_tried_by_default() -> None:
    assert len(pairs_of()) == 2 * len(FORMULATIONS) * len(TRANSCRIPTIONS)


def test_ladders_climb() -> None:
    for family in TRANSCRIPTIONS.values():
        sizes = [m.intervals * getattr(m, "steps", 1) * m.degree for m in family.ladder]
        assert sizes == sorted(sizes)


@pytest.mark.parametrize(
    ("tolerance", "sentence"),
    [
        (
            1e-4,
            "To 1e-04: inverted + gauss 4 x 10, 2.0 ms CPU; next inverted (full states) + gauss "
            "4 x 10, 6.0 ms, 3.0 times as long.",
        ),
        (
            1e-6,
            "To 1e-06: inverted + gauss 4 x 10, 3.0 ms CPU; next inverted (full states) + gauss "
            "4 x 10, 6.0 ms, 2.0 times as long.",
        ),
        (1e-8, "To 1e-08: energy + gauss 4 x 10, 30 ms CPU; no other pair gets there."),
        (1e-11, "To 1e-11: no pair gets there."),
    ],
)
def test_the_cheapest_pair_is_named(tolerance: float, sentence: str) -> None:
    assert cheapest(MADE_UP, tolerance).sentence == sentence


def test_no_more_is_claimed_than_the_rounds_show() -> None:
    near = (MADE_UP[1], row("energy reduced gauss", 1e-7, 0.0033), MADE_UP[2])
    assert cheapest(near, 1e-6).sentence == (
        "To 1e-06: inverted + gauss 4 x 10, 3.0 ms CPU, as fast as energy + gauss 4 x 10, 3.3 ms; "
        "next inverted (full states) + gauss 4 x 10, 6.0 ms, 2.0 times as long."
    )
    once = [replace(each, low=None, high=None) for each in (MADE_UP[1], MADE_UP[2])]
    assert "as fast as" in cheapest(once, 1e-6).sentence  # 3 and 6 ms, each measured but once


@pytest.mark.parametrize(
    ("solve", "said"),
    [
        (0.001, "COLNEW (1e-7), 1.0 ms, which wins: ours takes 3.0 times as long."),
        (0.003, "COLNEW (1e-7), 3.0 ms, as fast."),
        (0.030, "COLNEW (1e-7), 30 ms, 10 times as long."),
    ],
)
def test_sentences_say_who_wins_among_peers(solve: float, said: str) -> None:
    rival = PeerRow("COLNEW", "1e-7", solve, 1e-7, 0.95 * solve, 1.05 * solve)
    coarse = replace(rival, detail="1e-3", error=1e-3, solve=1e-6)
    assert cheapest(MADE_UP, 1e-6, [coarse, rival]).sentence.endswith(f"; of the peers {said}")
    assert cheapest(MADE_UP, 1e-6, [coarse]).sentence.endswith("; no peer gets there.")
    assert cheapest((), 1e-6, [rival]).sentence.startswith("To 1e-06: no pair gets there; COLNEW")


def test_what_the_truth_cannot_tell_is_not_decided() -> None:
    study = Comparison("made up", "a coarse solution", 1e-7, (1e-6, 1e-8), MADE_UP)
    first, second = study.sentences
    assert first == cheapest(MADE_UP, 1e-6).sentence
    assert second.startswith("To 1e-08: not decided, the truth is known to 1e-07 only")


def test_columns_are_stable(compared: Comparison, tmp_path: Path) -> None:
    assert COLUMNS == (
        *("pair", "formulation", "states", "transcription", "degree", "intervals", "steps"),
        *("unknowns", "nonzeros", "iterations", "build", "evaluate", "linear", "solve"),
        *("error_n0", "error_m0", "error_u", "drift_invariant", "drift_law", "drift_frame"),
        *("estimate", "verified", "status", "message", "error"),
        *("low", "high", "rounds", "frontier"),
    )
    save_study(compared, tmp_path, "comparison")
    with open(tmp_path / "comparison.csv", encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    assert tuple(head) == (*COLUMNS, "load_before", "load_after", "cpus")
    assert len(rows) == len(compared.rows)
    saved = json.loads((tmp_path / "comparison.json").read_text(encoding="utf-8"))
    assert tuple(saved) == (
        *("name", "truth", "truth_error", "tolerances", "rows", "cheapest", "sentences"),
        *("timing", "machine", "versions"),
    )
    assert saved["timing"]["clock"] == "CPU"
    assert [tuple(r) for r in saved["rows"]] == [COLUMNS] * len(rows)


def test_tables_are_aligned(compared: Comparison) -> None:
    lines = table(compared).splitlines()
    head = next(i for i, line in enumerate(lines) if line.startswith("pair"))
    starts = {line.index("converged") for line in lines[head + 1 : head + 5]}
    assert starts == {lines[head].index("status")}
    assert lines[-2:] == list(compared.sentences)


def test_the_figure_has_a_panel_for_each_formulation(tmp_path: Path) -> None:
    better = (*MADE_UP, row("energy full radau", 1e-3, 0.02), row("energy full radau", 1e-6, 0.04))
    study = Comparison("made up", "by heart", 0.0, (1e-4,), with_frontiers(better)).plain()
    inverted, energy, algebraic, best = plot_study(study).axes
    titles = [axes.get_title(loc="left") for axes in (inverted, energy, algebraic, best)]
    assert titles == ["inverted", "energy", "algebraic", "the best of each"]
    assert [text.get_text() for text in algebraic.texts] == ["no verified solution of known error"]
    assert {text.get_text() for text in energy.texts} == {"gauss 4\u00d710", "radau 4\u00d710 full"}
    assert {text.get_text() for text in best.texts} >= {
        "inverted",
        "energy",
        "energy gauss 4\u00d710",
    }
    save_figure(study, tmp_path / "comparison.png")
    assert (tmp_path / "comparison.png").stat().st_size > 10_000


def test_figures_of_failures_alone_are_drawn() -> None:
    study = Comparison("nothing", "unknown", 0.0, (1e-4,), (MADE_UP[-1],))
    assert plot_study(study.plain()).axes


def order_rows(order: float, intervals: Sequence[int]) -> list[PairRow]:
    return [
        replace(MADE_UP[0], intervals=n, error_n0=10.0 * n**-order, error_m0=0.0) for n in intervals
    ]


def test_orders_are_slopes_between_rounding_and_coarse() -> None:
    (slope,) = slopes_of(order_rows(8, (1, 4, 8, 16, 256)))
    assert slope.order == pytest.approx(8)
    assert slope.points == 3  # 10 is too coarse, 1e-18 is rounding


def test_benchmarks_measure_orders_and_peers(half: Scene, tmp_path: Path) -> None:
    peers = [
        Peer("exact", "by heart", lambda: (REFERENCE.n0, REFERENCE.m0, 2.0)),
        Peer("lost", "", lambda: 1 / 0),  # type: ignore[arg-type, return-value]
    ]
    found = benchmark(
        half, ["inverted"], ["gauss"], repeat=2, quick=True, reference=REFERENCE, peers=peers
    )
    assert {slope.degree: round(slope.order) for slope in found.slopes} == {2: 4, 4: 8}
    exact, lost = found.rivals
    assert (exact.error, exact.solve, exact.message) == (0.0, 2.0, "")
    assert (lost.error, lost.solve) == (None, None)
    assert lost.message == "ZeroDivisionError: division by zero"
    assert lost.message in table(found)
    assert "of the peers exact (by heart), 2000 ms" in found.sentences[-1]
    save_study(found, tmp_path, "benchmark")
    save_figure(found.plain(), tmp_path / "benchmark.png")
    saved = json.loads((tmp_path / "benchmark.json").read_text(encoding="utf-8"))
    assert saved["machine"]["cpus"] >= 1
    assert "casadi" in saved["versions"]
    assert np.isfinite([r["solve"] for r in saved["rows"]]).all()
    assert {r["frontier"] for r in saved["rows"]} >= {"overall"}
