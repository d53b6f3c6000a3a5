"""What a search for all equilibria of a scene tells of one of them."""

from __future__ import annotations

from ribbonopt.classes import dataclass


@dataclass(frozen=True)
class Sought:
    """Where a solution stands among all that a search has found.

    Attributes
    ----------
    image_of : int
        Number, from 1, of the equilibrium that it is, or that a symmetry carries into it.
    symmetry : str
        What leaves it as it is, in words; "" for nothing.
    found_by : str
        What led to it first.
    told : str
        Of the first: what was searched, and how far; "" of the others.
    """

    image_of: int
    symmetry: str
    found_by: str
    told: str = ""
