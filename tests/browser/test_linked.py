"""Curves and ribbon are linked: what a pointer is over in one is marked in the other."""

import numpy as np
import pytest
from numpy.typing import NDArray
from pages import Pages
from tab import Pixels, Tab, number
from truth import CANVAS, Floats, placed, ribbon

from ribbonopt.viewer.view import contents
from ribbonopt.views.shape import Shape

MARK = np.array([0xD1, 0x00, 0x4B])  # the colour of marks in light
pytestmark = pytest.mark.slow


def marked(pixels: Pixels) -> NDArray[np.intp]:
    """Return the pixels (k, 2), right and down, that have the colour of marks."""
    near = np.abs(pixels.astype(int) - MARK).max(axis=2) < 60
    return np.argwhere(near)[:, ::-1]


def ends_of(tab: Tab, pages: Pages, name: str, s: float) -> Floats:
    """Return pixels (2, 2) of both ends of the generatrix at an arclength."""
    view = pages.view(name)
    shape: Shape = view.shapes[0]
    row = int(np.abs(shape.s - s).argmin())
    points = np.array([shape.points(side)[row] for side in (-1, 1)])
    return placed(tab, contents(view)["camera"], points)


def away(spots: Floats, a: Floats, b: Floats) -> Floats:
    """Return distances (k,) of pixels from the line through two, and places along it (0 to 1)."""
    way = b - a
    along = (spots - a) @ way / (way @ way)
    off = np.linalg.norm(spots - a - along[:, None] * way, axis=1)
    return np.stack([off, along])


def read(tab: Tab, panel: str) -> float:
    """Return the arclength that a panel says is marked."""
    return number(tab.text(f".{panel} .chart-foot").split()[-1])


@pytest.mark.parametrize(
    ("name", "share"),
    [
        ("moebius_whole", 0.1),
        ("moebius_whole", 0.62),
        ("moebius_half", 0.37),
        ("moebius_half", 0.9),
    ],
)
def test_a_curve_marks_the_cross_section(tab: Tab, pages: Pages, name: str, share: float) -> None:
    tab.open(pages.file(name))
    assert len(marked(ribbon(tab))) == 0
    x, y, w, h = tab.box(".strains .chart-stage")
    tab.move(x + 50 + share * (w - 60), y + h / 2)
    s = read(tab, "strains")
    assert abs(s - share) < 0.06  # of the length 1: the axis begins some pixels before
    a, b = ends_of(tab, pages, name, s)
    found = marked(ribbon(tab)) + 0.5
    assert len(found) > 20
    off, along = away(found, a, b)
    near = np.linalg.norm(b - a)
    assert off.max() < 4 + 0.01 * near
    assert -0.12 - 4 / near < along.min() < 0.25  # paler where it is hidden
    assert 0.9 < along.max() < 1.12 + 4 / near
    # All other curves are marked there too, at the same arclength.
    for panel in ("forces", "moments"):
        assert read(tab, panel) == pytest.approx(s, abs=1e-4)
    assert tab.run('document.querySelectorAll(".plane .marks circle").length') == 1
    values = tab.text(".strains .chart-head")
    shape = pages.view(name).shapes[0]
    row = int(np.abs(shape.s - s).argmin())
    for k in (2, 3):
        value = getattr(shape, f"u{k}")[row]
        shown = number(values.split(f"u{'₂₃'[k - 2]}")[1].split()[0])
        assert shown == pytest.approx(value, abs=2e-3 * np.abs(getattr(shape, f"u{k}")).max())


def test_it_is_marked_no_longer_where_the_pointer_has_left(tab: Tab, pages: Pages) -> None:
    tab.open(pages.file("moebius_half"))
    first = ribbon(tab)
    x, y, w, h = tab.box(".moments .chart-stage")
    tab.move(x + w / 2, y + h / 2)
    assert len(marked(ribbon(tab))) > 20
    tab.move(5, 5)
    assert (ribbon(tab) == first).all()
    assert tab.run('document.querySelectorAll(".marks circle").length') == 0


@pytest.mark.parametrize("share", [0.15, 0.4, 0.8])
def test_the_ribbon_marks_the_curves(tab: Tab, pages: Pages, share: float) -> None:
    name = "three_supports"  # which does not lie behind itself
    tab.open(pages.file(name))
    view = pages.view(name)
    shape = view.shapes[0]
    row = int(np.abs(shape.s - share).argmin())
    at = placed(tab, contents(view)["camera"], shape.r[row][None])[0]
    x, y, *_ = tab.box(CANVAS)
    tab.move(x + at[0], y + at[1])
    assert read(tab, "strains") == pytest.approx(shape.s[row], abs=0.015)
    assert tab.run('document.querySelectorAll(".strains .marks circle").length') >= 1
    a, b = ends_of(tab, pages, name, read(tab, "strains"))
    off, _ = away(marked(ribbon(tab)) + 0.5, a, b)
    assert off.max() < 5
    tab.move(x + 2, y + 2)
    assert tab.run('document.querySelectorAll(".strains .marks circle").length') == 0


def test_a_point_of_the_plane_marks_its_section(tab: Tab, pages: Pages) -> None:
    name = "moebius_whole"
    tab.open(pages.file(name))
    tab.box(".plane .chart-stage")
    tab.focus(".plane svg")
    tab.keys("ArrowRight", *9 * ["ArrowRight"])
    s = read(tab, "strains")
    a, b = ends_of(tab, pages, name, s)
    off, _ = away(marked(ribbon(tab)) + 0.5, a, b)
    assert off.size > 20
    assert off.max() < 5
