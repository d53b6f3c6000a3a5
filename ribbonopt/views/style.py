"""Colours and the blank page, common to the figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ribbonopt.errors import ModelError, PictureError, ViewError
from ribbonopt.output.staging import replaced
from ribbonopt.scene.units import Units
from ribbonopt.text import drawn

from .lettering import letter
from .paper_style import PLAIN, USUAL, Style, sized

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .page import Page

ROOM = 0.1  # inches around what is drawn
BENDING = "#1f5fa8"
TWIST = "#c2410c"
IN_PLANE = "#0b7a53"
RATIO = "#4a4a4a"
ALLOWED = "#dcefdc"  # the paper's green: |eta| <= 1
FORBIDDEN = "#fbd9b0"  # the paper's orange: |eta| > 1
INK = "#222222"
FAINT = "#777777"
SPECIAL, SI = r"units $Dw = L = 1$", "SI units"
TITLE = 44  # letters of a title
DASHES = (0, (4, 2))  # what follows by symmetry


def blank(width: float, height: float, style: Style = PLAIN) -> Page:
    """Return an empty figure that renders without a display and without global state.

    It has the size of its style, or else this one (inches).
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    from .page import Page

    size = style.page(width, height)
    pad = ROOM * style.type_size / USUAL
    layout = ConstrainedLayoutEngine(w_pad=pad, h_pad=pad)
    figure = Page(figsize=size, dpi=style.dpi, facecolor="white", layout=layout)
    figure.style = style
    FigureCanvasAgg(figure)
    return figure


class Drawn(NamedTuple):
    """Pictures that were written, and those that were left out, each with its reason."""

    paths: list[Path]
    left_out: list[str]


def draw_all(
    drawings: Mapping[str, Callable[[], Figure]], folder: Path, style: Style = PLAIN
) -> Drawn:
    """Draw and write pictures by the names of their files; leave out those that there are none of.

    A name ends in .png; each picture is written in all formats of the style.

    Raises
    ------
    PictureError
        If one cannot be drawn or written; the others are there all the same.
    """
    paths: list[Path] = []
    left_out: list[str] = []
    failed: dict[str, Exception] = {}
    for name, draw in drawings.items():
        files = [(folder / name).with_suffix(f".{end}") for end in style.format]
        try:
            with style.applied():
                figure = draw()
                if style.letters:
                    letter(figure)
            for path in files:
                _save(figure, path)
                paths.append(path)
        except ViewError as error:
            for path in files:
                path.unlink(missing_ok=True)  # that of an older result
            left_out.append(f"{name}: {error}")
        except ModelError:  # of the style, and so of all pictures
            raise
        except OSError as error:
            failed[f"{folder / name}: cannot be written ({error.strerror or error})"] = error
        except Exception as error:  # whatever it is: the next picture may be drawn
            failed[f"{folder / name}: cannot be drawn ({type(error).__name__}: {error})"] = error
    if failed:
        raise PictureError("; ".join(failed)) from next(iter(failed.values()))
    return Drawn(paths, left_out)


def _save(figure: Figure, path: Path) -> None:
    with replaced(path) as new:
        figure.savefig(new, format=path.suffix[1:])


def head(axes: Axes, name: str, units: Units, pad: float = 6) -> None:
    """Title: the scene's name, and the units."""
    title(axes, name, pad)
    if style_of(axes).titles:
        axes.set_title(SI if units.si else SPECIAL, loc="right", fontsize=sized(9), pad=pad)


def title(axes: Axes, name: str, pad: float = 6) -> None:
    """Write the name of a scene or a study over axes, as it is; where the style has titles."""
    words = drawn(name, TITLE) if style_of(axes).titles else ""
    axes.set_title(words, loc="left", fontsize=sized(12), fontweight="bold", pad=pad)


def style_of(axes: Axes) -> Style:
    """Return the style of the page that axes are on."""
    part: Any = axes.figure
    page = part.figure  # the whole of which it may be a part, in any version of matplotlib
    return getattr(page, "style", PLAIN)


def tidy(axes: Axes) -> None:
    """Light frame and ticks."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=sized(9))
