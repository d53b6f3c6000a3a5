"""The figures of a solution as files."""

from __future__ import annotations

from pathlib import Path

from ribbonopt.errors import OutputError
from ribbonopt.solution import Solution

from .plane import draw_plane
from .ribbon import draw_ribbon
from .strains import draw_strains
from .subject import subject_of


def save_figures(
    solution: Solution,
    folder: str | Path,
    half_width: float | None = None,
    complete: bool = True,
) -> list[Path]:
    """Write strains.png, plane.png and ribbon.png into an existing folder.

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
    subject = subject_of(solution, complete)
    figures = {
        "strains.png": draw_strains(subject),
        "plane.png": draw_plane(subject),
        "ribbon.png": draw_ribbon(subject, half_width),
    }
    paths = []
    for file, figure in figures.items():
        path = Path(folder) / file
        try:
            figure.savefig(path)
        except OSError as error:
            raise OutputError(f"{path}: cannot be written ({error.strerror})") from error
        paths.append(path)
    return paths
