"""Pictures: strains, their path in the (u2, u3) plane, ribbons in space, branches, batches, maps.

Importing this room loads none of its modules, and matplotlib is imported when a figure is drawn.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .animation import save_animation
    from .branch import plot_branch
    from .files import Pictures, plot_solution, save_figures
    from .map import plot_map
    from .modes import plot_modes
    from .paper_style import Style
    from .plane import plot_plane
    from .ribbon import plot_ribbon
    from .scatter import plot_batch
    from .strains import plot_strains

__all__ = [
    "Pictures",
    "Style",
    "plot_batch",
    "plot_branch",
    "plot_map",
    "plot_modes",
    "plot_plane",
    "plot_ribbon",
    "plot_solution",
    "plot_strains",
    "save_animation",
    "save_figures",
]

_HOMES = {
    "Pictures": "files",
    "Style": "paper_style",
    "plot_batch": "scatter",
    "plot_branch": "branch",
    "plot_map": "map",
    "plot_modes": "modes",
    "plot_plane": "plane",
    "plot_ribbon": "ribbon",
    "plot_solution": "files",
    "plot_strains": "strains",
    "save_animation": "animation",
    "save_figures": "files",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ribbonopt.views' has no attribute {name!r}")
    return getattr(import_module(f"ribbonopt.views.{_HOMES[name]}"), name)
