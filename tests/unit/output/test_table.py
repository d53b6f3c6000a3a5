"""Tables as CSV: what a row says is in its cell, and no cell is a formula."""

import csv
from pathlib import Path

from hostile import FORMULAS, acting, texts

from ribbonopt.output.table import write_table
from ribbonopt.text import is_executed


def read(path: Path) -> list[list[str]]:
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def test_rows_are_written_by_their_columns(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    rows = [{"a": 0.1, "b": 'x, "y"\nz'}, {"b": True, "c": [0.25, -1.0]}, {"a": -2, "c": []}]
    write_table(path, ("a", "b", "c", "d"), rows)
    assert read(path) == [
        ["a", "b", "c", "d"],
        ["0.1", 'x, "y"\nz', "", ""],
        ["", "True", "0.25 -1.0", ""],
        ["-2", "", "", ""],
    ]
    assert [file.name for file in tmp_path.iterdir()] == ["table.csv"]


def test_no_cell_and_no_column_is_a_formula(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    words = [*FORMULAS, *(text for text in texts(seed=7, count=300) if len(text) < 5000), "\udcff"]
    write_table(path, words, [{word: word for word in words}, {}])
    head, row, empty = read(path)
    assert len(head) == len(row) == len(empty) == len(words)
    for found in (*head, *row):
        assert not is_executed(found)
        assert not acting(found)
    assert head[0] == row[0] == "'=1+1'"
