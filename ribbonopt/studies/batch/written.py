"""What a study file may say, as annotated classes: for the schema that editors read, and docs.

A file is read by `sweep`, `inputs` and `draws`, each key with words of its own; tests hold both
together.
"""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Any, Literal

from ribbonopt.classes import dataclass
from ribbonopt.scene import Scene
from ribbonopt.scene.limits import LARGEST, SECONDS, SEED, VALUES
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.scene.schema.json_schema import json_schema_of

Number = Annotated[float, Bounds(most=int(LARGEST))]
Count = Annotated[int, Bounds(ge=1, le=VALUES)]


def _left_out() -> Any:
    """Return the default of a key that may be left out, but not be empty."""
    return field(default_factory=dict)


@dataclass(frozen=True)
class Spacing:
    """Numbers evenly spaced between two, or between two powers.

    Attributes
    ----------
    from_, to
        First and last number. Example: `0.5`
    count
        How many numbers. Example: `20`
    scale
        Whether differences are equal, or ratios (`log`; both ends above 0). Example: `log`
    """

    from_: float
    to: float
    count: Count
    scale: Literal["linear", "log"] = "linear"


@dataclass(frozen=True)
class Uniform:
    """Numbers drawn evenly between two.

    Attributes
    ----------
    uniform
        Lower and upper bound. Example: `[0, 1]`
    """

    uniform: tuple[Number, Number]


@dataclass(frozen=True)
class LogUniform:
    """Numbers whose logarithms are drawn evenly between those of two.

    Attributes
    ----------
    log_uniform
        Lower and upper bound, above 0. Example: `[0.01, 0.1]`
    """

    log_uniform: tuple[
        Annotated[float, Bounds(gt=0, le=LARGEST)], Annotated[float, Bounds(gt=0, le=LARGEST)]
    ]


@dataclass(frozen=True)
class Normal:
    """Numbers drawn from a normal distribution.

    Attributes
    ----------
    normal
        Mean and standard deviation. Example: `[0, 0.1]`
    """

    normal: tuple[Number, Annotated[float, Bounds(ge=0, le=LARGEST)]]


@dataclass(frozen=True)
class Random:
    """Independent draws, the same for the same seed.

    Attributes
    ----------
    count
        How many ribbons. Example: `100`
    seed
        Seed of the random numbers. Example: `1`
    over
        Keys of the scene, each with its distribution. Example: `{law.delta: {log_uniform: [0.01,
        0.1]}}`
    """

    count: Count
    over: dict[str, Uniform | LogUniform | Normal]
    seed: Annotated[int, Bounds(ge=0, le=SEED)] = 0


Axes = dict[str, tuple[Any, ...] | Spacing]


@dataclass(frozen=True)
class Sweeps:
    """What is swept; kinds that are given together are multiplied, the last one changes fastest.

    Attributes
    ----------
    grid
        Keys of the scene, each with its values; all combinations are solved.
        Example: `{parameters.distance: {from: 0.5, to: 0.9, count: 20}, parameters.turn: [0, 1]}`
    zip
        Keys of the scene, each with as many values; the first ones belong together, and so on.
        Example: `{law.delta: [0.1, 0.2], parameters.turn: [1, 2]}`
    list
        Ribbons one by one, each by the keys of the scene that it sets.
        Example: `[{parameters.turn: 1}, {parameters.turn: 2, law.delta: 0.1}]`
    random
        Keys of the scene, whose values are drawn.
        Example: `{count: 100, seed: 1, over: {parameters.turn: {uniform: [0, 1]}}}`
    csv
        A file with a row for each ribbon and a column for each key of the scene that it sets,
        named by the first row; its path is relative to the folder of the study file.
        Example: `rows.csv`
    """

    grid: Axes = _left_out()
    zip: Axes = _left_out()
    list: tuple[dict[str, Any], ...] = _left_out()
    random: Random = _left_out()
    csv: str = _left_out()


@dataclass(frozen=True)
class StudyFile:
    """A study: one scene or several, what is swept over its keys, and how ribbons are solved.

    Attributes
    ----------
    name
        Name of the study, and of the folder of its results; by default that of the file.
        Example: `arches`
    scene
        A scene file, its path relative to the folder of the study file; or a scene itself; or
        several of them. Example: `clamped_arch.yaml`
    set
        Keys of the scene and their values, for all ribbons. Example: `{tolerance: 1e-6}`
    sweep
        What differs from ribbon to ribbon; without it each scene is solved once.
        Example: `{grid: {law.epsilon: {from: 0.1, to: 1e-4, count: 20, scale: log}}}`
    continue_
        Whether each ribbon is followed along the `continuation` of its scene, and not solved alone.
        Example: `true`
    save
        Which full solutions are kept; rows of numbers always are. Example: `all`
    time_limit
        Seconds that one ribbon may take. Example: `60`
    labels
        What columns are called beside the axes of figures; formulas stand between $.
        Example: `{parameters.turn: turn, energy: $E$}`
    """

    scene: str | Scene | tuple[str | Scene, ...]
    name: str = _left_out()
    set: dict[str, Any] | None = None
    sweep: Sweeps = _left_out()
    continue_: bool = False
    save: Literal["all", "failed", "none"] = "failed"
    time_limit: Annotated[float, Bounds(gt=0, le=SECONDS)] = 300.0
    labels: dict[str, str] = _left_out()


def study_schema() -> dict[str, Any]:
    """Return the JSON schema of study files; scenes in it are told once, under `$defs`."""
    told = json_schema_of(StudyFile)
    scene = json_schema_of(Scene)
    del scene["$schema"]
    del scene["required"]  # what a scene leaves out `set` may say
    told["properties"]["sweep"]["minProperties"] = 1
    return {**_with_references(told), "$defs": {"Scene": scene}}


def _with_references(told: Any) -> Any:
    """Return a schema in which each scene is a reference to one that is told elsewhere."""
    if isinstance(told, list):
        return [_with_references(item) for item in told]
    if not isinstance(told, dict):
        return told
    if told.get("title") == "Scene" and "properties" in told:
        return {"$ref": "#/$defs/Scene"}
    return {key: _with_references(value) for key, value in told.items()}
