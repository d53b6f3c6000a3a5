"""Equilibria of elastic ribbons as optimal-control problems, from YAML scenes.

`load_scene` reads a scene, `solve` finds its equilibrium, a `Solution` is sampled, saved, plotted
or used as the next guess; `Continuation`, `run_batch` and `compare` solve many. `load` reads back
whatever was written: a `Solution`, `Branch`, `Batch` or `Map`. Names are imported when first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ribbonopt import version

if TYPE_CHECKING:
    from .exports import export
    from .output.results import load_solution, save_solution
    from .output.summary import summarize
    from .pipeline.prepared import prepare
    from .scene import Scene, dump_scene, json_schema, load_scene, loads_scene
    from .solution.solution import Solution
    from .studies.batch.batch import run_batch
    from .studies.batch.files import load_batch
    from .studies.batch.results import Batch
    from .studies.batch.sweep import load_study
    from .studies.buckling.buckling import buckling_loads
    from .studies.comparison.compare import compare
    from .studies.continuation.branch import Branch
    from .studies.continuation.continuation import Continuation
    from .studies.continuation.files import load_branch
    from .studies.equilibria import all_equilibria
    from .studies.loading import load
    from .studies.maps.map import Map
    from .studies.solving import solve
    from .views import plot_plane, plot_ribbon, plot_strains, save_figures

__version__ = version.VERSION

__all__ = [
    "Batch",
    "Branch",
    "Continuation",
    "Map",
    "Scene",
    "Solution",
    "__version__",
    "all_equilibria",
    "buckling_loads",
    "compare",
    "dump_scene",
    "export",
    "json_schema",
    "load",
    "load_batch",
    "load_branch",
    "load_scene",
    "load_solution",
    "load_study",
    "loads_scene",
    "plot_plane",
    "plot_ribbon",
    "plot_strains",
    "prepare",
    "run_batch",
    "save_figures",
    "save_solution",
    "solve",
    "summarize",
]

_HOMES = {
    "Batch": "studies.batch.results",
    "Branch": "studies.continuation.branch",
    "Continuation": "studies.continuation.continuation",
    "Map": "studies.maps.map",
    "Scene": "scene",
    "Solution": "solution.solution",
    "all_equilibria": "studies.equilibria",
    "buckling_loads": "studies.buckling.buckling",
    "compare": "studies.comparison.compare",
    "dump_scene": "scene",
    "export": "exports",
    "json_schema": "scene",
    "load": "studies.loading",
    "load_batch": "studies.batch.files",
    "load_branch": "studies.continuation.files",
    "load_scene": "scene",
    "load_solution": "output.results",
    "load_study": "studies.batch.sweep",
    "loads_scene": "scene",
    "plot_plane": "views",
    "plot_ribbon": "views",
    "plot_strains": "views",
    "prepare": "pipeline.prepared",
    "run_batch": "studies.batch.batch",
    "save_figures": "views",
    "save_solution": "output.results",
    "solve": "studies.solving",
    "summarize": "output.summary",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ribbonopt' has no attribute {name!r}")
    return getattr(import_module(f"ribbonopt.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return [*__all__, "__doc__", "__file__", "__name__", "__path__"]
