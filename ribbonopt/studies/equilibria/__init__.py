"""All equilibria of one scene, along branches through their folds."""

from __future__ import annotations

from .all import all_equilibria
from .found import Equilibrium, Found

__all__ = ["Equilibrium", "Found", "all_equilibria"]
