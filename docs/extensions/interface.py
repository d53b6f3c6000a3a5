"""The page of the Python interface: what is public, and nothing else, by its docstrings.

Public are the names of `ribbonopt`, the classes of scenes, and what one extends.
"""

from __future__ import annotations

from inspect import isclass
from pathlib import Path

from pieces import page

import ribbonopt
from ribbonopt import scene

WORDS = """\
All names of `ribbonopt`; how they are used is in [Python](../python.md). Arrays are numpy's;
shapes are in parentheses, k being the number of places that are asked for. Vectors are in the lab
frame unless named along directors.
"""
#: what one extends, by module
EXTENDED = {
    "ribbonopt.mechanics.laws.law": ("ConstitutiveLaw",),
    "ribbonopt.mechanics.laws.kirchhoff": ("KirchhoffLaw",),
    "ribbonopt.mechanics.loads.load": ("Load", "DeadLoad"),
    "ribbonopt.scene.supports": ("Support", "Position", "LoadVector"),
    "ribbonopt.transcription.tableaus": ("Tableau",),
    "ribbonopt.problem": ("BoundaryValueProblem",),
}
ERRORS = (
    *("RibbonoptError", "SceneError", "ModelError", "TranscriptionError", "ConvergenceError"),
    *("OutputError", "PictureError", "WorkerError", "ViewError"),
)


def pages(folder: Path) -> dict[str, str]:
    """Return the page."""
    public = [name for name in ribbonopt.__all__ if not name.startswith("__")]
    classes = [name for name in public if isclass(getattr(ribbonopt, name))]
    functions = [name for name in public if name not in classes]
    of_scenes = [
        name for name in scene.__all__ if isclass(getattr(scene, name)) and name not in public
    ]
    extended = [_class(module, name) for module, names in EXTENDED.items() for name in names]
    parts = (
        *("# Python interface", WORDS, "## Functions"),
        *(_directive(f"autofunction:: ribbonopt.{name}") for name in functions),
        "## Objects",
        *(_class("ribbonopt", name) for name in classes),
        *("## Scenes built in Python", "Import these from `ribbonopt.scene`."),
        *(_class("ribbonopt.scene", name) for name in of_scenes if name not in SHOWN_ELSEWHERE),
        *("## What one extends", "How: [Extending](../extending.md)."),
        *extended,
        *("## Errors", "Import these from `ribbonopt.errors`."),
        *(_directive(f"autoexception:: ribbonopt.errors.{name}") for name in ERRORS),
        _directive("autoexception:: ribbonopt.scene.formulas.parsing.FormulaError"),
    )
    return {"interface.md": page(*parts)}


SHOWN_ELSEWHERE = {name for names in EXTENDED.values() for name in names}


def _class(module: str, name: str) -> str:
    return _directive(f"autoclass:: {module}.{name}", "   :members:")


def _directive(*lines: str) -> str:
    first, *others = lines
    return "\n".join(("```{eval-rst}", f".. {first}", *others, "```"))
