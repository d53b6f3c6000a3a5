"""`piece: auto` of a loop: the smallest piece whose images under symmetry are all the rest.

Of a band of k half twists a 2k-th, else a half, else the whole. What a scene says of all of the
loop must hold for its images as well; where that is in doubt a larger piece is taken. The interval
of such a scene is the whole loop, that of what is returned the piece.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import chain

from ribbonopt.mechanics.laws.asymmetry import changed_by_flip, changed_by_sliding, numbers_alone
from ribbonopt.mechanics.laws.catalogue import always_the_same
from ribbonopt.scene import LoadGuess, Loads, Loop, MoebiusGuess, Scene, StrainGuess
from ribbonopt.scene.continuation import ContinuationStage
from ribbonopt.scene.units import in_special_units

NO_LOADS = Loads()


def settled(scene: Scene) -> Scene:
    """Return a scene as it is solved: `divided` where it says so."""
    return divided(scene)[0] if is_divided(scene) else scene


def is_divided(scene: Scene) -> bool:
    """Whether a scene leaves it to its symmetry what of it is solved."""
    loop = scene.boundary.loop
    return scene.symmetric is not False or (loop is not None and loop.piece == "auto")


def divided(scene: Scene) -> tuple[Scene, str]:
    """Return the part of a scene that is solved, in its own units, and why it is no smaller one."""
    special = in_special_units(scene)
    if scene.symmetric is not False:
        from .boundary import conditions_of
        from .twofold import halved  # few strips are

        return halved(scene, conditions_of(special)), ""
    piece, why = smallest(special, scene)
    assert piece.boundary.loop is not None
    return _of_piece(scene, piece.boundary.loop), why


def smallest(scene: Scene, given: Scene) -> tuple[Scene, str]:
    """Return the scene of the smallest piece of its loop, and in words why it is no smaller one.

    "" where there is none smaller. `given` is the same in its own units.
    """
    recorded = ["what is recorded is of all of it"] if given.record else []
    why = next(chain(recorded, _continued(given), _for_the_whole(scene)), "")
    if not why:
        half = next(_for_a_half(scene), "")
        for loop in _pieces(scene, half):
            piece = _of_piece(scene, loop)
            axis = changed_by_flip(piece, numbers_alone(piece))
            if not axis:
                return piece, half if loop.piece == "half" else ""
            why = half = f"a flip about {axis} changes the natural strains"
    return _of_piece(scene, _loop(scene, "whole")), why


def _pieces(scene: Scene, half: str) -> Iterator[Loop]:
    """Yield the pieces that there are, the smallest first."""
    loop = _loop(scene, "fundamental")
    if abs(loop.half_twists) > 1 and not half:
        yield loop
    yield _loop(scene, "half")


def _for_the_whole(scene: Scene) -> Iterator[str]:
    """Yield why the whole loop must be solved."""
    boundary, loop = scene.boundary, scene.boundary.loop
    assert loop is not None
    if scene.gravity is not None or scene.supports:
        yield "gravity and supports are others in images" if scene.gravity else "it has supports"
    in_plane = scene.states == "planar" and loop.half_twists == 0
    if (replace(scene.loads, pressure=None) if in_plane else scene.loads) != NO_LOADS:
        yield "its loads are others in images"
    if scene.membrane is not None:
        yield "its law has a membrane"
    if boundary.also:
        yield "boundary.also speaks of all of it"
    if isinstance(scene.switching, tuple):
        yield "switching names places in all of it"
    guess = scene.guess
    banded = isinstance(guess, MoebiusGuess) and guess.moebius.piece is None
    if not (isinstance(guess, str | LoadGuess | StrainGuess) or banded):
        yield "its guess is one of all of it"
    if changed_by_sliding(scene, odd=loop.half_twists % 2 == 1):
        yield "it is not the same all along"


def _continued(scene: Scene) -> Iterator[str]:
    """Yield what of its continuation is of the whole loop."""
    found = scene.continuation
    stages = (found,) if isinstance(found, ContinuationStage) else found or ()
    if any(stage.stability for stage in stages):
        yield "stability is judged along its continuation (stability: false leaves that out)"
    if any(stage.stop for stage in stages):
        yield "its continuation stops by numbers of all of it"
    if stages and not (scene.natural is None and always_the_same(scene.law)):
        yield "its continuation may change natural strains"


def _for_a_half(scene: Scene) -> Iterator[str]:
    """Yield why it must be a half at least, which starts where the loop does."""
    start = scene.boundary.start
    if start.position is not None or start.directors is not None:
        yield "boundary.start says where it is"
    if not isinstance(scene.guess, str | MoebiusGuess):
        yield "its guess says where it is"
    if scene.reference is not None:
        yield "reference says where it is"


def _loop(scene: Scene, piece: str) -> Loop:
    assert scene.boundary.loop is not None
    return replace(scene.boundary.loop, piece=piece)  # type: ignore[arg-type]


def _of_piece(scene: Scene, loop: Loop) -> Scene:
    start, end = scene.interval
    interval = (start, start + (end - start) / loop.pieces)
    return replace(scene, boundary=replace(scene.boundary, loop=loop), interval=interval)
