"""The numbers with sources that are shipped: all are confirmed, and shown in the docs."""

from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from ribbonopt.scene.yamlio import plain_yaml
from ribbonopt.studies.verification.claims import chosen
from ribbonopt.studies.verification.run import verify
from ribbonopt.studies.verification.table import written
from ribbonopt.studies.verification.verdict import OFF
from ribbonopt.studies.verification.written import OWN, load_claims

PAGE = Path(__file__).parents[2] / "docs" / "verification.md"


def test_there_are_many_and_each_has_a_source() -> None:
    found = load_claims()
    assert len(found) >= 600
    assert len({claim.source for claim in found}) >= 20
    assert len({(c.scene, c.given, c.quantity, c.source) for c in found}) == len(found)


def test_other_programs_read_the_same() -> None:
    """YAML 1.1, of which PyYAML is, takes 1e-3 for a text: the file says 1.0e-3."""
    text = OWN.read_text(encoding="utf-8")
    assert yaml.safe_load(text) == plain_yaml(text, OWN.name)


def test_the_page_has_the_rows_of_the_file() -> None:
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    rows = [
        line.strip("| ").split(" | ") for line in lines if " | `" in line and line.count(" | ") > 5
    ]
    shown = sorted((cells[0], *(c.strip() for c in cells[2:4])) for cells in rows)
    assert shown == sorted(
        (c.scene, f"`{c.quantity}`", written(c.value, c.digits)) for c in load_claims()
    )
    assert sum(" | ok | " in line for line in lines) == len(rows)


def test_a_doctored_row_is_off() -> None:
    right = chosen(load_claims(), ("half/n0.y", "helix_held/energy", "tip_loaded/r(1).x"))
    study = verify(
        [replace(c, value=c.value * (1 + 1e-10)) for c in right if (c.digits or 17) > 9], "-"
    )
    assert len(study.verdicts) >= 3
    assert {verdict.status for verdict in study.verdicts} == {OFF}


@pytest.mark.slow
def test_all_are_confirmed_and_none_by_a_wide_bar() -> None:
    study = verify(load_claims(), OWN.name)
    assert [v.plain() for v in study.verdicts if v.status != "ok"] == []
    for verdict in study.verdicts:
        digits, agreed = verdict.claim.digits, verdict.agreed
        assert agreed is None or agreed >= min(digits or 9, 9), verdict.plain()
    assert study.tolerated < 0.1 * len(study.verdicts)
