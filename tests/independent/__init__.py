"""Equilibria of ribbons by a program of its own: numpy and scipy, nothing of `ribbonopt`.

The laws are typed anew, the ribbon is integrated by the explicit method DOP853 step by step, and
all steps are closed by Newton's method at once (multiple shooting). See `polish`.

Under loads, with natural strains, width, finite B1 and stations (`curved`, `loaded`) a ribbon is
integrated with all that acts on it, and shot at what its ends ask for; `confirm` does so from the
start of a solution of the package, which it reads by the names of fields (`described`).
"""

from .confirm import confirm, examine
from .path import Path
from .polish import Truth, polish
from .rod import Law, shot

__all__ = ["Law", "Path", "Truth", "confirm", "examine", "polish", "shot"]
