"""PLY, of Stanford: little-endian, every field a property of the points, colours and normals."""

from __future__ import annotations

import numpy as np

from .carried import Carried
from .quantities import FIELDS, known_of

#: nx, ny, nz are normals to all readers, s is a coordinate of textures
CALLED = {"n": "force", "m": "moment", "s": "arclength"}
_NAMES = {"f4": "float", "f8": "double", "u1": "uchar"}


def write(carried: Carried) -> dict[str, bytes]:
    """Return the surface: positions in double, fields and normals in single precision."""
    mesh, shape = carried.mesh, carried.shape
    columns = {axis: mesh.points[:, i] for i, axis in enumerate("xyz")}
    columns |= {f"n{axis}": mesh.normals[:, i].astype("f4") for i, axis in enumerate("xyz")}
    seen = mesh.spread(carried.colours.of(shape)).astype("u1")
    columns |= {name: seen[:, i] for i, name in enumerate(("red", "green", "blue"))}
    for field in FIELDS:
        found = known_of(shape, (field,))
        values = mesh.spread(found[field.name]).astype("f4") if found else None
        if values is not None and field.vector:
            name = CALLED.get(field.name, field.name)
            columns |= {f"{name}_{axis}": values[:, i] for i, axis in enumerate("xyz")}
        elif values is not None:
            columns[CALLED.get(field.name, field.name)] = values
    kinds = [(name, values.dtype.str[1:]) for name, values in columns.items()]
    points = np.empty(len(mesh.points), [(name, f"<{kind}") for name, kind in kinds])
    for name, values in columns.items():
        points[name] = values
    faces = np.empty(len(mesh.quads), [("count", "u1"), ("corners", "<i4", 4)])
    faces["count"], faces["corners"] = 4, mesh.quads
    head = ["ply", "format binary_little_endian 1.0"]
    head += [f"comment {_ascii(comment)}" for comment in carried.comments]
    head += [f"element vertex {len(points)}"]
    head += [f"property {_NAMES[kind]} {name}" for name, kind in kinds]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    text = "\n".join(head) + "\n"
    return {".ply": text.encode("ascii") + points.tobytes() + faces.tobytes()}


def _ascii(text: str) -> str:
    """Return a remark in the only letters that a PLY header may have."""
    return text.encode("ascii", "backslashreplace").decode()
