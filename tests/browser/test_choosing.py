"""Shapes of a branch, a batch or other equilibria are chosen by slider, keys, clicks and play."""

import re

import numpy as np
import pytest
from pages import FAILED, Pages
from tab import Pixels, Tab, number
from truth import bounds, extent, inked, placed, ribbon

from ribbonopt.viewer.view import contents

pytestmark = pytest.mark.slow


def alike(a: Pixels, b: Pixels) -> bool:
    return bool((np.abs(a.astype(int) - b).max(axis=2) > 40).mean() < 1e-4)


def shown(tab: Tab) -> int:
    """Return the place of the shape that the page says it shows, from 0."""
    found = re.fullmatch(r"(\d+) of \d+", tab.text("#count"))
    assert found
    assert tab.run('document.querySelector("#slider").value') == str(int(found[1]) - 1)
    return int(found[1]) - 1


def is_seen(tab: Tab, pages: Pages, name: str, i: int) -> None:
    """Compare pixels and texts with a shape."""
    view = pages.view(name)
    told = contents(view)
    shape = view.shapes[i]
    camera = told["camera"]
    camera = {**camera, "centre": told["shapes"][i].get("centre", camera["centre"])}
    edges = [placed(tab, camera, shape.points(side)) for side in (-1, 1)]
    assert bounds(inked(ribbon(tab))) == pytest.approx(extent(np.concatenate(edges)), abs=4)
    assert tab.text("#caption").removeprefix("✓ ").startswith(view.ribbons[i].caption)
    numbers = tab.text("#facts")
    for label, value in view.ribbons[i].numbers:
        assert label in numbers
        assert value in numbers


def spot(tab: Tab, row: int) -> tuple[float, float]:
    """Return where the diagram has a row: asked by its mark, which keys move."""
    tab.box("#diagram .chart-stage")
    at = tab.run(
        "(() => { const chart = document.querySelector('#diagram .chart-stage');"
        "const svg = chart.querySelector('svg'); svg.focus();"
        "const press = (key) => svg.dispatchEvent(new KeyboardEvent('keydown', {key}));"
        f"press('Home'); for (let k = 0; k < {row}; k++) press('ArrowRight');"
        "const mark = chart.querySelector('.marks circle').getBoundingClientRect();"
        "svg.blur(); return [mark.x + mark.width / 2, mark.y + mark.height / 2]; })()"
    )
    return at[0], at[1]


def test_the_slider(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("branch"))
    is_seen(tab, pages, "branch", 0)
    x, y, w, h = tab.box("#slider")
    tab.click(x + w - 4, y + h / 2)
    last = len(pages.view("branch").shapes) - 1
    assert shown(tab) == last
    is_seen(tab, pages, "branch", last)
    tab.keys("ArrowLeft")  # of the slider, which has the focus
    assert shown(tab) == last - 1
    is_seen(tab, pages, "branch", last - 1)


def test_arrow_keys(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("branch"))
    first = ribbon(tab)
    tab.keys("ArrowRight", "ArrowRight", "ArrowRight")
    assert shown(tab) == 3
    is_seen(tab, pages, "branch", 3)
    tab.keys("ArrowLeft", "ArrowLeft", "ArrowLeft", "ArrowLeft")
    assert shown(tab) == 0
    assert alike(ribbon(tab), first)
    tab.keys("End")  # which scrolls
    assert shown(tab) == 0
    tab.focus("#slider")
    tab.keys("End")
    assert shown(tab) == len(pages.view("branch").shapes) - 1


def test_a_click_on_the_diagram(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("branch"))
    rows = pages.branch().rows
    (fold,) = (i for i, row in enumerate(rows) if row["kind"] == "fold")
    for row in (len(rows) - 2, 2, fold):
        tab.click(*spot(tab, row))
        assert shown(tab) == row
        is_seen(tab, pages, "branch", row)
    assert "fold" in tab.text("#caption")


