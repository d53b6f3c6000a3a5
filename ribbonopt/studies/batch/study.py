"""What a study is: scenes, the inputs of their ribbons, and how they are solved; as plain data."""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Literal

from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.scene import Scene
from ribbonopt.scene.limits import RIBBONS
from ribbonopt.scene.quantities import ANSWERS
from ribbonopt.scene.yamlio import loads_scene

from .cells import as_yaml
from .inputs import NOTHING, InputRows, Inputs
from .special import BRANCH_COLUMNS

#: of every row; a ribbon that failed has some of them only
COLUMNS = (
    *("number", "scene", "status", "verified", *ANSWERS, "error"),
    *("start", "iterations", "path", "note", "message", "seconds"),
)
EQUILIBRIA = "equilibria"  # a column where scenes ask for several
NOT_CONTINUED = (
    "continuation: missing, the study continues every ribbon (`continue: true`); add for example "
    "'continuation: {parameter: law.epsilon, to: 1e-4, scale: log}'"
)
TAKEN = "every row has that already; choose another name"


@dataclass(frozen=True)
class Source:
    """A scene as text, and where it was read."""

    name: str
    text: str


@dataclass(frozen=True)
class Sweep:
    """A source with the inputs of its ribbons, and what holds for all of them.

    `where` says where the study names each key; `followed` whether each ribbon is continued as its
    scene says, and not solved alone.
    """

    source: Source
    common: Inputs = field(default_factory=dict)
    inputs: InputRows = NOTHING
    where: Mapping[str, str] = field(default_factory=dict)
    followed: bool = False

    def check(self) -> str:
        """Read the first ribbon; return what is wrong with the scene by itself, "" if nothing.

        Raises
        ------
        SceneError
            If it is one of the study's keys that is unknown, or its first value wrong.
        """
        first = self.common | self.inputs[0]
        fault = self._fault(first)
        if not fault or self._fault({}):
            return fault
        culprits = [k for k in first if not self._fault({o: v for o, v in first.items() if o != k})]
        where = ", ".join(self.where.get(key, key) for key in culprits[:1] or first)
        raise SceneError(f"{where}: {fault}")

    @property
    def recorded(self) -> tuple[str, ...]:
        """Names of what rows hold for this scene alone; none of a bad scene."""
        if self.followed:
            return BRANCH_COLUMNS
        try:
            scene = self._scene(self.common | self.inputs[0])
        except SceneError:
            return ()
        return (
            *scene.record,
            *((EQUILIBRIA,) if scene.starts > 1 or scene.equilibria is not None else ()),
        )

    @property
    def labels(self) -> dict[str, str]:
        """What the scene calls columns beside axes; nothing of a bad scene."""
        try:
            return self._scene({}).labels
        except SceneError:
            return {}

    def _fault(self, inputs: Inputs) -> str:
        try:
            scene = self._scene(inputs)
        except SceneError as error:
            return str(error)
        if self.followed:  # what is recorded stands in a table of its own
            return "" if scene.continuation else f"{self.source.name}: {NOT_CONTINUED}"
        taken = sorted({*scene.record} & {*COLUMNS, EQUILIBRIA, *self.inputs.keys})
        if taken:
            return f"{self.source.name}: record.{taken[0]}: {TAKEN}"
        return ""

    def _scene(self, inputs: Inputs) -> Scene:
        return loads_scene(self.source.text, self.source.name, assignments(inputs))


@dataclass(frozen=True)
class StudyRibbon:
    """One ribbon of a study: its number, its scene and its inputs, and whether it is continued.

    `place` is the folder of what is kept of it, where that is not `solutions/NUMBER`; `task` what
    is done instead of solving it (`studies.maps.tasks`), whose inputs are no keys of its scene.
    """

    number: int
    source: Source
    common: Inputs
    inputs: Inputs
    followed: bool = False
    place: str = ""
    task: str = ""

    @property
    def overrides(self) -> list[str]:
        """Overrides of the scene, as `load_scene` takes them."""
        return [] if self.task else assignments(self.common | self.inputs)


@dataclass(frozen=True)
class Study:
    """All ribbons of a batch, in order.

    Attributes
    ----------
    name : str
        Name of the study.
    sweeps : tuple of Sweep
        Scenes and their inputs.
    save : str
        Which full solutions are kept: all, failed or none.
    time_limit : float
        Seconds that a ribbon may take.
    labels : mapping
        What columns are called beside the axes of figures.
    """

    name: str
    sweeps: tuple[Sweep, ...]
    save: Literal["all", "failed", "none"] = "failed"
    time_limit: float = 300.0
    labels: Mapping[str, str] = field(default_factory=dict)

    @property
    def called(self) -> dict[str, str]:
        """What columns are called beside axes: as the study says, else as its first scene does."""
        scenes = self.sweeps[0].labels if self.sweeps else {}
        return {**scenes, **self.labels}

    @property
    def count(self) -> int:
        """Number of ribbons."""
        return sum(sweep.inputs.size for sweep in self.sweeps)

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of all inputs, in order."""
        return tuple(dict.fromkeys(key for sweep in self.sweeps for key in sweep.inputs.keys))

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of all columns that rows may have."""
        recorded = (name for sweep in self.sweeps for name in sweep.recorded)
        return tuple(dict.fromkeys((*self.keys, *COLUMNS, *recorded)))

    @property
    def ribbons(self) -> Iterator[StudyRibbon]:
        """The ribbons, numbered from 1."""
        self._refuse_too_many()
        numbers = itertools.count(1)
        for sweep in self.sweeps:
            for inputs in sweep.inputs:
                number, followed = next(numbers), sweep.followed
                yield StudyRibbon(number, sweep.source, sweep.common, inputs, followed)

    def check(self) -> None:
        """Refuse a study of too many ribbons, or none of whose ribbons can be solved.

        Raises
        ------
        SceneError
            If a key of the study does not fit its scene, or no scene is sound. A bad scene among
            good ones only spoils its own rows.
        """
        self._refuse_too_many()
        faults = [sweep.check() for sweep in self.sweeps]
        if all(faults):
            raise SceneError(faults[0])

    def _refuse_too_many(self) -> None:
        if self.count > RIBBONS:
            several = "make several studies of them"
            raise SceneError(f"{self.name}: more than {RIBBONS:,} ribbons; {several}")

    @property
    def digest(self) -> str:
        """What tells this study from others: everything that decides its rows."""
        parts = [
            [sweep.source.text, sweep.common, list(sweep.inputs), *[True] * sweep.followed]
            for sweep in self.sweeps
        ]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def assignments(inputs: Inputs) -> list[str]:
    """Return inputs as overrides of a scene."""
    return [f"{key}={as_yaml(value)}" for key, value in inputs.items()]
