"""Where there is no WebGL, and where there are no scripts, the ribbon is seen all the same."""

import numpy as np
import pytest
from pages import Pages
from tab import Tab
from truth import CANVAS, bounds, inked, ribbon

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", ["moebius_half", "three_supports"])
def test_the_picture_is_the_same(tab: Tab, pages: Pages, name: str) -> None:
    tab.open(pages.file(name))
    drawn = ribbon(tab)
    tab.open(pages.file(name), webgl=False)
    assert tab.run("document.createElement('canvas').getContext('webgl2')") is None
    painted = ribbon(tab)
    assert bounds(inked(painted)) == pytest.approx(bounds(inked(drawn)), abs=3)
    both = inked(drawn) & inked(painted)
    either = inked(drawn) | inked(painted)
    assert both.sum() > 0.93 * either.sum()
    off = np.abs(drawn.astype(int) - painted).mean(axis=2)[both]
    assert np.median(off) < 12
    assert tab.faults() == []


def test_it_turns_and_is_marked_too(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("moebius_half"), webgl=False)
    first = ribbon(tab)
    x, y, w, h = tab.box(CANVAS)
    tab.drag((x + w / 2, y + h / 2), (x + w / 2 + 100, y + h / 2))
    assert (ribbon(tab) != first).any(axis=2).mean() > 0.05
    tab.click(x + w / 2, y + h / 2, times=2)
    tab.move(x + 2, y + 2)
    assert (ribbon(tab) == first).all()
    x, y, w, h = tab.box(".strains svg")
    tab.move(x + w / 2, y + h / 2)
    assert (ribbon(tab) != first).any()
    assert tab.run('document.querySelectorAll(".strains .marks circle").length') == 2
    assert tab.faults() == []


def test_without_scripts_there_is_a_still_picture(tab: Tab, pages: Pages) -> None:
    """A frame without leave for scripts, as mail programs have; its text is asked from outside."""
    inner = pages.file("moebius_half")
    outer = pages.folder / "mail.html"
    frame = f'<iframe sandbox="" src="{inner.name}" width="700" height="700"></iframe>'
    outer.write_text(f"<!DOCTYPE html><title>mail</title>{frame}")
    tab.open(outer, ready="0")
    seen = tab.pixels(tab.box("iframe"))
    left, top, right, bottom = bounds(inked(seen[120:660, 20:660], least=60))
    assert right - left > 200
    assert bottom - top > 80
