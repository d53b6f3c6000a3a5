"""Diagrams of branches as data: every point is there, curves are cut where they are no curves."""

import json
from typing import Any

import pytest

from ribbonopt.viewer.diagram import diagram_of
from ribbonopt.views.branch_rows import BranchFigure

Row = dict[str, Any]


def row(number: int, p: float, energy: float | None, branch: int = 0, **more: Any) -> Row:
    found = {"number": number, "stage": 0, "branch": branch, "parameter": "law.p", "law.p": p}
    found |= {"kind": "point", "negative": 0, "note": "", "error": 1e-9, "intervals": 8}
    return found | {"energy": energy, "u2": 0.5 * p, "origin": None} | more


#: a branch with a fold, one that leaves it both ways at point 2, a jump before point 7
ROWS = [
    row(0, 0.0, 1.0, note="begins here"),
    row(1, 1.0, 2.0),
    row(2, 2.0, 4.0, kind="branch point", negative=None),
    row(3, 3.0, 6.0, negative=1),
    row(4, 2.5, 3.0, branch=1, origin=2),
    row(5, 3.0, 2.5, branch=1),
    row(6, 1.5, 3.1, branch=2, origin=2),
    row(7, 9.0, None, branch=2, negative=2),
    row(8, 9.5, 2.6, branch=2, kind="kink"),
]


def figure(rows: list[Row] = ROWS, **more: Any) -> BranchFigure:
    return BranchFigure(rows, **({"pairs": (("value", "energy"),), "jumps": [7]} | more))


def values(data: Any, name: str) -> list[Any]:
    return list(data["columns"][data["names"].index(name)])


def test_every_row_has_its_values() -> None:
    data: Any = diagram_of(figure())
    for name in ("law.p", "energy", "u2", "error", "number", "intervals"):
        assert values(data, name) == [row.get(name) for row in ROWS]
    assert data["negative"] == [0, 0, None, 1, 0, 0, 0, 2, 0]
    assert (data["names"][data["x"]], data["names"][data["y"]]) == ("law.p", "energy")
    assert not {"stage", "branch", "origin", "kind", "note"} & set(data["names"])
    json.dumps(data, allow_nan=False)


def test_curves_are_cut_at_jumps_and_begin_where_they_branch_off() -> None:
    data: Any = diagram_of(figure())
    pieces = [(piece["branch"], piece["rows"]) for piece in data["pieces"]]
    assert pieces == [(0, [0, 1, 2, 3]), (1, [2, 4, 5]), (2, [2, 6]), (2, [7, 8])]
    # The two ways from one point are one curve: each begins as the other says, up to a jump.
    assert [piece["beyond"] for piece in data["pieces"]] == [[], [6], [4, 5], []]
    assert data["corners"] == [8]


def test_special_points_are_marked() -> None:
    data: Any = diagram_of(figure())
    marked = {i: mark for i, mark in enumerate(data["mark"]) if mark}
    assert marked == {0: "note", 2: "branch point", 3: "last point", 5: "last point", 8: "kink"}
    assert data["note"][0] == "begins here"


def test_what_is_rough_and_what_has_powers() -> None:
    data: Any = diagram_of(figure(log=["law.p"]))
    rough = {name for name, is_so in zip(data["names"], data["rough"], strict=True) if is_so}
    powers = {name for name, is_so in zip(data["names"], data["log"], strict=True) if is_so}
    assert rough == {"error", "number", "negative", "intervals"}
    assert powers == {"law.p", "error"}


def test_units_stand_in_labels() -> None:
    data: Any = diagram_of(figure(si=True))
    assert data["labels"][data["names"].index("energy")] == "energy (J)"
    assert data["labels"][data["names"].index("u2")] == "u2 (1/m)"
    assert data["labels"][data["names"].index("law.p")] == "law.p"


@pytest.mark.parametrize("pairs", [(), (("nowhere", "u2"),)])
def test_columns_shown_first_are_there(pairs: tuple[tuple[str, str], ...]) -> None:
    data: Any = diagram_of(figure(pairs=pairs))
    assert data["names"][data["x"]] == "law.p"
    assert data["names"][data["y"]] == "u2"


def test_one_point_and_none() -> None:
    assert diagram_of(figure([]))["pieces"] == []
    data: Any = diagram_of(figure(ROWS[:1]))
    assert [piece["rows"] for piece in data["pieces"]] == [[0]]


def test_parameters_of_all_stages_are_columns_and_the_one_moved_most_comes_first() -> None:
    later = [
        {**row(i, 3.0, 6.0 + i, stage=1), "parameter": "law.q", "law.q": 0.1 * i}
        for i in range(9, 30)
    ]
    data: Any = diagram_of(figure([*ROWS, *later]))
    assert data["names"][:2] == ["law.p", "law.q"]
    assert data["names"][data["x"]] == "law.q"
    assert data["moved"] == {"0": 0, "1": 1}
    assert values(data, "law.q")[:9] == [None] * 9
    assert [piece["rows"][0] for piece in data["pieces"]][-1] == 9


def test_signs_that_could_act_are_seen() -> None:
    data: Any = diagram_of(figure([row(0, 0.0, 1.0, note="a\u202eb\x1b[0m")]))
    assert data["note"] == ["a\\u202eb\\x1b[0m"]
