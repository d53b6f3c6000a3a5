"""The short report of a solve: whatever is to be doubted of an answer is in it, and all it asks."""

from collections.abc import Callable
from typing import Any

import pytest

from ribbonopt.output.brief import brief
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]


@pytest.fixture
def half(solved: Solved) -> dict[str, Any]:
    return summarize(solved("moebius_half"))


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"given_up": ["phases (why)"]}, "  note: phases (why)"),
        ({"fell_back": ["its own guess (why)"]}, "  note: its own guess (why)"),
        ({"warnings": ["edges meet"]}, "  warning: edges meet"),
        (
            {"verified": False, "status": "tolerance_missed", "message": "too large"},
            "h: tolerance missed\n  too large",
        ),
        ({"loads_from": "costates"}, "  (force and moment recovered from the costates)"),
        (
            {"recorded": {"dip": 0.25}, "recorded_error": {"dip": None}},
            "  dip                      0.25  +- not known",
        ),
        ({"phases": [1, -1], "switch_points": [0.25]}, "; switches at s = 0.25"),
    ],
)
def test_nothing_to_be_doubted_is_left_out(
    half: dict[str, Any], change: dict[str, Any], line: str
) -> None:
    summary = half | {"name": "h"}
    assert line not in brief(summary)
    assert line in brief(summary | change)
    assert line in report(summary | change)


def test_an_answer_without_bars_says_so(half: dict[str, Any]) -> None:
    unknown = half | {"error_estimate": dict.fromkeys(half["error_estimate"])}
    assert (
        brief(unknown).splitlines()[0].endswith("verified, its errors not known (see the warnings)")
    )
    assert brief(unknown).count("+- not known") == 4


def test_stability_is_told_where_it_is_known(half: dict[str, Any]) -> None:
    assert "stability" not in brief(half) + report(half)
    row = f"\n  {'stability':<25}unstable, 2 directions"
    assert row in brief(half, "unstable, 2 directions")
    assert row in report(half, verdict="unstable, 2 directions")


def test_of_a_piece_the_energy_of_all_is_told(solved: Solved) -> None:
    summary = summarize(solved("ribbon_si"))
    (line,) = [x for x in brief(summary).splitlines() if x.startswith("  energy of all of it")]
    assert float(line.split()[5]) == pytest.approx(2 * summary["energy"], rel=1e-9)
    assert "; units SI (m, N, N m, J)" in brief(summary)
