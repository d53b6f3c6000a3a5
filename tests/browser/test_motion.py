"""Small vibrations in a page: a mode is chosen, moves as it says, and stops."""

import numpy as np
import pytest
from pages import Pages
from tab import Tab
from test_ribbon_seen import differing
from truth import CANVAS, bounds, extent, inked, placed, ribbon

from ribbonopt.viewer.view import View, contents
from ribbonopt.views.moved import moved
from ribbonopt.views.surface import sweep

NEAR = 4.0  # pixels
pytestmark = pytest.mark.slow


def choose(tab: Tab, mode: int) -> None:
    """Choose a mode from the list, -1 for none, as a hand does."""
    field = 'document.querySelector("#mode")'
    tab.run(f'({field}.value = "{mode}", {field}.dispatchEvent(new Event("change")))')


def paused(tab: Tab, phase: str = "") -> None:
    if tab.run('document.querySelector("#swing").getAttribute("aria-label")').startswith("pause"):
        tab.press("#swing")


def farthest(view: View, number: int) -> np.ndarray:
    """Return points of the edges at the end of a motion."""
    motion, subject = view.motion, view.ribbons[0].subject
    assert motion is not None
    most = contents(view)["modes"]["list"][number]["amplitude"]
    surface = sweep(moved(subject, motion.modes, number, most).pieces, view.shapes[0].half_width)
    return np.concatenate([sheet.points(side) for sheet in surface.sheets for side in (-1, 1)])


def test_nothing_moves_by_itself_where_that_is_not_wanted(tab: Tab, pages: Pages) -> None:
    """Then the end of a motion is shown: where Python says that it is."""
    tab.open(pages.file("modes"), calm=True)
    view = pages.view("modes")
    still = ribbon(tab)
    for number in (0, 3):
        choose(tab, number)
        first = ribbon(tab)
        assert differing(still, first) > 0.1
        assert (ribbon(tab) == first).all()
        ends = placed(tab, contents(view)["camera"], farthest(view, number))
        assert bounds(inked(first)) == pytest.approx(extent(ends), abs=NEAR)
    choose(tab, -1)
    assert (ribbon(tab) == still).all()
    assert tab.faults() == []


def test_a_mode_is_seen_in_motion(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("modes"))
    view = pages.view("modes")
    told = contents(view)["modes"]["list"]
    options = tab.run('[...document.querySelector("#mode").options].map((one) => one.text)')
    assert options == ["at rest", *(one["name"] for one in told)]
    still = ribbon(tab)
    choose(tab, 1)
    assert tab.text("#frequency") == told[1]["told"]
    seen = [ribbon(tab) for _ in range(6)]
    assert max(differing(a, b) for a in seen for b in seen) > 0.05
    paused(tab)
    assert (ribbon(tab) == ribbon(tab)).all()
    # Without amplitude it is at rest, whatever the phase.
    slider = 'document.querySelector("#amplitude")'
    tab.run(f'({slider}.value = 0, {slider}.dispatchEvent(new Event("input")))')
    assert differing(still, ribbon(tab)) < 0.01
    assert tab.faults() == []


def test_keys_choose_and_play(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("modes"))
    tab.focus(CANVAS)
    chosen = 'document.querySelector("#mode").value'
    label = 'document.querySelector("#swing").getAttribute("aria-label")'
    tab.keys("m", "m")
    assert (tab.run(chosen), tab.run(label)) == ("1", "pause the motion")
    tab.keys(" ")
    assert tab.run(label) == "play the motion"
    tab.keys("M", "M")
    assert tab.run(chosen) == "-1"
    assert tab.text("#frequency") == ""
    assert tab.faults() == []
