"""Which laws a scene is solved under, and with which numbers: those of one and the same ribbon.

Width, thickness and Poisson's ratio come from the scene's `ribbon`, else from what is given beside
the scene, from its own law, or its natural strains. A law whose numbers nobody says is left out,
with the reason. The scene's own law is always the first, as it stands.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field, fields, replace
from math import isclose

from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.mechanics.laws.catalogue import numbers_of
from ribbonopt.scene import Law, Scene
from ribbonopt.scene.edges import Edge, edge_of
from ribbonopt.scene.faults import suggestion
from ribbonopt.scene.sized import OfWidth, Sized
from ribbonopt.scene.stages import stages_of
from ribbonopt.scene.wording import listed

from .makers import ALL, MAKERS, MODELS, OPTIONS, SIZES, WORDS, Maker

Edges = tuple[Edge | None, Edge | None]


@dataclass(frozen=True)
class Sizes:
    """Width and thickness (units of the scene) and Poisson's ratio of a ribbon; None: not said.

    `edges` says whether the start and the end hold the ribbon's edge straight across, for laws of a
    width, where the scene leaves that open.
    """

    width: float | None = None
    thickness: float | None = None
    poisson_ratio: float | None = None
    edges: Edges = (None, None)

    @property
    def known(self) -> dict[str, float]:
        """Those that are said, by name."""
        named = {name: getattr(self, name) for name in SIZES}
        return {name: value for name, value in named.items() if value is not None}


@dataclass(frozen=True)
class Choice:
    """One law of a comparison.

    Attributes
    ----------
    name : str
        Its type.
    law : Law or None
        None where it is left out.
    reason : str
        Why it is left out, and what to add.
    note : str
        What is to be told of its numbers.
    numbers : Mapping
        Its numbers, those that are the ribbon's too.
    edges : pair
        What ends that leave that open do to a ribbon's edge, for laws of a width.
    """

    name: str
    law: Law | None
    reason: str = ""
    note: str = ""
    numbers: Mapping[str, float] = field(default_factory=dict)
    edges: Edges = (None, None)


def names_of(words: Iterable[str]) -> tuple[str, ...]:
    """Return the types of laws that words stand for, each once.

    Raises
    ------
    SceneError
        If a word is no law.
    """
    found = [name for word in words for name in (MODELS if word == ALL else (word,))]
    unknown = [name for name in found if name not in MAKERS]
    if unknown or not found:
        word = repr(unknown[0]) if unknown else "none"
        near = suggestion(unknown[0], [ALL, *MAKERS]) if unknown else ""
        known = ", ".join((ALL, *MAKERS))
        raise SceneError(f"--laws: found {word}, expected some of {known}{near}")
    return tuple(dict.fromkeys(found))


def sizes_of(scene: Scene, given: Sizes) -> Sizes:
    """Return what is known of a scene's ribbon; `given` is said beside it.

    Raises
    ------
    SceneError
        If the scene says it all itself.
    """
    ribbon = scene.ribbon
    if ribbon is not None:
        for name in given.known:
            option = OPTIONS[name].split()[0]
            raise SceneError(
                f"{option}: the `ribbon` of {scene.name} has {name} = {getattr(ribbon, name):g}; "
                f"change it there, or by --set ribbon.{name}=..."
            )
        return Sizes(ribbon.width, ribbon.thickness, ribbon.poisson_ratio)
    law = {f.name: getattr(scene.law, f.name) for f in fields(scene.law)}
    own = _sized(law).known
    if scene.natural is not None and scene.natural.poisson_ratio is not None:
        own["poisson_ratio"] = scene.natural.poisson_ratio
    found = own | given.known
    return _sized(found)


def _sized(named: Mapping[str, float | None]) -> Sizes:
    width, thickness, ratio = (named.get(name) for name in SIZES)
    return Sizes(width, thickness, ratio)


def choices(scene: Scene, names: Iterable[str], given: Sizes) -> Iterator[Choice]:
    """Yield the laws of a comparison: the scene's own, then those of the names."""
    sizes = sizes_of(scene, given).known
    yield _own(sizes, scene)
    for name in names:
        if name != scene.law.type:
            yield replace(_choice(name, sizes, scene), edges=given.edges)


def _own(sizes: Mapping[str, float], scene: Scene) -> Choice:
    """Return the scene's own law as it stands; where its numbers are not the ribbon's, say that."""
    numbers, note = _numbers(scene.law, scene), ""
    maker = MAKERS.get(scene.law.type)
    if maker is not None and maker.needs and all(need in sizes for need in maker.needs):
        of_ribbon = _choice(scene.law.type, sizes, scene).numbers
        if any(not isclose(numbers[name], value) for name, value in of_ribbon.items()):
            written = ", ".join(f"{name} = {value:.6g}" for name, value in of_ribbon.items())
            note = f"as the scene has it; those of the ribbon would be {written}"
    return Choice(scene.law.type, scene.law, note=note, numbers=numbers)


def _choice(name: str, sizes: Mapping[str, float], scene: Scene) -> Choice:
    maker = MAKERS[name]
    missing = [need for need in maker.needs if need not in sizes]
    note = ""
    if not missing:
        law = maker.make(**{need: sizes[need] for need in maker.needs})
        if maker.asks is not None and scene.ribbon is not None:
            law = maker.asks
        elif moved := [s.moved for s in stages_of(scene) if s.moved in _paths(maker)]:
            reason = f"left out: its stiffnesses are those of one ribbon, and {moved[0]} changes it"
            return Choice(name, None, reason)
    elif maker.otherwise is not None:
        law, note = maker.otherwise, maker.note
    else:
        what = listed([WORDS[need] for need in missing])
        add = " ".join(OPTIONS[need] for need in missing)
        reason = f"left out: nothing says the {what} of the ribbon; add {add}"
        return Choice(name, None, f"{reason}, or a `ribbon` to the scene")
    return Choice(name, law, note=note, numbers=_numbers(law, scene))


def _paths(maker: Maker) -> list[str]:
    return [f"ribbon.{need}" for need in maker.needs]


def _numbers(law: Law, scene: Scene) -> dict[str, float]:
    """Return the numbers of a law by name, those that are the ribbon's too."""
    ribbon = scene.ribbon
    if isinstance(law, Sized) and ribbon is not None:
        law = law.of_sizes(ribbon.width, ribbon.thickness, ribbon.poisson_ratio)
    return numbers_of(law)


def under(scene: Scene, choice: Choice) -> Scene:
    """Return a scene under a law that is not left out; itself under its own."""
    if choice.law is None or choice.law is scene.law:
        return scene
    edges, boundary = edges_of(scene, choice.law, choice.edges), scene.boundary
    start, end = (
        replace(at, edge=edge)
        for at, edge in zip((boundary.start, boundary.end), edges, strict=True)
    )
    boundary = replace(boundary, start=start, end=end)
    return replace(scene, law=choice.law, boundary=boundary, reference=None)


def edges_of(scene: Scene, law: Law, given: Edges) -> Edges:
    """Return what the ends of a scene say of their edges under a law: nothing if it has no width.

    `given` counts where an end leaves it open.
    """
    boundary = scene.boundary
    if not isinstance(law, OfWidth) or boundary.loop is not None:
        return (None, None)
    start, end = (
        edge if edge_of(at) is None else at.edge
        for at, edge in zip((boundary.start, boundary.end), given, strict=True)
    )
    return start, end
