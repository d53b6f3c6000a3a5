"""The smooth laws that a start goes through: convex energies, from blunt to as sharp as wanted.

For ribbons the variational law, delta decreasing from a rod's; for rods much softer or stiffer in
twist than in bending, other rods, from a ratio of stiffnesses that is easy. Sharpness is a number
from 1, easy, towards 0: delta, or the smallest stiffness over the next: a third that is larger
still, infinite for Kirchhoff's rod, does no harm.
"""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.scene import Kirchhoff, Law, Rod, Variational
from ribbonopt.scene.laws import Stiff

from .catalogue import is_linear

ROD = 1.0  # delta at which the law is linear
UNEVEN = 0.3  # ratio of a rod's stiffnesses below which it is approached from a more even one
EVEN = 0.8  # the ratio to begin with there: less than 1, so that it is known which is the larger
USUAL = 20.0  # twisting moments, Dw = L = 1, that shapes of a start have


def first_law(law: Law, delta: float) -> Law:
    """Return the smooth law to begin with: the law itself where its energy is smooth.

    Of rods that are too uneven a more even one. Otherwise the variational law, at `delta` or, where
    that is the law, at its own if larger.
    """
    if isinstance(law, Stiff):
        return sharpened(law, EVEN) if _ratio(law) < UNEVEN else law
    if is_linear(law, up_to=USUAL):
        return law
    return Variational(delta=max(delta, sharpness(law, 0.0)))


def first_laws(law: Law, delta: float) -> tuple[Law, ...]:
    """Return the smooth laws to begin with, each where those before it lead nowhere.

    One that may leap at moments beyond the usual ones is not the only one.
    """
    first = first_law(law, delta)
    return (first,) if is_linear(first) or in_family(first) else (first, Variational(delta=delta))


def sharpness(law: Law, other: float) -> float:
    """Return delta of a smooth law, the ratio of an uneven rod, `other` of any other law."""
    if isinstance(law, Variational):
        return law.delta
    return _ratio(law) if isinstance(law, Stiff) and in_family(law) else other


def in_family(law: Law) -> bool:
    """Whether a law is one of a family of smooth laws, so that it has a sharpness to follow."""
    return isinstance(law, Variational) or (
        isinstance(law, Stiff) and _ratio(law) <= EVEN * (1 + 1e-9)
    )


def sharpened(law: Law, to: float) -> Law:
    """Return a law of a smooth family at another sharpness; any other law as it is."""
    if isinstance(law, Variational):
        return Variational(delta=to)
    if not isinstance(law, Stiff) or not in_family(law):
        return law
    ratio = min(to, EVEN)
    if isinstance(law, Rod):
        softest, next_, _ = _by_size(law)
        B1, B2, B3 = (ratio * law.B[next_] if i == softest else B for i, B in enumerate(law.B))
        return replace(law, B=(B1, B2, B3))
    return replace(law, B3=law.B2 * (ratio if law.B3 < law.B2 else 1 / ratio))


def named(law: Law) -> str:
    """Return the sharpness of a law in words, for a report; nothing of laws that have none."""
    if isinstance(law, Variational):
        return f"delta = {law.delta:.3g}"
    if isinstance(law, Rod):
        softest, next_, _ = _by_size(law)
        return f"B{softest + 1} / B{next_ + 1} = {_ratio(law):.3g}"
    return f"B3 / B2 = {law.B3 / law.B2:.3g}" if isinstance(law, Kirchhoff) else ""


def _ratio(law: Stiff) -> float:
    smallest, following, *_ = sorted(law.stiffnesses.values())
    return smallest / following


def _by_size(law: Rod) -> list[int]:
    """Return which stiffness is the smallest, the next, and the largest."""
    return sorted(range(3), key=lambda i: law.B[i])
