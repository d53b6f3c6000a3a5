"""What the options of `plot` ask for: a style, ribbons in a diagram, a moving picture."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError, SceneError
from ribbonopt.reading import MEGA, Kind, read_text
from ribbonopt.scene.faults import InvalidSceneError, quotable, report
from ribbonopt.scene.schema.annotations import written_keys
from ribbonopt.scene.schema.validation import validate
from ribbonopt.scene.yamlio import read_yaml
from ribbonopt.views.camera import camera_said
from ribbonopt.views.paper_style import Style, settings_of

from .values import count, words

if TYPE_CHECKING:
    from ribbonopt.views.animation import Kind as Moving

STYLE = Kind("a style file", most=MEGA, error=SceneError, piped=True)
#: options that are numbers, texts, and lists
NUMBERS = ("width", "height", "dpi", "font_size", "line_scale", "half_width")
TEXTS = ("font", "camera", "color")
INSETS, LARGEST = 12, 10**9  # ribbons in a diagram; the largest number of a point


@dataclass(frozen=True)
class Wanted:
    """What is to be drawn besides the usual, and how.

    Attributes
    ----------
    style : Style
        Of all figures.
    inset : tuple of int
        Points of a branch whose ribbons stand in its diagram.
    moving : str
        The kind of a moving picture along a branch, "" for none.
    told : tuple of str
        Names of the options that were given.
    """

    style: Style
    inset: tuple[int, ...] = ()
    moving: Moving | None = None
    told: tuple[str, ...] = ()

    def refuse(self, what: str, *names: str) -> None:
        """Raise a SceneError for options that make no sense of something."""
        for name in names:
            if name in self.told:
                raise SceneError(f"--{name.replace('_', '-')}: {what}")

    def refuse_field(self) -> None:
        """Raise a SceneError where no surface has the field that is to colour it."""
        from ribbonopt.views.tint import check_field

        try:
            check_field(self.style.color)
        except ModelError as error:
            raise SceneError(f"--{error}") from None


def wanted(options: argparse.Namespace) -> Wanted:
    """Read the options; SceneError for what is none that they may have."""
    given: dict[str, Any] = {name: _number(getattr(options, name)) for name in NUMBERS}
    given |= {name: getattr(options, name) for name in TEXTS}
    given["format"] = words(options.format)
    given |= {"letters": options.letters or None, "titles": False if options.no_titles else None}
    given = {name: value for name, value in given.items() if value is not None}
    data = _file(options.style) if options.style else {}
    try:
        style = validate(Style, data | given)
    except InvalidSceneError as error:
        raise SceneError(_faults(error)) from None
    try:
        settings_of(style)
        if style.camera:
            camera_said(style.camera)
    except ModelError as error:
        raise SceneError(f"--{str(error).removeprefix('style: ')}") from None
    inset, moving = _insets(options.inset), options.animate
    told = [*given, *["inset"] * bool(inset), *["animate"] * bool(moving)]
    if moving:
        from ribbonopt.views.animation import check_animation

        check_animation(moving)
    return Wanted(style, inset, moving, tuple(told))


def _number(text: str | None) -> float | str | None:
    """Return a number; a text that is none stays as it is, to be refused where limits are known."""
    if text is None:
        return None
    try:
        return float(text)
    except ValueError:
        return text


def _faults(error: InvalidSceneError) -> str:
    """Return what is wrong with options, each by its name."""
    told = [
        f"--{str(p.path[0]).replace('_', '-')}: {quotable(str(p), 400)}" for p in error.problems
    ]
    return "\n  ".join(told)


def _file(path: str) -> dict[str, Any]:
    """Read a style file: YAML whose keys are those of `Style`."""
    found = read_yaml(read_text(path, STYLE), path, written_keys(Style))
    data = found.data
    if not isinstance(data, dict):
        raise SceneError(f"{path}: expected keys of a style, such as width, format, font")
    try:
        validate(Style, data)
    except InvalidSceneError as error:
        raise SceneError(report(path, error.problems, found.places)) from None
    return {str(key): value for key, value in data.items()}


def _insets(text: str | None) -> tuple[int, ...]:
    """Read numbers of points, each once."""
    if text is None:
        return ()
    parts = dict.fromkeys(part.strip() for part in text.split(","))
    numbers = [count("--inset", part, LARGEST, least=0) for part in parts]
    if len(numbers) > INSETS:
        raise SceneError(f"--inset: found {len(numbers)} points, expected at most {INSETS}")
    return tuple(numbers)


def refuse_points(inset: tuple[int, ...], numbers: list[int]) -> None:
    """Refuse points that a branch has not; SceneError."""
    for number in inset:
        if not numbers:
            raise SceneError(f"--inset: found {number}, but the branch has no points")
        if number not in numbers:
            last = max(numbers)
            raise SceneError(f"--inset: found {number}, expected points of the branch, 0 to {last}")


def column_named(color: str, columns: list[str]) -> str:
    """Return the column of a batch that a word means; SceneError if no row has it."""
    from ribbonopt.studies.columns import column_of

    try:
        return color and column_of(color, columns)
    except SceneError as error:
        raise SceneError(f"--color: {error}") from None
