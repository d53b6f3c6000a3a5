"""Named outputs at many places: evaluated when asked for, many of them at once.

Checks and estimates ask for few of all outputs, of every solution. These are evaluated together, by
functions that have no others, as columns of one array; what nobody asks for is never evaluated.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.outputs import SLOPE
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.transcription.buffered import Mapped

Rows = slice | NDArray[np.bool_]

MOMENTS = ("m1", "m2", "m3")
PLACES = ("r", "d1", "d2", "d3", "u", "switching", "leap")
NODES = ("r", "d1", "d2", "d3", "u", "n", "m", "H", "n_dot_m", "switching", "leap", "extension")
TOLD = ("n2", *MOMENTS, "law_residual", "orthonormality", "eta", SLOPE)
STAGES = ("energy", "potential", "u", "n", "m", *MOMENTS, "switching", "leap", "law_residual")


@dataclass(frozen=True, eq=False)
class Choice:
    """Some outputs of a problem, one after another in the columns of an array.

    Attributes
    ----------
    problem : BoundaryValueProblem
        What has the outputs.
    columns : mapping of str to slice or int
        Columns of each, by name: of a scalar one number.
    width : int
        Number of all columns.
    """

    problem: BoundaryValueProblem
    columns: Mapping[str, slice | int]
    width: int

    @classmethod
    def of(cls, problem: BoundaryValueProblem, names: tuple[str, ...]) -> Choice:
        """Choose those outputs of a problem that have these names; there may be no such."""
        columns: dict[str, slice | int] = {}
        at, sizes = 0, problem.output_sizes
        for name in dict.fromkeys(names):
            if size := sizes.get(name):
                columns[name] = at if size == 1 else slice(at, at + size)
                at += size
        return cls(problem, columns, at)

    @cached_property
    def functions(self) -> tuple[Mapped, ...]:
        """For each phase: function (v, c, theta, [s; k]) at any number of places."""
        return tuple(map(Mapped, self.problem.output_functions(tuple(self.columns))))

    @cached_property
    def starts(self) -> tuple[int, ...]:
        """First column of each output."""
        return tuple(at if isinstance(at, int) else at.start for at in self.columns.values())

    def before(self, name: str) -> int:
        """Return how many columns are before those of a name."""
        at = self.columns[name]
        return at if isinstance(at, int) else int(at.start)

    def largest(self, numbers: Array) -> dict[str, float]:
        """Return the largest of each output in numbers (k,) of the first columns, by name."""
        starts = self.starts[: bisect_left(self.starts, len(numbers))]
        return dict(zip(self.columns, np.maximum.reduceat(numbers, starts).tolist(), strict=False))


class Choices:
    """The choices that are made of the outputs of one problem.

    `placed` says whether any output, or where the law is singular, depends on the place by itself.
    """

    def __init__(self, problem: BoundaryValueProblem) -> None:
        self.placed = problem.placed
        self.every = Choice.of(problem, tuple(problem.output_sizes))
        self.places = Choice.of(problem, PLACES)
        self.line = Choice.of(problem, ("r",))
        self.nodes = Choice.of(problem, (*NODES, *problem.conserved, *TOLD))
        self.stages = Choice.of(problem, STAGES)


class Part(NamedTuple):
    """Places in one phase: which of all, unknowns v (k, nv) there, and [s; k] (k, 1 + nk)."""

    rows: Rows
    v: Array
    places: Array


@dataclass(frozen=True, eq=False)
class Places:
    """Places along a solution, phase after phase, with its constants and parameters `numbers`."""

    parts: Sequence[Part]
    numbers: tuple[Array, Array]

    def columns(self, choice: Choice) -> Array:
        """Evaluate the columns (k, width) of a choice."""
        return self.evaluated(choice.functions, choice.width)

    def evaluated(self, functions: Sequence[Mapped], width: int) -> Array:
        """Evaluate functions of the phases, of one output (k, width)."""
        if len(self.parts) == 1:
            _, v, places = self.parts[0]
            return functions[0](v, *self.numbers, places)[0].reshape(-1, width)
        found = np.empty((sum(len(part.v) for part in self.parts), width))
        for function, (rows, v, places) in zip(functions, self.parts, strict=True):
            if len(v):
                found[rows] = function(v, *self.numbers, places)[0].reshape(-1, width)
        return found


class Named(Mapping[str, Array]):
    """Outputs by name at places (k,): (k,) for scalars, (k, 3) for vectors.

    A name is looked for in one choice after another, of which the last has all.
    """

    def __init__(self, places: Places, *choices: Choice) -> None:
        self.places, self._choices = places, choices
        self._found: dict[Choice, Array] = {}
        self._largest: dict[Choice, dict[str, float]] = {}

    def __getitem__(self, name: str) -> Array:
        """Return an output."""
        choice = self._of(name)
        return self.block(choice)[:, choice.columns[name]]

    def __iter__(self) -> Iterator[str]:
        """Return the names of all."""
        return iter(self._choices[-1].columns)

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._choices[-1].columns)

    def __contains__(self, name: object) -> bool:
        """Return whether there is an output of a name."""
        return name in self._choices[-1].columns

    @property
    def choice(self) -> Choice:
        """The first choice."""
        return self._choices[0]

    def block(self, choice: Choice) -> Array:
        """Return the columns (k, width) of a choice."""
        found = self._found.get(choice)
        if found is None:
            found = self._found[choice] = self.places.columns(choice)
        return found

    def largest(self, name: str) -> float:
        """Return the largest number of an output, without its sign."""
        choice = self._of(name)
        if choice not in self._largest:
            self._largest[choice] = choice.largest(np.abs(self.block(choice)).max(axis=0))
        return self._largest[choice][name]

    def _of(self, name: str) -> Choice:
        for choice in self._choices:
            if name in choice.columns:
                return choice
        raise KeyError(name)


class Each(Mapping[str, Array]):
    """What becomes of each of some named arrays, when it is asked for."""

    def __init__(self, values: Mapping[str, Array], make: Callable[[str, Array], Array]) -> None:
        self._values, self._make = values, make

    def __getitem__(self, name: str) -> Array:
        """Return what becomes of one."""
        return self._make(name, self._values[name])

    def __iter__(self) -> Iterator[str]:
        """Return the names of all."""
        return iter(self._values)

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._values)
