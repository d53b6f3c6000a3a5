"""Rows of numbers with sources: what a file says, how a row is judged, what is told of it."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from ribbonopt.errors import SceneError
from ribbonopt.studies.verification.claims import Claim, chosen
from ribbonopt.studies.verification.measured import COUNT, TOLERANCE, Measured
from ribbonopt.studies.verification.page import page
from ribbonopt.studies.verification.run import Verification, verify
from ribbonopt.studies.verification.table import table, written
from ribbonopt.studies.verification.verdict import FAILED, OFF, OK, Verdict
from ribbonopt.studies.verification.written import load_claims

SCENE = """\
scenes:
  tip:
    law: {type: sadowsky}
    parameters: {load: 1}
    boundary:
      start: {support: clamped, position: [0, 0, 0], directors: identity}
      end: {support: free, force: [load, 0, 0]}
    guess: {force: [1, 0, 0], moment: [0, 1, 0]}
    tolerance: 1.0e-10
    record: {across: "dot(r, ex)"}
  column:
    law: {type: kirchhoff}
    states: planar
    parameters: {P: 9}
    boundary:
      start: {support: hinged, position: [0, 0, 0], axis: d2, along: [0, 1, 0]}
      end: {position: {x: 0}, force: {z: -P}, moment: {d2: 0}}
    guess: {force: [0, 0, -9], moment: [0, 0, 0]}
    tolerance: 1.0e-10
    continuation: {parameter: parameters.P, from: 9, to: 11, largest: 2, stability: false}
