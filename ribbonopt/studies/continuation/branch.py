"""A branch of equilibria that was followed: rows of its points, and their solutions on demand.

    branch = ribbonopt.load("results/NAME-branch")      # or Branch.of(Continuation(scene))
    branch[12].plot()

A point is kept as what it takes to restore it (`stored`), some kilobytes; a solution is built from
that each time that it is asked for, so that long branches fit into memory.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from ribbonopt.doors import branch_drawn, frame_of
from ribbonopt.plain import Row, finite
from ribbonopt.scene import Scene
from ribbonopt.scene.continuation import ContinuationStage
from ribbonopt.scene.stages import ends_of, stages_of
from ribbonopt.solution.at_home import in_notebook
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.columns import column_of, names_of
from ribbonopt.text import one_line, shortened

from .continuation import Continuation
from .files import FILE, load_branch, rows_of
from .recorded import VALUE
from .stored import Stored, state_of
from .walk.branches import Key
from .walk.points import POINT, Point
from .walk.walk import Ending

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame


class Branch(Sequence[Solution]):
    """The points of all stages and branches of one continuation, by their numbers from 0.

    `branch[i]` is the solution of point i, restored; a slice a list of them. Iterating restores one
    after another; `rows` are at hand at once.

    Attributes
    ----------
    scene : Scene
        The scene, whose `continuation` says what was followed.
    rows : list of dict
        What is recorded of each point, by the names that `ribbonopt continue --help` lists.
    folder : Path or None
        Where it was read from.
    """

    def __init__(
        self,
        scene: Scene,
        lines: list[dict[str, Any]],
        folder: Path | None = None,
        continuation: Continuation | None = None,
    ) -> None:
        """Take the lines of a branch file; `continuation`, if given, is what they are of."""
        self.scene, self.folder = scene, folder
        self.rows: list[Row] = rows_of(lines)
        self._lines, self._known = lines, continuation

    @classmethod
    def load(cls, folder: str | Path) -> Branch:
        """Return the branch of a folder; OutputError if it holds none, or is damaged."""
        scene, lines = load_branch(folder)
        return cls(scene, lines, Path(folder))

    @classmethod
    def of(
        cls, continuation: Continuation, points: Iterable[Point[Solution]] | None = None
    ) -> Branch:
        """Return the branch that a continuation finds, followed to its end.

        Parameters
        ----------
        continuation
            What is followed, from its start.
        points
            Its points, if they are at hand: then nothing is followed. They are taken one by one
            and not kept.
        """
        found = continuation if points is None else points
        lines: list[dict[str, Any]] = [
            {"row": finite(dict(point.row)), "state": state_of(point)} for point in found
        ]
        for (stage, branch), ending in continuation.endings.items():
            how = {"reached": ending.reached, "reason": ending.reason}
            lines.append({"ending": {"stage": stage, "branch": branch, **how}})
        return cls(continuation.scene, lines, None, continuation)

    @property
    def solutions(self) -> Sequence[Solution]:
        """The solutions, each restored when it is asked for: the branch itself."""
        return self

    @property
    def special(self) -> list[Row]:
        """Rows of folds, branch points, buckling points and kinks."""
        return [row for row in self.rows if row["kind"] != POINT]

    @property
    def endings(self) -> dict[Key, Ending]:
        """How each stage, and each branch switched to, has ended, by (stage, branch)."""
        found = [line["ending"] for line in self._lines if "ending" in line]
        return {(e["stage"], e["branch"]): Ending(e["reached"], e["reason"]) for e in found}

    @property
    def reached(self) -> bool:
        """Whether all stages have reached their goals."""
        ways = {(i, w) for i, s in enumerate(self._stages) for w in range(len(ends_of(s)))}
        ended = self.endings
        return all(key in ended and ended[key].reached for key in ways)

    @property
    def columns(self) -> list[str]:
        """Names of all columns of the rows."""
        return names_of(self.rows)

    @overload
    def __getitem__(self, number: int) -> Solution: ...

    @overload
    def __getitem__(self, number: slice) -> list[Solution]: ...

    def __getitem__(self, number: int | slice) -> Solution | list[Solution]:
        """Return the solution of a point, or of several."""
        lines = self._points[number]
        if isinstance(lines, list):
            return [self._stored.point(line).solution for line in lines]
        return self._stored.point(lines).solution

    def __len__(self) -> int:
        """Return the number of points."""
        return len(self.rows)

    def __iter__(self) -> Iterator[Solution]:
        """Yield the solutions, each restored in its turn."""
        return (self._stored.point(line).solution for line in self._points)

    def to_pandas(self) -> DataFrame:
        """Return the rows as a table, with the columns of `branch.csv`; needs pandas."""
        return frame_of(self.rows, self.columns)

    def plot(self, x: str, y: str, style: object | None = None) -> Figure:
        """Return a diagram of two columns, such as "angle" and "energy".

        Parameters
        ----------
        x, y
            Columns; of a path its last part will do (`angle` for `parameters.angle`), and `value`
            is the number that each stage moves.
        style
            A `ribbonopt.views.Style`.

        Raises
        ------
        SceneError
            If there is no such column, or are several.
        """
        names, scene = [*self.columns, VALUE], self.scene
        pair = column_of(x, names), column_of(y, names)
        log = [stage.moved for stage in self._stages if stage.scale == "log"]
        si = scene.ribbon is not None
        return branch_drawn(self.rows, pair, log, scene.name, scene.labels, si, style)

    def __repr__(self) -> str:
        """Say what it is in one line."""
        name = shortened(one_line(self.scene.name), 40)
        moved = ", ".join(dict.fromkeys(stage.moved for stage in self._stages))
        kinds = Counter(row["kind"] for row in self.special)
        special = "".join(f", {count} {kind}{'s' * (count > 1)}" for kind, count in kinds.items())
        goal = "goal reached" if self.reached else "goal not reached"
        points = f"{len(self)} point{'s' * (len(self) != 1)} along {shortened(moved, 80)}"
        return f"<Branch {name}: {points}{special}; {goal}>"

    def _repr_html_(self) -> str | None:
        return in_notebook(self)

    @property
    def _stages(self) -> tuple[ContinuationStage, ...]:
        return stages_of(self.scene)

    @cached_property
    def _points(self) -> list[dict[str, Any]]:
        return [line for line in self._lines if "row" in line]

    @cached_property
    def continuation(self) -> Continuation:
        """What was followed, built when a solution is first asked for."""
        return self._known or Continuation(self.scene)

    @cached_property
    def _stored(self) -> Stored:
        source = FILE if self.folder is None else self.folder / FILE
        return Stored(self.continuation, self._lines, source)
