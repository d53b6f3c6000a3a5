"""The ribbon in a page: it is where it should be, and a hand turns, zooms and brings it back."""

import numpy as np
import pytest
from pages import Pages
from tab import NARROW, WIDE, Pixels, Tab, number
from truth import CANVAS, bounds, extent, inked, pixels_of_length, placed, ribbon

from ribbonopt.viewer.view import contents

NEAR = 4.0  # pixels, with half the width of lines and what two renderers do at edges
pytestmark = pytest.mark.slow


def differing(a: Pixels, b: Pixels, least: int = 40) -> float:
    """Return the share of pixels of what is seen in either that are not alike."""
    off = np.abs(a.astype(int) - b).max(axis=2) > least
    return float(off.sum() / (inked(a) | inked(b)).sum())


def middle(tab: Tab) -> tuple[float, float]:
    x, y, w, h = tab.box(CANVAS)
    return x + w / 2, y + h / 2


@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("name", ["moebius_whole", "lateral_buckling_si", "three_supports"])
def test_it_is_where_its_points_are(
    tab: Tab, pages: Pages, name: str, size: tuple[int, int]
) -> None:
    view = pages.view(name)
    tab.open(pages.file(name), size)
    shape = view.shapes[0]
    solution = pages.solved(name)
    s = np.linspace(*solution.scene.interval, 400)
    r, d2, d3 = (solution.sample(s, key) for key in ("r", "d2", "d3"))
    camera = contents(view)["camera"]
    line = placed(tab, camera, r)
    eta = np.interp(s, shape.s, np.einsum("ki,ki->k", shape.b, shape.d3))
    width = np.interp(s, shape.s, shape.half_widths)
    edges = [
        placed(tab, camera, r + (side * width)[:, None] * (d2 + eta[:, None] * d3))
        for side in (-1, 1)
    ]
    seen = inked(ribbon(tab))
    assert bounds(seen) == pytest.approx(extent(np.concatenate(edges)), abs=NEAR)
    # The whole centre line is covered, and there is nothing far from the surface.
    x, y = np.rint(line).astype(int).T
    assert seen[y, x].mean() > 0.99
    across = np.linspace(0, 1, 9)[:, None, None]
    covered = np.concatenate((1 - across) * edges[0] + across * edges[1])
    rows, columns = np.nonzero(seen)
    picked = np.random.default_rng(0).permutation(len(rows))[:300]
    spots = np.column_stack([columns, rows])[picked] + 0.5
    far = np.linalg.norm(spots[:, None] - covered, axis=2).min(axis=1)
    step = np.linalg.norm(np.diff(line, axis=0), axis=1).max()
    assert far.max() < NEAR + step + np.linalg.norm(edges[1] - edges[0], axis=1).max() / 16


def test_a_screen_of_fine_dots_shows_the_same(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("moebius_half"))
    coarse = ribbon(tab)
    tab.open(pages.file("moebius_half"), dots=2)
    fine = ribbon(tab)
    dots = tab.run(f'document.querySelector("{CANVAS}").width')
    assert dots == pytest.approx(2 * coarse.shape[1], abs=3)
    if fine.shape != coarse.shape:  # a picture of all dots
        fine = fine[::2, ::2]
    assert bounds(inked(fine)) == pytest.approx(bounds(inked(coarse)), abs=2)
    assert differing(coarse, fine[: coarse.shape[0], : coarse.shape[1]]) < 0.25


def test_a_drag_turns_it_and_back(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("moebius_half"))
    x, y = middle(tab)
    first = ribbon(tab)
    tab.drag((x, y), (x + 60, y), (x + 120, y))
    turned = ribbon(tab)
    assert differing(first, turned) > 0.3
    tab.drag((x, y), (x - 60, y), (x - 120, y))
    assert differing(first, ribbon(tab)) < 0.01
    tab.drag((x, y), (x, y + 80))
    assert differing(first, ribbon(tab)) > 0.3


def test_a_drag_with_shift_moves_it_as_far_as_the_hand(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("moebius_half"))
    x, y = middle(tab)
    before = bounds(inked(ribbon(tab)))
    held = {"type": "key", "id": "keys", "actions": [{"type": "keyDown", "value": "\ue008"}]}
    tab.bidi.call("input.performActions", {"context": tab.context, "actions": [held]})
    tab.drag((x, y), (x + 10, y), (x + 21, y - 9))
    tab.bidi.call("input.releaseActions", {"context": tab.context})
    moved = bounds(inked(ribbon(tab)))
    assert moved - before == pytest.approx([21, -9, 21, -9], abs=1.5)