def test_the_caption_says_what_is_stable(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("branch"))
    for i, row in enumerate(pages.branch().rows):
        if row["kind"] == "point" and row["negative"] is not None:
            word = f"unstable, {row['negative']} direction" if row["negative"] else ", stable"
            assert word in tab.text("#caption")
        assert shown(tab) == i
        tab.keys("ArrowRight")
    assert {"stable", "unstable"} <= set(tab.text("#diagram .legend").split())
    lines = "[...document.querySelectorAll('#diagram .chart .line')]"
    assert set(tab.run(f"{lines}.map((one) => one.classList.contains('dashed'))")) == {False, True}


def test_play_goes_through_all_and_stops(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("branch"))
    tab.press("#play")
    tab.run(
        "new Promise((done) => { const look = () => document.querySelector('#slider').value > 2 "
        "? done(0) : setTimeout(look, 20); look(); })"
    )
    tab.press("#play")
    tab.keys("ArrowLeft")  # of the page, though the button has the focus
    at = shown(tab)
    tab.run("new Promise((done) => setTimeout(done, 700))")
    assert shown(tab) == at
    is_seen(tab, pages, "branch", at)
    assert tab.faults() == []


def test_other_equilibria(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("equilibria"))
    for i in range(3):
        assert shown(tab) == i
        is_seen(tab, pages, "equilibria", i)
        tab.keys("ArrowRight")


def test_rows_of_a_batch(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("batch"))
    for row in (4, 0, 7):
        tab.press(f"#table tbody tr:nth-child({row + 1}) td")
        number = pages.batch().rows[row]["number"]
        assert tab.run('document.querySelector("#table tr.chosen td").innerText') == str(number)
        assert shown(tab) == row
        is_seen(tab, pages, "batch", row)
    before = ribbon(tab)
    tab.press(f"#table tbody tr:nth-child({FAILED}) td")
    said = "ribbon 10, unreachable: its shape is not on this page; seen is ribbon 8, verified"
    assert tab.text("#caption").removeprefix("✗ ") == said
    before_it = "getComputedStyle(document.querySelector('#caption'), '::before').content"
    assert tab.run(before_it) == '"✗ "'
    assert tab.text("#facts") == ""  # numbers of another ribbon are not laid at its door
    assert alike(ribbon(tab), before)
    assert tab.faults() == []


def test_rows_are_sorted_and_chosen_by_status(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("batch"))
    names = tab.run('[...document.querySelectorAll("#table th")].map((one) => one.innerText)')
    k = next(i for i, name in enumerate(names) if name.strip(" ↑↓") == "energy")
    lines = '[...document.querySelectorAll("#table tbody tr")]'
    column = f"{lines}.map((one) => one.children[{k}].innerText)"
    energies = [row["energy"] for row in pages.batch().rows if row["verified"]]
    for order in (1, -1):
        tab.press(f"#table th:nth-child({k + 1}) button")
        *found, last = tab.run(column)
        assert last == ""  # what failed has none, whichever way
        read = [number(text) for text in found]
        assert read == pytest.approx(sorted(energies)[::order], rel=1e-4)
    # The chosen shape is that of the row, not of its place.
    tab.press("#table tbody tr:nth-child(1) td")
    rows = pages.batch().rows
    most = max(range(len(energies)), key=lambda i: rows[i]["energy"])
    is_seen(tab, pages, "batch", most)
    field = 'document.querySelector("#table select")'
    tab.run(f'({field}.value = "1", {field}.onchange())')
    assert len(tab.run(column)) == 1


def test_a_click_on_the_scatter(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("batch"))
    x, y, w, h = tab.box("#diagram .chart-stage")
    tab.focus("#diagram .chart-stage svg")
    tab.keys("Home", "ArrowRight", "ArrowRight")
    at = tab.run(
        "(({x, y, width, height}) => [x + width / 2, y + height / 2])"
        "(document.querySelector('#diagram .marks circle').getBoundingClientRect())"
    )
    assert x < at[0] < x + w
    assert y < at[1] < y + h
    tab.click(*at)
    assert tab.run('document.querySelectorAll("#table tr.chosen").length') == 1
    is_seen(tab, pages, "batch", shown(tab))
    assert shown(tab) == 2
