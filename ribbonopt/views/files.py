"""The figures of a solution as files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ribbonopt.errors import ModelError, OutputError, ViewError
from ribbonopt.output.declared import PICTURES
from ribbonopt.scene.faults import shown
from ribbonopt.solution.solution import Solution

from .paper_style import PLAIN, Style
from .plane import draw_plane
from .ribbon import draw_ribbon
from .strains import draw_strains
from .style import Drawn, draw_all
from .subject import Subject, subject_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def save_figures(
    solution: Solution,
    folder: str | Path,
    half_width: float | None = None,
    complete: bool = True,
    style: Style = PLAIN,
) -> list[Path]:
    """Write strains.png, plane.png and ribbon.png into an existing folder.

    They are .svg or .pdf, or several, as the style says.
    Those of other equilibria of the scene go to `equilibria/2` in it, and so on. Where a ribbon
    bends in its own plane only its strains can be drawn: `draw_figures` says so.

    Parameters
    ----------
    solution
        What to draw.
    folder
        Where; files of these names are replaced.
    half_width, complete
        As in `plot_ribbon`.
    style
        Size, type, files, camera and colours.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    return draw_figures(solution, folder, half_width, complete, style).paths


def draw_figures(
    solution: Solution,
    folder: str | Path,
    half_width: float | None = None,
    complete: bool = True,
    style: Style = PLAIN,
) -> Drawn:
    """Write the pictures of `save_figures`; return where they are, and what was left out and why.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    paths, left_out = _save(subject_of(solution, complete), Path(folder), half_width, style)
    for i, other in enumerate(solution.others, start=2):
        inner = Path(folder) / "equilibria" / str(i)
        subject = subject_of(other, complete)
        subject = replace(subject, name=f"{subject.name}, equilibrium {i}")
        try:
            inner.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(f"{inner}: cannot be written ({error.strerror})") from error
        more = _save(subject, inner, half_width, style)
        paths += more.paths
        left_out += [f"equilibria/{i}/{text}" for text in more.left_out]
    return Drawn(paths, left_out)


def plot_solution(
    solution: Solution, kind: str = "ribbon", style: Style = PLAIN, complete: bool = True
) -> Figure:
    """Draw one figure of a solution: "ribbon", "strains", "plane" or "modes"; see `plot_ribbon`.

    Raises
    ------
    ModelError
        If it is another kind, or the style has a value that it may not have.
    ViewError
        If there is no such figure of this ribbon.
    """
    if kind not in (*KINDS, MODES):
        known = ", ".join((*KINDS, MODES))
        raise ModelError(f"kind: found {shown(kind)}, expected one of {known}")
    if kind == MODES:
        return _modes(solution, style)
    with style.applied():
        return KINDS[kind](subject_of(solution, complete), style)


def _ribbon(subject: Subject, style: Style) -> Figure:
    return draw_ribbon(subject, None, style)


def _modes(solution: Solution, style: Style) -> Figure:
    from ribbonopt.checks.modes import modes_of  # few figures are of them

    from .modes import plot_modes

    found = modes_of(solution)
    if isinstance(found, str):
        raise ViewError(f"{solution.scene.name}: there are no modes to draw: {found}")
    return plot_modes(solution, found, style)


MODES = "modes"
KINDS: dict[str, Callable[[Subject, Style], Figure]] = {
    "ribbon": _ribbon,
    "strains": draw_strains,
    "plane": draw_plane,
}


def _save(subject: Subject, folder: Path, half_width: float | None, style: Style) -> Drawn:
    drawings = {
        "strains.png": partial(draw_strains, subject, style),
        "plane.png": partial(draw_plane, subject, style),
        "ribbon.png": partial(draw_ribbon, subject, half_width, style),
    }
    return draw_all(drawings, folder, style)


class Pictures:
    """Strains, their path in the plane, and the ribbon in space, as an export of a solution."""

    name, files = "pictures", PICTURES

    def write(self, solution: Solution, folder: Path) -> list[str]:
        """Draw the pictures of a solution and of its other equilibria; say what was left out."""
        return draw_figures(solution, folder).left_out
