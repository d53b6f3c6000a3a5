"""Pages beside others: several ribbons of one notebook, and a page of 400 shapes."""

import pytest
from pages import MANY, Pages
from tab import Tab
from truth import CANVAS, inked, ribbon

LARGEST = 2_000_000  # bytes
pytestmark = pytest.mark.slow
LOADED = """new Promise((done) => { const look = (tries) =>
  tries > 250 ? done(0) : setTimeout(look, 20, tries + 1); look(0); })"""


def test_ribbons_of_a_notebook_do_not_meet(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("notebook"), (1400, 1400), ready=LOADED)
    assert tab.run('document.querySelectorAll("iframe").length') == 2
    boxes = [
        tab.run(
            f"(({{x, y, width, height}}) => [x, y, width, height])"
            f"(document.querySelectorAll('iframe')[{k}].getBoundingClientRect())"
        )
        for k in range(2)
    ]
    before = [tab.pixels(tuple(box)) for box in boxes]
    for pixels in before:
        left = pixels[120:500, 50:600]
        assert 0.02 < inked(left).mean() < 0.8
    x, y, w, h = boxes[0]
    tab.drag((x + w / 4, y + h / 2), (x + w / 4 + 150, y + h / 2))
    tab.move(x + w / 2, y + 3)
    after = [tab.pixels(tuple(box)) for box in boxes]
    assert (after[0] != before[0]).any(axis=2).mean() > 0.02
    assert (after[1] == before[1]).all()
    assert [fault for fault in tab.faults() if "srcdoc" not in fault] == []


def test_four_hundred_shapes(tab: Tab, pages: Pages) -> None:
    path = pages.file("many")
    assert path.stat().st_size < LARGEST
    tab.open(path)
    assert tab.text("#count") == f"1 of {MANY}"
    first = ribbon(tab)
    tab.focus("#slider")
    tab.keys("End")
    assert tab.text("#count") == f"{MANY} of {MANY}"
    assert (ribbon(tab) != first).any()
    x, y, w, h = tab.box(CANVAS)
    tab.hand(
        [
            {"type": "pointerMove", "x": round(x + w / 2), "y": round(y + h / 2)},
            {"type": "pointerDown", "button": 0},
        ]
    )
    for k in range(20):
        tab.hand([{"type": "pointerMove", "x": round(x + w / 2 + k), "y": round(y + h / 2)}])
        tab.run("new Promise((done) => requestAnimationFrame(() => done(0)))")
    tab.hand([{"type": "pointerUp", "button": 0}])
    assert (ribbon(tab) != first).any()
    assert tab.faults() == []
