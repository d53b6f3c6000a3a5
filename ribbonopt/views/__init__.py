"""Pictures of a solution: its strains, its path in the (u2, u3) plane, the ribbon in space.

Importing this room loads none of its modules, and matplotlib is imported when a figure is drawn.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .files import Pictures, save_figures
    from .plane import plot_plane
    from .ribbon import plot_ribbon
    from .strains import plot_strains

__all__ = ["Pictures", "plot_plane", "plot_ribbon", "plot_strains", "save_figures"]

_HOMES = {
    "Pictures": "files",
    "plot_plane": "plane",
    "plot_ribbon": "ribbon",
    "plot_strains": "strains",
    "save_figures": "files",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ribbonopt.views' has no attribute {name!r}")
    return getattr(import_module(f"ribbonopt.views.{_HOMES[name]}"), name)
