"""The width along a ribbon as numbers, for what is drawn and doubted of it."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.scene import Scene
from ribbonopt.scene.sized import Sized


def own_width(scene: Scene) -> float | None:
    """Return the width of a scene's ribbon, that of `ribbon` or of its law; None if none is said.

    In the units of the scene.
    """
    if scene.ribbon is not None:
        return scene.ribbon.width
    width: float | None = (
        getattr(scene.law, "width", None) if isinstance(scene.law, Sized) else None
    )
    return width


def widths(scene: Scene, s: Array) -> Array:
    """Return the widths (k,) of a ribbon at arclengths (k,), in units of its own width.

    Scene and arclengths are in the same units, whichever.
    """
    if scene.width is None:
        return np.ones(len(s))
    from .along import Field  # few scenes have a width of their own

    field = Field("width", scene.width)
    parameters = {f"parameters.{name}": value for name, value in scene.parameters.items()}
    return field.sampled(s, parameters | field.numbers())
