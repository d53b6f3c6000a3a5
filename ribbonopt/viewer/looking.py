"""What is looked at: a solution, a branch or a batch, at hand or in a folder, as a view."""

from __future__ import annotations

from pathlib import Path

from ribbonopt.checks.modes import Modes
from ribbonopt.errors import ViewError
from ribbonopt.output.staging import recovered
from ribbonopt.reading import is_file
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.batch.results import Batch
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.studies.loading import load
from ribbonopt.studies.maps.map import Map

from .view import View


def view_of(
    thing: Solution | Branch | Batch | Map,
    half_width: float | None = None,
    modes: Modes | None = None,
) -> View:
    """Return the view of what was solved.

    Parameters
    ----------
    thing
        A solution, with the other equilibria that it knows; a branch; a batch.
    half_width
        To which all ribbons are drawn where their relative width is 1, in the units of the scene.
        Default: their own, where the scene says it, else one with which generatrices keep apart.
    modes
        Of a solution: its small vibrations (`solution.modes()`), to be seen in motion.

    Raises
    ------
    ModelError
        If half_width is not positive.
    ViewError
        If there is nothing to be seen, or a branch or a batch is to have modes; or it is a map,
        which is a plane figure.
    OutputError
        If a point of a branch, or a saved solution, is damaged.
    """
    if modes is not None and not isinstance(thing, Solution):
        raise ViewError("modes are seen of a single solution, found a branch or a batch")
    if isinstance(thing, Branch):
        from .branches import view_of_branch

        return view_of_branch(thing, half_width)
    if isinstance(thing, Batch):
        from .batches import view_of_batch

        return view_of_batch(thing, half_width)
    if isinstance(thing, Map):
        raise ViewError(thing.held)
    from .solutions import view_of_solution

    return view_of_solution(thing, half_width, modes)


def saved_view(path: str | Path, half_width: float | None = None, modes: bool = False) -> View:
    """Return the view of a folder, as `view_of`; of a result with all that its folder says.

    `modes` asks for small vibrations of a result, which are shown anyway where they stand there.

    Raises
    ------
    OutputError
        If there is no result there, or its files are damaged or do not belong together.
    """
    thing = load(path)
    if not isinstance(thing, Solution):
        if modes:
            raise ViewError(f"{path}: is a branch or a batch; modes are seen of a single result")
        return view_of(thing, half_width)
    from .solutions import view_of_result

    folder = recovered(path)
    return view_of_result(thing, folder.parent if is_file(folder) else folder, half_width, modes)
