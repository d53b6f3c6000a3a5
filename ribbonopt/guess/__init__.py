"""Guesses: force, moment and shape along the ribbon before anything is solved.

A guess gives `RodFields` at fractions of the length; `initial_unknowns` turns them into the
unknowns of a discretised problem. A `Solution` is itself a guess.
"""

from .loads import FollowerLoads, IntegratedLoads
from .named import ShapeGuess, guess_of, words
from .unknowns import Guess, initial_unknowns
from .winding import turning_of

__all__ = [
    "FollowerLoads",
    "Guess",
    "IntegratedLoads",
    "ShapeGuess",
    "guess_of",
    "initial_unknowns",
    "turning_of",
    "words",
]
