"""Colours and the blank page, common to the figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ribbonopt.errors import PictureError, ViewError
from ribbonopt.output.staging import replaced
from ribbonopt.scene.units import Units
from ribbonopt.text import drawn

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DPI = 150
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


def blank(width: float, height: float) -> Figure:
    """Return an empty figure (inches) that renders without a display and without global state."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    from .page import Page

    layout = ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.1)
    figure = Page(figsize=(width, height), dpi=DPI, facecolor="white", layout=layout)
    FigureCanvasAgg(figure)
    return figure


class Drawn(NamedTuple):
    """Pictures that were written, and those that were left out, each with its reason."""

    paths: list[Path]
    left_out: list[str]


def draw_all(drawings: Mapping[str, Callable[[], Figure]], folder: Path) -> Drawn:
    """Draw and write pictures by the names of their files; leave out those that there are none of.

    Raises
    ------
    PictureError
        If one cannot be drawn or written; the others are there all the same.
    """
    paths: list[Path] = []
    left_out: list[str] = []
    failed: dict[str, Exception] = {}
    for name, draw in drawings.items():
        try:
            _save(draw(), folder / name)
            paths.append(folder / name)
        except ViewError as error:
            (folder / name).unlink(missing_ok=True)  # that of an older result
            left_out.append(f"{name}: {error}")
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
    axes.set_title(SI if units.si else SPECIAL, loc="right", fontsize=9, pad=pad)


def title(axes: Axes, name: str, pad: float = 6) -> None:
    """Write the name of a scene or a study over axes, as it is."""
    words = drawn(name, TITLE)
    axes.set_title(words, loc="left", fontsize=12, fontweight="bold", pad=pad)


def tidy(axes: Axes) -> None:
    """Light frame and ticks."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=9)
