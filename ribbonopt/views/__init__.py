"""Pictures of a solution: its strains, its path in the (u2, u3) plane, the ribbon in space.

Importing this room is cheap: matplotlib is imported when a figure is drawn, not before.
"""

from .files import save_figures
from .plane import plot_plane
from .ribbon import plot_ribbon
from .strains import plot_strains

__all__ = ["plot_plane", "plot_ribbon", "plot_strains", "save_figures"]
