"""What a map's folder says, checked as it is read: `map.json` and the rows of `jobs.jsonl`."""

from __future__ import annotations

import os
from dataclasses import field
from pathlib import Path
from typing import Annotated, Any

from ribbonopt.classes import dataclass
from ribbonopt.errors import OutputError
from ribbonopt.output.records import checked
from ribbonopt.reading import MEGA, Kind, read_json
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.studies.lines import whole_lines

FILE, TABLE, JOBS, SCENE = "map.json", "map.csv", "jobs.jsonl", "scene.yaml"

MAP = Kind("a map", most=1000 * MEGA, remedy="`ribbonopt map --resume` writes it again")
LINES = Kind(
    "rows of a map's work",
    most=1000 * MEGA,
    remedy="remove this line: the others are kept, and --resume does its work again",
)
Count = Annotated[int, Bounds(ge=0)]
Pair = tuple[float, float]


@dataclass(frozen=True)
class SavedJob:
    """A line of `jobs.jsonl`."""

    place: str
    digest: str


@dataclass(frozen=True)
class SavedJobRow:
    """What the row of any job says."""

    status: str
    verified: bool
    message: str = ""


@dataclass(frozen=True)
class SavedMark:
    """A special point of a locus."""

    kind: str
    at: Pair
    error: float | None = None


@dataclass(frozen=True)
class SavedLocus:
    """A locus: where its points are, in the units of the scene, and the curve through them.

    `changes` says whether the number of stable shapes is another one on its other side.
    """

    number: Count
    kind: str
    points: tuple[Pair, ...]
    curve: tuple[Pair, ...] = ()
    special: tuple[SavedMark, ...] = ()
    negative: Count | None = None
    changes: bool | None = None
    error: float | None = None
    folder: str = ""
    ending: str = ""


@dataclass(frozen=True)
class SavedShape:
    """What is told of one equilibrium at a point."""

    energy: float | None
    negative: Count | None = None
    stable: bool | None = None
    in_plane: Count | None = None
    image: Count | None = None
    symmetry: str | None = None
    error: float | None = None


@dataclass(frozen=True)
class SavedPoint:
    """A point at which shapes were counted."""

    number: Count
    region: Count
    at: Pair
    verified: bool
    folder: str
    count: Count | None = None
    stable: Count | None = None
    shapes: tuple[SavedShape, ...] = ()
    told: str = ""
    message: str = ""


@dataclass(frozen=True)
class SavedRegion:
    """A region: corners around it and around its holes, and how many shapes there are."""

    number: Count
    at: Pair
    rings: tuple[tuple[Pair, ...], ...]
    count: Count | None = None
    stable: Count | None = None
    below: float | None = None
    narrow: bool = False
    area: float = 0.0
    clear: float = 0.0
    beside: tuple[Count, ...] = ()


@dataclass(frozen=True)
class SavedLine:
    """A line on which branches were followed."""

    along: str
    value: float
    verified: bool
    folder: str = ""
    branches: Count = 0
    special: Count = 0
    message: str = ""
    endings: tuple[str, ...] = ()


@dataclass(frozen=True)
class SavedMap:
    """What `map.json` says."""

    name: str
    status: str
    message: str
    x: str
    y: str
    ranges: tuple[Pair, Pair]
    lines: tuple[SavedLine, ...]
    loci: tuple[SavedLocus, ...]
    regions: tuple[SavedRegion, ...]
    points: tuple[SavedPoint, ...]
    doubts: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    si: bool = False
    labels: dict[str, str] = field(default_factory=dict)


def read_map(folder: Path) -> SavedMap:
    """Return what a folder says of its map; OutputError if it has none, or it is damaged."""
    path = folder / FILE
    if not os.path.exists(path):
        raise OutputError(f"{folder}: no map yet; `ribbonopt map --resume` goes on with it")
    return checked(SavedMap, read_json(path, MAP), str(path), MAP)


def read_jobs(folder: Path) -> list[dict[str, Any]]:
    """Return the lines of the work that was done; OutputError names one that is damaged."""

    def line_of(data: Any, where: str) -> dict[str, Any]:
        checked(SavedJob, data, where, LINES)
        checked(SavedJobRow, data.get("row"), where, LINES)
        found: dict[str, Any] = data
        return found

    return whole_lines(folder / JOBS, LINES, line_of)
