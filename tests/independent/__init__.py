"""Equilibria of ribbons by a program of its own: numpy and scipy, nothing of `ribbonopt`.

The laws are typed anew, the ribbon is integrated by the explicit method DOP853 step by step, and
all steps are closed by Newton's method at once (multiple shooting). See `polish`.
"""

from .path import Path
from .polish import Truth, polish
from .rod import Law, shot

__all__ = ["Law", "Path", "Truth", "polish", "shot"]
