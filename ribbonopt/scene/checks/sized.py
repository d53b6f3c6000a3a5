"""Laws that depend on the sizes of the ribbon: all of these are said, by the law or the ribbon."""

from __future__ import annotations

from collections.abc import Iterator

from ribbonopt.scene.faults import Problem
from ribbonopt.scene.limits import NARROWEST
from ribbonopt.scene.model import Scene
from ribbonopt.scene.sized import OfWidth, Sano, Sized, missing_of
from ribbonopt.scene.units import Units


def check_sized(law: Sized, scene: Scene) -> Iterator[Problem]:
    """Yield the numbers that a law needs and nothing says."""
    if scene.ribbon is not None:
        return
    for name in missing_of(law):
        example = {"poisson_ratio": "0.3", "thickness": "0.001", "B2": "1", "B3": "2"}
        what = "a length" if name in ("width", "thickness", "zeta") else "a number"
        units = " in units of the scene's lengths" if what == "a length" else ""
        if isinstance(law, Sano) and name in ("B2", "B3"):
            units = " in units of Dw"
        message = f"missing; expected {what}{units}, such as {example.get(name, '0.05')}, or a "
        message += "`ribbon` with its width, thickness and Poisson's ratio"
        yield Problem(("law", name), message)


def check_narrow(scene: Scene, units: Units) -> Iterator[Problem]:
    """Yield a width so small that layers of it are lost, of a law that resolves them."""
    if not isinstance(scene.law, OfWidth):
        return
    width, path = scene.law.width, ("law", "width")
    if width is None and scene.ribbon is not None:
        width, path = scene.ribbon.width, ("ribbon", "width")
    if width is not None and 0 < width < NARROWEST * units.length:
        message = f"expected at least {NARROWEST:g} L for law {scene.law.type}: narrower ribbons "
        message += "are Sadowsky's to all digits; write law: sadowsky"
        yield Problem(path, message, f"{width:g}")
