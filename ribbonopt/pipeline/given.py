"""The guess that a caller gives, or a scene: a saved solution, or what its numbers say."""

from __future__ import annotations

from ribbonopt.guess import Guess, guess_of, words
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import SolutionGuess
from ribbonopt.solution.solution import Solution


def saved(posed: Posed) -> Solution | None:
    """Return the solution that a scene names as its guess."""
    if not isinstance(posed.scene.guess, SolutionGuess):
        return None
    from ribbonopt.output.results import load_solution  # reading files costs imports

    return load_solution(posed.scene.guess.solution)


def own_guess(posed: Posed, ribbon: Ribbon) -> Guess | None:
    """Return the guess of a scene; None where it leaves that to the automatic start."""
    return saved(posed) or guess_of(posed, ribbon)


def step_of(guess: Guess | None, posed: Posed) -> str:
    """Return the step that a guess is: one that was given, or that of the scene."""
    return "guess: given" if guess else f"guess: {words(posed.scene.guess)}"