def test_a_wheel_zooms_about_the_pointer_and_a_double_click_brings_it_back(
    tab: Tab, pages: Pages
) -> None:
    tab.open(pages.file("moebius_half"))
    first, scale = ribbon(tab), pixels_of_length(tab)
    left, top, right, bottom = bounds(inked(first))
    x, y, w, h = tab.box(CANVAS)
    at = np.array([round(w / 2 + 80), round(h / 2 - 40)])
    tab.wheel(x + at[0], y + at[1], 200)
    grown = pixels_of_length(tab) / scale
    assert grown < 0.9  # away from it
    corners = np.array([[left, top], [right, bottom]])
    expected = at + grown * (corners - at)
    assert bounds(inked(ribbon(tab))) == pytest.approx(expected.ravel(), abs=NEAR)
    tab.drag((x + w / 2, y + h / 2), (x + w / 2 + 90, y + h / 2 + 30))
    tab.click(x + w / 2, y + h / 2, times=2)
    tab.move(x + 2, y + 2)  # off the ribbon, where nothing is marked
    assert (ribbon(tab) == first).all()


def test_two_fingers_zoom(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("moebius_half"), NARROW)
    scale, (x, y) = pixels_of_length(tab), middle(tab)
    left = [(x - 40 - 10 * k, y) for k in range(5)]
    right = [(x + 40 + 10 * k, y) for k in range(5)]
    tab.pinch(left, right)
    assert pixels_of_length(tab) == pytest.approx(2 * scale, rel=0.03)  # 80 apart, then 160
    assert tab.run("visualViewport.scale") == 1  # the ribbon, not the page
    assert tab.faults() == []


def test_keys_turn_zoom_and_bring_it_back(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("moebius_half"))
    first, scale = ribbon(tab), pixels_of_length(tab)
    tab.focus(CANVAS)
    seen = ribbon(tab)
    tab.keys("ArrowRight", "ArrowUp")
    assert differing(seen, ribbon(tab)) > 0.1
    tab.keys("+")
    assert pixels_of_length(tab) == pytest.approx(1.2 * scale, rel=0.02)
    tab.keys("Home")
    assert (ribbon(tab) == seen).all()
    assert differing(first, seen) < 0.2  # the mark of the focus
    for axis, away in (("x", (1, 2)), ("y", (0, 2)), ("z", (0, 1))):
        tab.keys(axis)
        shape = pages.view("moebius_half").shapes[0]
        both = np.concatenate([shape.points(-1), shape.points(1)])[:, away]
        spans = np.ptp(both, axis=0) * pixels_of_length(tab)
        _, _, w, h = tab.box(CANVAS)
        if (spans > np.array([w, h]) - 8).any():
            continue  # cut off
        left, top, right, bottom = bounds(inked(ribbon(tab)[4:-4, 4:-4]))
        assert sorted([right - left, bottom - top]) == pytest.approx(sorted(spans), abs=2 * NEAR)


def test_a_window_of_another_size_shows_it_anew(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("moebius_half"), NARROW)
    narrow = ribbon(tab)
    tab.open(pages.file("moebius_half"))
    size = {"viewport": {"width": NARROW[0], "height": NARROW[1]}}
    tab.bidi.call("browsingContext.setViewport", {"context": tab.context, **size})
    tab.settle()
    assert differing(narrow, ribbon(tab)) < 0.02


@pytest.mark.parametrize("field", ["u2", "u3", "eta", "energy"])
def test_colours_tell_of_a_field(tab: Tab, pages: Pages, field: str) -> None:
    name = "moebius_half"
    tab.open(pages.file(name))
    plain = ribbon(tab)
    choose = 'document.querySelector("#field")'
    tab.run(f'({choose}.value = "{field}", {choose}.dispatchEvent(new Event("change")))')
    assert differing(plain, ribbon(tab), 25) > 0.3
    low, high = (number(tab.text(one)) for one in ("#low", "#high"))
    values = getattr(pages.view(name).shapes[0], field)
    values = np.clip(values, -1.5, 1.5) if field == "eta" else values
    assert low <= values.min() + 0.01 * abs(low)
    assert high >= values.max() - 0.01 * abs(high)
