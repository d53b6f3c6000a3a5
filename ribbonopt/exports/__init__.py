"""Shapes as files that other programs open: surfaces, lines and tables of solutions and branches.

`export` writes them; each format is a file here with one function, in the table `formats.FORMATS`.
Importing this room loads none of its modules.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .writing import export

__all__ = ["export"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'ribbonopt.exports' has no attribute {name!r}")
    return getattr(import_module("ribbonopt.exports.writing"), name)
