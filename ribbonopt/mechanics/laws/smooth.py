"""The smooth laws that a start goes through: convex energies, from blunt to as sharp as wanted."""

from __future__ import annotations

from ribbonopt.scene import Law, Variational

from .catalogue import capabilities

ROD = 1.0  # delta at which the law is linear


def first_law(law: Law, delta: float) -> Law:
    """Return the smooth law to begin with: the law itself where its energy is smooth at m = 0.

    Otherwise the variational law, at `delta` or, where that is the law, at its own if larger.
    """
    found = capabilities(law)
    if found.linear_at_zero and found.variational:
        return law
    return Variational(delta=max(delta, sharpness(law, 0.0)))


def sharpness(law: Law, other: float) -> float:
    """Return delta of a law of the smooth family, `other` of any other law."""
    return law.delta if isinstance(law, Variational) else other


def in_family(law: Law) -> bool:
    """Whether a law is of the smooth family, so that it has a delta to follow."""
    return isinstance(law, Variational)


def sharpened(law: Law, delta: float) -> Law:
    """Return a law of the smooth family at another delta; any other law as it is."""
    return Variational(delta=delta) if in_family(law) else law
