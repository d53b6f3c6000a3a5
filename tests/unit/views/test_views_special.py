"""The figure of special points of a study of branches: lines, level lines, marks, panels."""

from typing import Any

import numpy as np
import pytest

from ribbonopt.views.special import plot_special

Row = dict[str, Any]


def row(scene: str, law: object, width: float | None, *specials: tuple[str, float]) -> Row:
    points = [
        {"parameter": "p", "p": value, "kind": kind, "error": 0.0} for kind, value in specials
    ]
    return {"number": 1, "scene": scene, "law": law, "w": width, "specials": points}


ROWS = [
    row("arch", {"type": "sano", "zeta": 1.0}, 2.0, ("branch point", 0.4), ("fold", 0.9)),
    row("arch", {"type": "sano", "zeta": 0.5}, 1.0, ("kink", 0.3)),
    row("arch", "sadowsky", None, ("branch point", 0.2)),
    row("arch", "sadowsky", 1.0),
    row("level", {"type": "sano", "zeta": 0.5}, 1.0, ("branch point", 0.7)),
]


def test_a_line_for_each_law_and_place_in_the_panel_of_its_scene() -> None:
    figure = plot_special(ROWS, ["law", "w"])
    arch, level = figure.axes
    lines = [line for line in arch.lines if line.get_linestyle() == "-" and len(line.get_xdata())]
    joined = [line for line in lines if len(line.get_xdata()) > 1]
    ((x, y),) = [line.get_data() for line in joined]
    np.testing.assert_array_equal([x, y], [[1, 2], [0.3, 0.4]])  # by width, whatever the order
    flat = [line for line in arch.lines if line.get_linestyle() == "--"]
    assert [line.get_ydata()[0] for line in flat] == [0.2]
    assert flat[0].get_color() != joined[0].get_color()
    marks = {(line.get_marker(), *line.get_ydata()) for line in arch.lines}
    assert {("o", 0.4), ("v", 0.3), ("s", 0.9)} <= marks
    assert [line.get_ydata()[0] for line in level.lines if line.get_marker() == "o"] == [0.7]
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["arch", "level"]
    legend = {text.get_text() for text in figure.legends[0].get_texts()}
    assert legend == {"sano", "sadowsky", "branch point", "kink", "fold"}


@pytest.mark.parametrize("inputs", [[], ["w"], ["law"]])
def test_whatever_was_swept(inputs: list[str]) -> None:
    assert plot_special(ROWS, inputs).axes


def test_kinds_without_their_numbers_have_panels() -> None:
    rows = [
        row("arch", law, 1.0, ("fold", 0.1)) | {"m": m}
        for law in ("a", "b", "c")
        for m in (None, {"bending": 1.0}, {"bending": 2.0})
    ]
    figure = plot_special(rows, ["law", "w", "m"])
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == ["m: none", "m: bending"]