"""
# Elliptic integrals (Bisshopp & Drucker), Euler's load.
DEFLECTION, ALONG = 0.30172077379981353, 0.94356676371662312
ROW = "{{scene: {0}, quantity: {1}, value: {2!r}, digits: {3}, source: a book}}"


def claims(folder: Path, *rows: str) -> tuple[Claim, ...]:
    text = SCENE + "rows:\n" + "".join(f"  - {row}\n" for row in rows)
    (folder / "rows.yaml").write_text(text)
    return load_claims(folder / "rows.yaml")


def row(scene: str, quantity: str, value: float, digits: object = 16) -> str:
    return ROW.format(scene, quantity, value, digits)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Verification:
    """Rows that are right but for one, of every kind."""
    found = claims(
        tmp_path_factory.mktemp("rows"),
        row("tip", "r(end).x", DEFLECTION),
        row("tip", "record.across", DEFLECTION),
        row("tip", "m0.y", ALONG),
        row("tip", "r(1).z", ALONG + 1e-9),
        row("tip", "reaction.1.x", -1, "exact"),
        row("tip", "negative", 0, "exact"),
        row("tip", "switch.1", 0.5),
        row("column", "branch_point.1.P", math.pi**2),
        row("column", "branch_point.1.n0.z", -(math.pi**2)),
        row("column", "branch_points", 1, "exact"),
        row("column", "at(11).n0.z", -11, "exact"),
        row("column", "at(10.5).n0.z", -10.5, "exact"),
        row("column", "branch_point.2.value", 39.5),
        row("tip", "half_twists", 1, "exact"),
    )
    return verify(found, "rows.yaml")


def test_numbers_of_solutions_and_branches(study: Verification) -> None:
    right = [verdict.status for verdict in study.verdicts]
    assert right == [OK] * 3 + [OFF] + [OK] * 2 + [FAILED] + [OK] * 4 + [FAILED] * 3
    assert not study.right
    reasons = [v.message for v in study.verdicts if v.status == FAILED]
    assert reasons == [
        "there are 0 switch points, expected 1 or more",
        "branch 0 has 0 points at 10.5, expected one",
        "the branch has 1 points that are a branch point",
        "this is no closed band",
    ]


def test_what_a_row_that_is_off_says(study: Verification) -> None:
    said = table(study)
    assert "row 4, tip r(1).z: 0.9435667637166" in said
    assert "apart by 1.0e-09" in said
    assert "9 of 14 rows within their bars" in said


def test_one_of_the_rows_has_no_bar(study: Verification) -> None:
    assert study.tolerated == 1
    tolerated = study.verdicts[8].found
    assert tolerated is not None and tolerated.basis == TOLERANCE
    assert tolerated.bar == pytest.approx(1e-10 * math.pi**2)
    assert study.verdicts[9].plain()["basis"] == COUNT


def test_only_the_first_row_of_a_scene_pays(study: Verification) -> None:
    first, *others = (v.seconds for v in study.verdicts if v.claim.scene == "column")
    assert first > max(others)


def test_the_page_has_all_rows(study: Verification) -> None:
    lines = page(study).splitlines()
    assert sum(line.startswith(("| tip |", "| column |")) for line in lines) == 14
    assert lines.count("### a book") == 1


@pytest.mark.parametrize(
    ("ours", "bar", "value", "digits", "status", "agreed"),
    [
        (1.2345, 0.0, 1.234, 4, OK, 4),  # half a unit of the last digit
        (1.23451, 0.0, 1.234, 4, OFF, 3),
        (1.23451, 1e-5, 1.234, 4, OK, 3),
        (1.25, 1e-3, 1.0, 4, OFF, 1),
        (-1.0, 1e-3, 1.0, 4, OFF, 0),
        (1e-9, 1e-9, 0.0, None, OK, 9),
        (2e-9, 1e-9, 0.0, None, OFF, 9),
        (-57.4495, 1e-6, -57.5, 2, OK, 2),
        (math.nan, 1.0, 1.0, 3, OFF, 0),
        (1.0, math.nan, 1.5, 3, OFF, 1),
    ],
)
def test_judged(
    tmp_path: Path,
    ours: float,
    bar: float,
    value: float,
    digits: int | None,
    status: str,
    agreed: int,
) -> None:
    (claim,) = claims(tmp_path, row("tip", "H", 1))
    claim = replace(claim, value=value, digits=digits)
    verdict = Verdict(claim, Measured(ours, bar), 0.0)
    assert (verdict.status, verdict.agreed) == (status, agreed)


FAULTS = {
    "scene: tap, quantity: H, value: 1, digits: 1, source: x": "rows.0.scene: found 'tap', is no "
    "scene of this file; did you mean 'tip'?",
    "scene: tip, quantity: energi, value: 1, digits: 1, source: x": "did you mean 'energy'?",
    "scene: tip, quantity: r(0.5), value: 1, digits: 1, source: x": "such as r(0.5).x",
    "scene: tip, quantity: r(2).x, value: 1, digits: 1, source: x": "found arclength 2",
    "scene: tip, quantity: m2(0).x, value: 1, digits: 1, source: x": "m2 is a scalar",
    "scene: tip, quantity: record.acros, value: 1, digits: 1, source: x": "did you mean 'across'?",
    "scene: tip, quantity: fold.1.value, value: 1, digits: 1, source: x": "no `continuation`",
    "scene: column, quantity: fold.1.Q, value: 1, digits: 1, source: x": "rows.0.quantity: found",
    "scene: tip, quantity: H, value: one, digits: 1, source: x": "rows.0.value: found 'one', exp",
    "scene: tip, quantity: H, value: 1, digits: 0, source: x": "rows.0.digits: found 0, expected",
    "scene: tip, quantity: H, value: 1, digits: 1": "rows.0: source is missing",
    "scene: tip, quantity: H, value: 1, digit: 1, source: x": "did you mean 'digits'?",
    "scene: tip, set: {law: {type: sadowski}}, quantity: H, value: 1, digits: 1, source: x": "rows."
    "0.set: law.type: found 'sadowski'",
    "scene: tip, set: 3, quantity: H, value: 1, digits: 1, source: x": "rows.0.set: found 3, expec",
}


@pytest.mark.parametrize("text", FAULTS)
def test_faults_are_told_with_line_and_key(tmp_path: Path, text: str) -> None:
    with pytest.raises(SceneError) as raised:
        claims(tmp_path, "{" + text + "}")
    assert f"line {SCENE.count(chr(10)) + 2}, rows.0" in str(raised.value)
    assert FAULTS[text] in str(raised.value)


def test_faults_of_scenes_are_told_with_their_lines(tmp_path: Path) -> None:
    (tmp_path / "rows.yaml").write_text(
        SCENE.replace("type: kirchhoff", "type: kirchof") + f"rows:\n  - {row('tip', 'H', 1)}\n"
    )
    with pytest.raises(SceneError, match=r"line 12, scenes\.column\.law\.type: found 'kirchof'"):
        load_claims(tmp_path / "rows.yaml")


@pytest.mark.parametrize("text", ["", "rows: []\n", "scenes: {}\nrows: 3\n", "- 1\n", "a: [\n"])
def test_what_is_no_such_file(tmp_path: Path, text: str) -> None:
    (tmp_path / "rows.yaml").write_text(text)
    with pytest.raises(SceneError, match=r"rows\.yaml"):
        load_claims(tmp_path / "rows.yaml")


def test_rows_are_chosen_by_scene_and_quantity(tmp_path: Path) -> None:
    found = claims(tmp_path, row("tip", "H", 1), row("tip", "m0.x", 1), row("column", "H", 1))
    assert len(chosen(found, ())) == 3
    assert [claim.number for claim in chosen(found, ("tip",))] == [1, 2]
    assert [claim.number for claim in chosen(found, ("H",))] == [1, 3]
    assert [claim.number for claim in chosen(found, ("*/m0.*", "col*"))] == [2, 3]
    with pytest.raises(SceneError, match="did you mean 'column'"):
        chosen(found, ("colum",))


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (43.4964080173984993703, 21, "43.4964080173985"),
        (12.5, None, "12.5"),
        (3.0, None, "3"),
        (43.0, 3, "43.0"),
        (-0.1047002390, 10, "-0.1047002390"),
        (2.118e-5, 4, "2.118e-05"),
        (57.5, 2, "58"),
    ],
)
def test_no_digit_is_written_that_does_not_stand(
    value: float, digits: int | None, text: str
) -> None:
    assert written(value, digits) == text
