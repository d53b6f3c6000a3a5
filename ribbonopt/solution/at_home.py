"""What a solution offers at a prompt or in a notebook: a short name, a figure, a table, a viewer.

All of it is made in rooms above, through `ribbonopt.doors`, when it is asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ribbonopt.doors import door, frame_along, modes_or_reason, solution_drawn, told_in_short
from ribbonopt.errors import ConvergenceError, ViewError

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame


class AtHome:
    """Methods of a solution that show it, and that nothing else needs."""

    def plot(self, kind: str = "ribbon", style: object | None = None) -> Figure:
        """Return a figure.

        Parameters
        ----------
        kind
            "ribbon", the shape; "strains" along s; "plane", the path in the (u2, u3) plane; "modes"
            of small vibrations.
        style
            A `ribbonopt.views.Style`, as for a paper; unless given as the command line draws.

        Raises
        ------
        ViewError
            If there is no such picture, such as the plane of a rod.
        """
        return solution_drawn(self, kind, style)

    def modes(self, count: int = 8, planar: bool = False) -> Any:
        """Return small vibrations about it, the lowest first, as `ribbonopt.checks.modes.Modes`.

        `frequencies` (count,) in Hz or in units of sqrt(Dw/(rho L^4)), negative where a disturbance
        grows; `errors`, relative; shapes along s.

        Parameters
        ----------
        count
            How many.
        planar
            Of a planar ribbon: only motion in its plane.

        Raises
        ------
        ConvergenceError
            If it has none, as it is no equilibrium, or its energy has no second variation.
        """
        found = modes_or_reason(self, count, planar)
        if isinstance(found, str):
            raise ConvergenceError(f"there are no modes: {found}", "no_modes")
        return found

    def to_pandas(self, s: Any = None) -> DataFrame:
        """Return a table along s: 201 evenly spaced rows, or one for each of arclengths s (k,).

        Positions, directors, force and moment in the lab frame, strains and components along the
        directors, in the units of the scene; `ribbonopt.output.frames.frame_along` lists the
        columns. Needs pandas (`pip install ribbonopt[pandas]`).
        """
        return frame_along(self, s)

    def __repr__(self) -> str:
        """Say what it is in one line."""
        return told_in_short(self)

    def _repr_html_(self) -> str | None:
        return in_notebook(self)


def in_notebook(thing: object) -> str | None:
    """Return the viewer of a solution, a branch or a batch as HTML.

    None where there is nothing to be seen, so that a notebook shows words.
    """
    try:
        page: str = door("viewer", "embedded")(thing)
    except ViewError:
        return None
    return page
