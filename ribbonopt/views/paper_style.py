"""How figures look on paper: sizes, type, lines, files; what a style does to matplotlib's settings.

Text and lines follow the width: at a single column, 3.35 in, letters have 7 to 9 points and lines
two thirds of the width that they have in a figure of its own size. Settings hold while a figure is
drawn and written, and never after.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import field
from functools import cache
from typing import Annotated, Any, Literal

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.scene.faults import InvalidSceneError, dotted
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.scene.schema.validation import validate

Format = Literal["png", "svg", "pdf"]
FORMATS: tuple[Format, ...] = ("png", "svg", "pdf")
Field = Literal["", "u2", "u3", "eta", "energy"]
Inches = Annotated[float, Bounds(ge=1, le=40)]

DPI = 150.0
COLUMN, PAGE = 3.35, 7.2  # inches: a single column, and a figure of its own size
SMALL, USUAL = 8.0, 10.0  # points of the labels of axes at these
NARROW = 5.0  # inches: where words find room in fewer columns
FLATTER = 0.75  # power of the width with which the height shrinks: words shrink less
MOST_PIXELS = 20_000  # along a side of a picture
#: settings of matplotlib that go with the size of type, and with the width of lines
TYPE = {"font.size": 10, "axes.labelsize": 10, "xtick.labelsize": 10, "ytick.labelsize": 10}
SPACE = {
    **{"axes.labelpad": 4.0, "axes.titlepad": 6.0, "xtick.major.pad": 3.5, "ytick.major.pad": 3.5},
    **{"xtick.major.size": 3.5, "ytick.major.size": 3.5, "lines.markersize": 6.0},
    **{"xtick.minor.size": 2.0, "ytick.minor.size": 2.0, "lines.markeredgewidth": 1.0},
    **{"lines.linewidth": 1.5, "axes.linewidth": 0.8, "grid.linewidth": 0.8},
    **{"xtick.major.width": 0.8, "ytick.major.width": 0.8, "patch.linewidth": 1.0},
    **{"xtick.minor.width": 0.6, "ytick.minor.width": 0.6},
}
#: text stays text in files, whose bytes are the same each time
FILES = {"pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "ribbonopt"}
FONTS: Mapping[str, Mapping[str, Any]] = {
    "sans": {"font.family": ["DejaVu Sans"], "mathtext.fontset": "dejavusans"},
    "serif": {"font.family": ["STIXGeneral", "DejaVu Serif"], "mathtext.fontset": "stix"},
}


@dataclass(frozen=True)
class Style:
    """How figures are drawn and written; `Style()` is how the command line does it.

    Attributes
    ----------
    width, height : float or None
        Inches; None leaves them to the figure, whose height follows its width.
    dpi : float
        Pixels per inch, of PNG and of animations.
    format : tuple of str
        Files to write: png, svg, pdf.
    font : str
        "sans", "serif", or the family of a font of this machine.
    font_size : float or None
        Points of the labels of axes; None follows the width.
    line_scale : float or None
        Width of lines over that in a figure of its own size; None follows the width.
    titles : bool
        Whether names, units and captions stand beside a figure; a paper has its own.
    letters : bool
        Whether panels are lettered (a), (b), ...
    camera : str
        What it looks from: "azimuth,elevation" in degrees, or an axis such as "x" or "-z"; "" finds
        a place by itself.
    color : str
        What the surface is coloured by: u2, u3, eta or energy; of a batch a column; "" shows its
        two sides.
    half_width : float or None
        To which ribbons are drawn; None as in `plot_ribbon`.
    labels : dict
        What columns are called beside axes, with formulas between $; goes before what scenes say.
    """

    width: Inches | None = None
    height: Inches | None = None
    dpi: Annotated[float, Bounds(ge=20, le=2400)] = DPI
    format: tuple[Format, ...] = ("png",)
    font: str = "sans"
    font_size: Annotated[float, Bounds(ge=3, le=72)] | None = None
    line_scale: Annotated[float, Bounds(ge=0.05, le=20)] | None = None
    titles: bool = True
    letters: bool = False
    camera: str = ""
    color: str = ""
    half_width: Annotated[float, Bounds(gt=0)] | None = None
    labels: dict[str, str] = field(default_factory=dict)

    @property
    def narrow(self) -> bool:
        """Whether words need fewer columns than in a figure of its own size."""
        return self.width is not None and self.width < NARROW

    @property
    def type_size(self) -> float:
        """Points of the labels of axes."""
        if self.font_size is not None:
            return self.font_size
        return float(np.interp(self.width or PAGE, (COLUMN, PAGE), (SMALL, USUAL)))

    @property
    def lines(self) -> float:
        """Width of lines, over that in a figure of its own size."""
        if self.line_scale is not None:
            return self.line_scale
        return float(np.sqrt(min((self.width or PAGE) / PAGE, 1.0)))

    def page(self, width: float, height: float) -> tuple[float, float]:
        """Return the size of a figure (inches) that by itself has another.

        Raises
        ------
        ModelError
            If it has too many pixels.
        """
        wide = self.width or width
        share = wide / width
        high = self.height or height * (share**FLATTER if share < 1 else share)
        if "png" in self.format and max(wide, high) * self.dpi > MOST_PIXELS:
            raise ModelError(
                f"dpi: found {self.dpi:g}, which makes a picture of {wide * self.dpi:,.0f} x "
                f"{high * self.dpi:,.0f} pixels; expected at most {MOST_PIXELS:,}"
            )
        return wide, high

    @contextmanager
    def applied(self) -> Iterator[None]:
        """Draw, or write, with the settings of this style; those of matplotlib come back.

        Raises
        ------
        ModelError
            If a value of the style is none that it may have.
        """
        import matplotlib

        settings: Any = settings_of(self)  # any version of matplotlib knows these names
        with matplotlib.rc_context(settings):
            yield


PLAIN = Style()


def settings_of(style: Style) -> dict[str, Any]:
    """Return the settings of matplotlib that a style stands for; ModelError where it is faulty."""
    try:
        style = validate(Style, style)
    except InvalidSceneError as error:
        first = error.problems[0]
        raise ModelError(f"style: {dotted(first.path)}: {first}") from None
    size = style.type_size / USUAL
    found: dict[str, Any] = {name: value * size for name, value in TYPE.items()}
    found |= {name: value * style.lines for name, value in SPACE.items()}
    return {**found, **FILES, **_font(style.font)}


@cache
def _font(name: str) -> Mapping[str, Any]:
    """Return the settings of a font; ModelError where this machine has none of that family."""
    if name in FONTS:
        return FONTS[name]
    from matplotlib.font_manager import fontManager

    known = {entry.name for entry in fontManager.ttflist}
    if name not in known:
        from ribbonopt.scene.faults import shown, suggestion

        near = suggestion(name, [*FONTS, *known])
        raise ModelError(
            f"style: font: found {shown(name)}, expected {', '.join(FONTS)} or the family of a "
            f"font of this machine{near}"
        )
    return {"font.family": [name, "DejaVu Sans"], "mathtext.fontset": "dejavusans"}


def sized(size: float) -> float:
    """Return the size of type for what has `size` points in a figure of its own size.

    Type of a small figure differs less in size: the least of it stays legible. Inside `applied`.
    """
    from matplotlib import rcParams

    usual = float(rcParams["font.size"])
    alike = float(np.clip((usual - 6) / 4, 0.25, 1.0))
    return usual * (1 + alike * (size / USUAL - 1))


def spaced(room: float) -> float:
    """Return the room that goes with type, which is so much in a figure of its own size."""
    from matplotlib import rcParams

    return room * float(rcParams["font.size"]) / USUAL


def stroke(width: float) -> float:
    """Return the width of what is so wide in a figure of its own size (points). In `applied`."""
    from matplotlib import rcParams

    return width * float(rcParams["lines.linewidth"]) / SPACE["lines.linewidth"]


def area(size: float) -> float:
    """Return the area of a dot that has this one in a figure of its own size. In `applied`."""
    return size * stroke(1) ** 2


def thinner(look: Mapping[str, Any]) -> dict[str, Any]:
    """Return how lines and marks look, their widths and sizes as `stroke` has them."""
    return {k: stroke(v) if k in ("lw", "ms", "mew") else v for k, v in look.items()}
