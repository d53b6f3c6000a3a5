"""Bars are bounds: random clamps from nothing, judged by the independent integrator.

A reduced version of `scripts/bench_error_estimate.py`: clamps of the same kind, the same quantities
and shares.
"""

import sys
from functools import cache
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


@cache
def answers(law: str) -> list[Row]:
    scenes = list(cases(law, TOLERANCE, SEED, CLAMPS))
    prepared = prepare(scenes[0][1])
    names = {"law": law, "tolerance": TOLERANCE}
    return [names | {"clamp": i} | measured(prepared, scene) for i, scene in scenes]


@pytest.mark.parametrize("law", LAWS)
def test_all_are_solved_and_none_is_refuted(law: str) -> None:
    assert not [row for row in answers(law) if row["verdict"] != "found"]


def test_bars_are_bounds_and_tight() -> None:
    every = [q for law in LAWS for row in answers(law) for q in judged(row)]
    known = [q for q in every if q["known"]]
    bounded = [q for q in known if q["holds"] is not None]
    assert len(known) >= 0.95 * len(every)
    assert len(bounded) >= 0.8 * len(known)
    wrong = [q for q in bounded if not q["holds"]]
    assert len(wrong) <= 0.005 * len(bounded), wrong
    loose = [q for q in known if not q["tight"]]
    assert len(loose) <= 0.1 * len(known), loose
