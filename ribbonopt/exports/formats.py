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
    """A format: what it is in words, what writes it, and whether branches are series of it."""

    words: str
    write: Callable[[Carried], Mapping[str, bytes]]
    series: bool = False


#: by the endings of their main files
FORMATS: Mapping[str, Format] = {
    "vtp": Format("surface, and line with directors, for ParaView", vtp.write, series=True),
    "glb": Format("coloured surface for Blender, browsers and slides", glb.write),
    "ply": Format("surface with all fields", ply.write),
    "obj": Format("surface as text", obj.write),
    "stl": Format("surface as bare triangles", stl.write),
    "csv": Format("rows along s, and loads, as tables", tables.write),
    "npz": Format("all arrays, for numpy", arrays.write_npz),
    "json": Format("everything as text", arrays.write_json),
}
