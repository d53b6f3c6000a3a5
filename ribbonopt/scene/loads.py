"""What a scene may say of loads along the ribbon; forces at its ends belong to the boundary."""

from __future__ import annotations

from dataclasses import dataclass

from .ends import LabVector, Triple


@dataclass(frozen=True)
class Loads:
    """Loads per length, all along the ribbon.

    `force` is dead: a force per length (lab frame) that keeps its direction, as own weight does.
    """

    force: Triple | LabVector | None = None
