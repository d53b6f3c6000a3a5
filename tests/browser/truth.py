"""Where a ribbon is to be seen in a page, found without the page's own code.

From the numbers of the solution, the axes of the first view, and the bar of a round length that the
page draws: pixels of what is seen are compared with that.
"""

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tab import Pixels, Tab

Floats = NDArray[np.float64]
PAPER = {False: (255, 255, 255), True: (0x16, 0x18, 0x1C)}  # light, dark
CANVAS = "#stage canvas"


def pixels_of_length(tab: Tab) -> float:
    """Return how many pixels a unit of length is, by the bar."""
    d = tab.run('document.querySelector("#stage path.bar").getAttribute("d")')
    found = re.search(r"h(-?[\d.]+)", d)
    assert found
    label = tab.run('document.querySelector("#stage text.bar").textContent')
    return float(found[1]) / float(label.split()[0])


def placed(tab: Tab, camera: dict[str, Any], points: Floats) -> Floats:
    """Return pixels (k, 2) of the canvas, right and down, of points (k, 3) in the first view."""
    axes, centre = np.array(camera["axes"]), np.array(camera["centre"])
    _, _, width, height = tab.box(CANVAS)
    seen = (points - centre) @ axes[:2].T * pixels_of_length(tab)
    return np.asarray([width / 2, height / 2] + seen * [1, -1])


def inked(pixels: Pixels, dark: bool = False, least: int = 40) -> NDArray[np.bool_]:
    """Return where a picture is not paper."""
    off = np.abs(pixels.astype(int) - PAPER[dark]).max(axis=2)
    return np.asarray(off > least)


def bounds(mask: NDArray[np.bool_]) -> Floats:
    """Return left, top, right and bottom (pixels) of where a mask is true."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return np.array([columns[0], rows[0], columns[-1] + 1, rows[-1] + 1], dtype=float)


def extent(points: Floats) -> Floats:
    """Return left, top, right and bottom of pixels (k, 2)."""
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


def bare(tab: Tab, on: bool = True) -> None:
    """Hide what lies over the picture of the ribbon, so that its pixels alone are seen."""
    word = "hidden" if on else "visible"
    tab.run(f'(document.querySelector("#stage svg").style.visibility = "{word}")')


def ribbon(tab: Tab) -> Pixels:
    """Return the pixels of the ribbon alone."""
    bare(tab)
    try:
        return tab.pixels(tab.box(CANVAS))
    finally:
        bare(tab, on=False)
