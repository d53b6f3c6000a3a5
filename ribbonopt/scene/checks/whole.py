"""What is wrong with a scene as a whole and needs no mechanics to see.

Each check looks at one matter and returns all problems it finds; none depends on another.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from itertools import pairwise
from typing import Any, get_origin

from ribbonopt.classes import dataclass
from ribbonopt.scene.along import is_along, numbers_along
from ribbonopt.scene.ends import Boundary
from ribbonopt.scene.equilibria import Equilibria
from ribbonopt.scene.faults import KeyPath, Problem, shown
from ribbonopt.scene.guesses import Guess, MoebiusGuess
from ribbonopt.scene.loads import Loads
from ribbonopt.scene.model import RibbonSizes, Scene
from ribbonopt.scene.schema.annotations import branches, hints, inside
from ribbonopt.scene.sized import OfWidth, Sized
from ribbonopt.scene.stations import InteriorSupport
from ribbonopt.scene.wording import written
from ribbonopt.text import name_fault

from .frames import check_frame
from .loops import check_loop, check_piece
from .magnitudes import as_written, in_units
from .supports import check_supports


@dataclass(frozen=True)
class Sound:
    """A scene without a fault, and its formulas by path: what another one may be like.

    One that differs from it in some numbers only has the same formulas, and where it holds the very
    same part, what was found of that holds as well.
    """

    scene: Scene
    formulas: Mapping[KeyPath, str]

    @classmethod
    def of(cls, scene: Scene) -> Sound:
        """Remember a scene that was checked."""
        return cls(scene, formulas_of(scene))


def check(scene: Scene, like: Sound | None = None) -> list[Problem]:
    """Return the problems of a scene whose single values are valid.

    `like` is a sound scene that differs in numbers only: what both share is not looked at again.
    """
    boundary, before = scene.boundary, None if like is None else like.scene
    if problems := list(as_written(scene, like=before)):
        return problems  # what follows computes with these numbers
    problems = [*_name(scene.name), *_interval(scene.interval)]
    formulas = formulas_of(scene) if like is None else like.formulas
    values: dict[KeyPath, float] = {}
    if formulas or boundary.also or scene.parameters:
        # Imported late: a scene in plain numbers starts without the grammar of formulas.
        from .formulas import check_equations, check_parameters, values_of

        values, found = values_of(formulas, scene.parameters)
        problems += [*check_parameters(scene.parameters), *found]
        if like is None:
            problems += check_equations(boundary.also, scene.parameters)
    if (along := dict(numbers_along(scene))) and not problems:
        # Imported late, as above.
        from .along import check_along, largest

        samples, found = check_along(along, scene.interval, scene.parameters)
        problems += found
        values |= largest(samples)
        if ("width",) in samples:
            from .width import check_width

            problems += check_width(samples["width",])
    if before is not None and _worth(scene) != _worth(before):
        before = None  # what both share is written in the same way, but may be worth something else
    if before is None or (boundary, scene.guess) != (before.boundary, before.guess):
        problems += _ends(scene, values)
    if scene.planar:
        from ribbonopt.scene.planes import check_plane  # few scenes are held in a plane

        problems += check_plane(scene)
    if isinstance(scene.law, Sized):
        from .sized import check_sized  # laws that depend on the sizes of the ribbon

        problems += check_sized(scene.law, scene)
    if isinstance(scene.law, OfWidth) or boundary.start.edge or boundary.end.edge:
        from .edges import check_edges  # as above

        problems += check_edges(scene)
    if scene.natural is not None:
        from .natural import check_natural  # few scenes have natural strains

        problems += check_natural(scene)
    if scene.membrane is not None:
        from .membrane import check_membrane  # as above

        problems += check_membrane(scene, scene.membrane)
    if scene.inertia is not None:
        from .inertia import check_inertia  # as above

        problems += check_inertia(scene, scene.inertia)
    if scene.loads.points or scene.supports:
        from .stations import check_stations  # few scenes have any

        problems += check_stations(scene, values)
    if isinstance(scene.switching, tuple):
        problems += _switching(scene.switching, scene.interval)
    if scene.ribbon is not None:
        problems += [*_sizes(scene.ribbon), *_fits(scene, scene.ribbon)]
    if scene.gravity is not None:
        from .gravity import check_gravity  # few scenes have any

        problems += check_gravity(scene, values)
    if not problems:
        problems += in_units(scene, values, before)
    if scene.record or scene.continuation is not None:
        # Imported late: few scenes are continued.
        from .continuation import check_continuation

        problems += check_continuation(scene, None if problems else check)
    if scene.map is not None:
        from .maps import check_map  # few scenes are mapped

        problems += check_map(scene, scene.map, None if problems else check)
    if isinstance(scene.equilibria, Equilibria):
        from .equilibria import check_equilibria  # few scenes ask for all of them

        problems += check_equilibria(scene, scene.equilibria, None if problems else check)
    return problems


def formulas_of(scene: Scene) -> dict[KeyPath, str]:
    """Return the formulas of numbers in a scene, by path; not those along the ribbon."""
    found = dict(_formulas(scene.boundary, Boundary, ("boundary",)))
    found |= _formulas(scene.loads, Loads, ("loads",))
    found |= _formulas(scene.supports, tuple[InteriorSupport, ...], ("supports",))
    found |= _formulas(scene.guess, Guess, ("guess",))
    found |= _formulas(scene.gravity, hints(Scene)["gravity"], ("gravity",))
    return found


def _worth(scene: Scene) -> tuple[object, ...]:
    """Return what decides the values of formulas, and of numbers along the ribbon."""
    return scene.parameters, scene.interval


def _ends(scene: Scene, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    boundary = scene.boundary
    for name in ("start", "end"):
        yield from check_frame(getattr(boundary, name), ("boundary", name), values)
    if isinstance(scene.guess, MoebiusGuess):
        yield from check_piece(scene.guess.moebius, ("guess", "moebius"))
    if boundary.loop is not None:
        yield from check_loop(boundary.loop, boundary, scene.guess)
    else:
        yield from check_supports(boundary, values)


def _name(name: str) -> Iterator[Problem]:
    if fault := name_fault(name):
        yield Problem(("name",), fault, shown(name))


def _interval(interval: tuple[float, float]) -> Iterator[Problem]:
    start, end = interval
    if not start < end:
        message = "must go from a smaller to a larger arclength"
        yield Problem(("interval",), message, f"[{start:g}, {end:g}]")


def _switching(switching: tuple[float, ...], interval: tuple[float, float]) -> Iterator[Problem]:
    ends = (interval[0], *switching, interval[1])
    if not switching or any(b <= a for a, b in pairwise(ends)):
        message = (
            "expected arclengths inside the interval, increasing, such as [{:g}]; or auto, off"
        )
        middle = (interval[0] + interval[1]) / 2
        found = ", ".join(f"{s:g}" for s in switching)
        yield Problem(("switching",), message.format(middle), f"[{found}]")


def _formulas(value: Any, annotation: Any, path: KeyPath) -> Iterator[tuple[KeyPath, str]]:
    """Yield the formulas in a value: texts that stand where the annotation has numbers as well.

    Not those along the ribbon, which have no one value.
    """
    if is_along(annotation):
        return
    if isinstance(value, str):
        if str in branches(annotation).values():
            yield path, value
    elif is_dataclass(value):
        cls: type = type(value)
        for name, inner in hints(cls).items():
            part = getattr(value, name)
            if not (part is None or isinstance(part, float)):  # as most are
                yield from _formulas(part, inner, (*path, name))
    elif isinstance(value, tuple):
        options = branches(annotation).values()
        items = next((some for some in options if get_origin(some) is tuple), annotation)
        for index, item in enumerate(value):
            yield from _formulas(item, inside(items, index), (*path, index))


def _sizes(ribbon: RibbonSizes) -> Iterator[Problem]:
    for small, large in (("width", "length"), ("thickness", "width")):
        size, limit = getattr(ribbon, small), getattr(ribbon, large)
        if not size < limit:
            message = f"expected less than ribbon.{large}, {limit:g}; sizes are in metres, moduli "
            example = f'in pascals; for 1 mm write "{small}: 0.001"'
            yield Problem(("ribbon", small), message + example, f"{size:g}")


def _fits(scene: Scene, ribbon: RibbonSizes) -> Iterator[Problem]:
    start, end = scene.interval
    if end - start > ribbon.length * (1 + 1e-9):
        fitting = written(ribbon.interval(scene.boundary.loop, start))
        message = f"is longer than the ribbon, ribbon.length: {ribbon.length:.12g}; write for "
        example = f'example "interval: {fitting}"'
        yield Problem(("interval",), message + example, written(scene.interval))
