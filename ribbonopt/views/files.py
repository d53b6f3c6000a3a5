"""The figures of a solution as files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ribbonopt.errors import OutputError
from ribbonopt.output.declared import PICTURES
from ribbonopt.solution.solution import Solution

from .plane import draw_plane
from .ribbon import draw_ribbon
from .strains import draw_strains
from .style import save_all
from .subject import Subject, subject_of


def save_figures(
    solution: Solution,
    folder: str | Path,
    half_width: float | None = None,
    complete: bool = True,
) -> list[Path]:
    """Write strains.png, plane.png and ribbon.png into an existing folder.

    Those of other equilibria of the scene go to `equilibria/2` in it, and so on.

    Parameters
    ----------
    solution
        What to draw.
    folder
        Where; files of these names are replaced.
    half_width, complete
        As in `plot_ribbon`.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    paths = _save(subject_of(solution, complete), Path(folder), half_width)
    for i, other in enumerate(solution.others, start=2):
        inner = Path(folder) / "equilibria" / str(i)
        subject = subject_of(other, complete)
        subject = replace(subject, name=f"{subject.name}, equilibrium {i}")
        try:
            inner.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(f"{inner}: cannot be written ({error.strerror})") from error
        paths += _save(subject, inner, half_width)
    return paths


def _save(subject: Subject, folder: Path, half_width: float | None) -> list[Path]:
    figures = {
        "strains.png": draw_strains(subject),
        "plane.png": draw_plane(subject),
        "ribbon.png": draw_ribbon(subject, half_width),
    }
    return save_all(figures, folder)


class Pictures:
    """Strains, their path in the plane, and the ribbon in space, as an export of a solution."""

    name, files = "pictures", PICTURES

    def write(self, solution: Solution, folder: Path) -> None:
        """Draw the pictures of a solution and of its other equilibria."""
        save_figures(solution, folder)
