"""What a branch file says, checked as it is read: points that follow one another, and endings.

Whether the state of a point fits its row and its scene, `Stored` finds out as it restores it.
"""

from __future__ import annotations

import base64
import binascii
from dataclasses import field
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.output.records import checked
from ribbonopt.output.saved import refuse_mesh
from ribbonopt.plain import Row, is_number
from ribbonopt.reading import MEGA, Kind
from ribbonopt.scene import Scene
from ribbonopt.scene.quantities import ANSWERS
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.scene.stages import stages_of
from ribbonopt.studies.lines import whole_lines

from .walk.branches import Key
from .walk.points import POINT

BRANCH = Kind(
    "points of a branch",
    most=4000 * MEGA,
    remedy="remove this line and all after it: the points before are kept, and --resume finds the "
    "others again",
)
FILE, SCENE = "branch.jsonl", "scene.yaml"
ARRAYS = ("w", "widths", "tangent")
Count = Annotated[int, Bounds(ge=0)]


@dataclass(frozen=True)
class SavedRow:
    """What all rows have beside the numbers that the scene records."""

    number: Count
    stage: Count
    branch: Count
    parameter: str
    kind: Literal[
        "point",
        "fold",
        "branch point",
        "buckling point",
        "kink",
        "cusp",
        "isola centre",
        "crossing",
        "double point",
        "turn",
    ]
    negative: Count | None
    error: float | None
    origin: Count | None = None
    of: str | None = None
    note: str = ""
    intervals: Count | None = None
    iterations: Count | None = None
    switches: tuple[float, ...] = ()


@dataclass(frozen=True)
class SavedState:
    """What it takes to go on from a point; arrays as base64 of their bytes."""

    position: float
    step: Annotated[float, Bounds(gt=0)]
    sign: float
    sheets: tuple[int, ...]
    elements: tuple[int, ...]
    w: str
    widths: str
    tangent: str
    first_position: float | None = None
    across: str | None = None


@dataclass(frozen=True)
class SavedEnding:
    """How a stage, or a branch of it, has ended, and how many points there were then."""

    stage: Count
    branch: Count
    reached: bool
    reason: str
    points: Count | None = None


@dataclass()
class _Course:
    """What the lines before say, to which the next one must fit."""

    scene: Scene
    count: int = 0
    ended: set[Key] = field(default_factory=set)

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """What each stage moves."""
        return tuple(stage.moved for stage in stages_of(self.scene))

    @cached_property
    def numbers(self) -> frozenset[str]:
        """Columns that are numbers, or unknown."""
        return frozenset((*ANSWERS, *self.scene.record, *self.moving, *self.others))

    @cached_property
    def others(self) -> tuple[str, ...]:
        """What loci move besides."""
        return tuple(stage.paths[0] for stage in stages_of(self.scene) if stage.is_locus)

    def checked(self, data: Any, where: str) -> dict[str, Any]:
        """Return a line, with its parameter under its own name; OutputError if it is damaged."""
        if not isinstance(data, dict) or not data.keys() & {"row", "ending"}:
            raise BRANCH.damaged(where, "expected a point (row, state), or an ending")
        try:
            return self._ending(data, where) if "ending" in data else self._point(data, where)
        except ValueError as error:
            raise BRANCH.damaged(where, str(error)) from None

    def _ending(self, line: dict[str, Any], where: str) -> dict[str, Any]:
        ending = checked(SavedEnding, line["ending"], where, BRANCH)
        self._fits(ending.stage, ending.branch)
        if ending.points not in (None, self.count):
            raise ValueError(f"points: {ending.points} were there, {self.count} are left")
        self.ended.add((ending.stage, ending.branch))
        return line

    def _point(self, line: dict[str, Any], where: str) -> dict[str, Any]:
        row = checked(SavedRow, line["row"], where, BRANCH)
        state = checked(SavedState, line.get("state"), where, BRANCH)
        parameter = self._fits(row.stage, row.branch)
        if row.number != self.count:
            raise ValueError(f"number: found {row.number}, expected {self.count}, as lines follow")
        if row.origin is not None and row.origin >= row.number:
            raise ValueError("origin: expected the number of a point before")
        if row.parameter != parameter:
            raise ValueError(f"parameter: expected {parameter}, which its stage moves")
        line = {**line, "row": _renamed(line["row"])}
        _refuse_values(line["row"], self.numbers)
        _refuse_state(state)
        if row.intervals not in (None, sum(state.elements)):
            raise ValueError("intervals: expected as many as there are elements")
        self.count += 1
        return line

    def _fits(self, stage: int, branch: int) -> str:
        """Return what a stage moves; ValueError where the branch is none that can go on."""
        if stage >= len(self.moving):
            raise ValueError(f"stage: found {stage}, its scene has {len(self.moving)}")
        if (stage, branch) in self.ended:
            raise ValueError("stage, branch: it has ended in a line before")
        return self.moving[stage]


def read_branch(path: Path, scene: Scene) -> list[dict[str, Any]]:
    """Return the lines of a branch file; special points after the last regular one are left out.

    They will be found again.

    Raises
    ------
    OutputError
        Names the first line that is damaged, and says what to do.
    """
    lines = whole_lines(path, BRANCH, _Course(scene).checked)
    while lines and "row" in lines[-1] and lines[-1]["row"]["kind"] != POINT:
        lines.pop()
    return lines


def packed(array: Array) -> str:
    """Return numbers (k,) as base64 of their bytes."""
    return base64.b64encode(np.asarray(array, dtype="<f8").tobytes()).decode("ascii")


def unpacked(text: str) -> Array:
    """Return numbers (k,) from base64; ValueError if it is none, or they are not finite."""
    try:
        data = base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        raise ValueError("no base64") from None
    if len(data) % 8:
        raise ValueError("no whole number of numbers")
    array = np.array(np.frombuffer(data, dtype="<f8"), dtype=float)
    if not np.isfinite(array).all():
        raise ValueError("numbers that are not finite")
    return array


def _refuse_values(row: Row, numbers: frozenset[str]) -> None:
    for name in numbers & row.keys():
        if not is_number(row[name]) and (row[name] is not None or name == row["parameter"]):
            raise ValueError(f"{name}: expected a number")
    if row["parameter"] not in row:
        raise ValueError(f"{row['parameter']}: missing; expected a number")


def _refuse_state(state: SavedState) -> None:
    arrays = {}
    for name in ARRAYS:
        try:
            arrays[name] = unpacked(getattr(state, name))
        except ValueError as error:
            raise ValueError(f"state.{name}: {error}") from None
    refuse_mesh(state.sheets, state.elements, arrays["widths"], arrays["w"])
    count = 1 if state.across is None else 2
    if len(arrays["tangent"]) != len(arrays["w"]) + count:
        more = "one number" if count == 1 else "two numbers"
        raise ValueError(f"state.tangent: expected {more} more than unknowns")
    if state.across is not None and state.first_position is None:
        raise ValueError("state.first_position: missing beside across")
    if state.across is not None and len(unpacked(state.across)) != len(arrays["tangent"]):
        raise ValueError("state.across: expected as many numbers as state.tangent")


def _renamed(row: Row) -> Row:
    """Return a row with its parameter under its own name, which once was called `value`."""
    if "value" not in row:
        return row
    return {row["parameter"] if key == "value" else key: value for key, value in row.items()}
