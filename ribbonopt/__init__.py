"""Equilibria of elastic ribbons as optimal-control problems, from YAML scenes.

`load_scene` reads a scene, `solve` finds its equilibrium, a `Solution` is sampled, saved, plotted
or used as the next guess. Names are imported when first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ribbonopt import version

if TYPE_CHECKING:
    from .output.results import load_solution, save_solution
    from .output.summary import summarize
    from .pipeline.prepared import prepare, solve
    from .scene import Scene, dump_scene, json_schema, load_scene, loads_scene
    from .solution.solution import Solution

__version__ = version.VERSION

__all__ = [
    "Scene",
    "Solution",
    "__version__",
    "dump_scene",
    "json_schema",
    "load_scene",
    "load_solution",
    "loads_scene",
    "prepare",
    "save_solution",
    "solve",
    "summarize",
]

_HOMES = {
    "Scene": "scene",
    "Solution": "solution.solution",
    "dump_scene": "scene",
    "json_schema": "scene",
    "load_scene": "scene",
    "load_solution": "output.results",
    "loads_scene": "scene",
    "prepare": "pipeline.prepared",
    "save_solution": "output.results",
    "solve": "pipeline.prepared",
    "summarize": "output.summary",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ribbonopt' has no attribute {name!r}")
    return getattr(import_module(f"ribbonopt.{_HOMES[name]}"), name)
