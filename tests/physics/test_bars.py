"""Bars are bounds: random clamps from nothing, judged by the independent integrator.

A reduced version of `scripts/bench_error_estimate.py`: the same clamps, quantities and shares.
"""

import sys
from pathlib import Path
from typing import Any

import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from error_clamps import LAWS, cases, measured
from error_report import judged

from ribbonopt.pipeline.prepared import prepare

CLAMPS = 12
SEED = 7  # no seed of the benchmark
TOLERANCE = 1e-8
Row = dict[str, Any]


@pytest.fixture(scope="module", params=LAWS)
def rows(request: pytest.FixtureRequest) -> list[Row]:
    law: str = request.param
    scenes = list(cases(law, TOLERANCE, SEED, CLAMPS))
    prepared = prepare(scenes[0][1])
    names = {"law": law, "tolerance": TOLERANCE}
    return [names | {"clamp": i} | measured(prepared, scene) for i, scene in scenes]


def test_all_are_solved(rows: list[Row]) -> None:
    failed = [(row["clamp"], row["message"]) for row in rows if row["verdict"] == "unsolved"]
    assert not failed


def test_none_is_refuted(rows: list[Row]) -> None:
    wrong = [(row["clamp"], row["reason"]) for row in rows if row["verdict"] != "found"]
    assert not wrong


def test_bars_are_bounds(rows: list[Row]) -> None:
    every = [q for row in rows for q in judged(row) if q["holds"] is not None]
    refuted = [q for q in every if not q["holds"]]
    assert len(every) >= CLAMPS
    assert len(refuted) <= len(every) // 200, refuted  # 99.5 % hold


def test_bars_are_tight(rows: list[Row]) -> None:
    every = [q for row in rows for q in judged(row) if q["tight"] is not None]
    loose = [q for q in every if not q["tight"]]
    assert len(loose) <= len(every) // 10, loose  # 90 % are within ten times the truth
