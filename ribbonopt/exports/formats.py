"""The formats that a ribbon is exported to: a new one is a file with one function, and a line here.

The function takes what is carried away and returns the contents of its files, by what follows the
name that they have in common.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from . import arrays, glb, obj, ply, stl, tables, vtp
from .carried import Carried


class Format(NamedTuple):
    """What writes a format, and whether the points of a branch are a series of it."""

    write: Callable[[Carried], Mapping[str, bytes]]
    series: bool = False


#: by the endings of their main files
FORMATS: Mapping[str, Format] = {
    "vtp": Format(vtp.write, series=True),
    "glb": Format(glb.write),
    "ply": Format(ply.write),
    "obj": Format(obj.write),
    "stl": Format(stl.write),
    "csv": Format(tables.write),
    "npz": Format(arrays.write_npz),
    "json": Format(arrays.write_json),
}
