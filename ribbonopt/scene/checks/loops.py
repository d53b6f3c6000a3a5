"""What contradicts a closed loop: conditions and guesses beside it, and pieces it does not have."""

from __future__ import annotations

from collections.abc import Iterator

from ribbonopt.scene.ends import Boundary, End, Loop
from ribbonopt.scene.faults import KeyPath, Problem
from ribbonopt.scene.guesses import Band, Guess, MoebiusGuess
from ribbonopt.scene.wording import given, listed, written

from .supports import check_whole_position

_PLACE = ("position", "directors")


def check_loop(loop: Loop, boundary: Boundary, guess: Guess) -> Iterator[Problem]:
    """Yield what is wrong with a loop, and with what else is said of its ends and its shape."""
    yield from check_piece(loop, ("boundary", "loop"))
    if boundary.end != End():
        keys = listed(f"`{key}`" for key in given(boundary.end))
        message = f"{keys} of the end follow from the loop; remove boundary.end, "
        example = f'"loop: {written(loop)}" says it all'
        yield Problem(("boundary", "end"), message + example)
    yield from _start(loop, boundary.start, ("boundary", "start"))
    yield from _guess(loop, guess)


def check_piece(loop: Loop | Band, path: KeyPath) -> Iterator[Problem]:
    """Yield the piece that a band of no half twist, or of one, does not have."""
    if loop.piece == "fundamental" and abs(loop.half_twists) < 2:
        found = str(loop.half_twists)
        message = "a band of fewer than two half twists has no piece smaller than a half; write "
        yield Problem((*path, "half_twists"), f'{message}for example "piece: half"', found)


def _start(loop: Loop, start: End, path: KeyPath) -> Iterator[Problem]:
    for key in given(start):
        if loop.piece == "fundamental":
            message = "a fundamental piece lies where the symmetry of its loop puts it; remove it"
            example = ', or write for example "piece: half"' if key in _PLACE else ""
        elif key not in _PLACE:
            message = f"follows from the loop, a {loop.piece} one takes position and directors only"
            example = '; remove it, as in "start: {position: [0, 0, 0], directors: identity}"'
        else:
            continue
        yield Problem((*path, key), message + example)
    if loop.piece != "fundamental":
        yield from check_whole_position("a loop needs", start.position, path)


def _guess(loop: Loop, guess: Guess) -> Iterator[Problem]:
    half_twists = loop.half_twists
    if isinstance(guess, MoebiusGuess) and guess.moebius.half_twists != half_twists:
        path: KeyPath = ("guess", "moebius", "half_twists")
        found = str(guess.moebius.half_twists)
        example = f"half_twists: {half_twists}"
    elif guess == "circle" and half_twists != 0:
        path, found = ("guess",), "'circle'"
        example = f"guess: {{moebius: {written(loop)}}}"
    else:
        return
    message = f"contradicts boundary.loop, half_twists: {half_twists}; one of them must go: "
    yield Problem(path, f'{message}leave the guess out, or write for example "{example}"', found)
