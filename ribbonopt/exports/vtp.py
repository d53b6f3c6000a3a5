"""VTP, of VTK and ParaView: XML, arrays appended in base64 of zlib blocks, doubles as they are.

The surface and the centre line are files of their own, `NAME.vtp` and `NAME-line.vtp`: ParaView
shows, colours and filters each by itself, and glyphs of the directors want the line alone.
"""

from __future__ import annotations

import base64
import struct
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.text import marked_up

from .carried import Carried
from .mesh import Whole
from .quantities import FIELDS, known_of

BLOCK = 2**16  # bytes that are packed at once
_TYPES = {"f8": "Float64", "i8": "Int64", "i1": "Int8"}


class _Appended:
    """Arrays behind the XML, and the elements that say where each begins."""

    def __init__(self) -> None:
        """Begin with none."""
        self.data: list[str] = []
        self._size = 0

    def array(self, values: np.ndarray[Any, Any], name: str) -> str:
        """Add an array, (k,) or (k, c) of f8, i8 or i1, and return its element."""
        found = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
        parts = f' NumberOfComponents="{found.shape[1]}"' if found.ndim > 1 else ""
        text = _packed(found.tobytes())
        at, self._size = self._size, self._size + len(text)
        self.data.append(text)
        return (
            f'<DataArray type="{_TYPES[found.dtype.str[1:]]}" Name="{marked_up(name)}"{parts} '
            f'format="appended" offset="{at}"/>\n'
        )


def write(carried: Carried) -> dict[str, bytes]:
    """Return the surface and the line with its directors, by what follows their common name."""
    mesh, shape = carried.mesh, carried.shape
    fields = known_of(shape, FIELDS)
    spread = {name: mesh.spread(values) for name, values in fields.items()}
    spread |= {"normal": mesh.normals}
    line = np.arange(len(shape.s))[None]
    return {
        ".vtp": _file(carried, mesh.points, spread, "Polys", mesh.quads, "normal"),
        "-line.vtp": _file(carried, shape.r, fields, "Lines", line, ""),
    }


def _file(
    carried: Carried,
    points: Array,
    fields: Mapping[str, Array],
    kind: str,
    cells: Whole,
    normals: str,
) -> bytes:
    """Return a file of points (p, 3), fields there, and cells (q, c) of a kind."""
    data = _Appended()
    known = "".join(data.array(values, name) for name, values in fields.items())
    place = data.array(points, "Points")
    corners = data.array(cells.astype(np.int64).ravel(), "connectivity")
    ends = data.array(cells.shape[1] * np.arange(1, len(cells) + 1, dtype=np.int64), "offsets")
    told = "".join(map(_text, carried.remarks, carried.remarks.values()))
    told += "".join(
        f'<DataArray type="Float64" Name="{marked_up(name)}" NumberOfTuples="1" format="ascii">'
        f"{value!r}</DataArray>\n"
        for name, value in carried.numbers.items()
    )
    counts = {name: len(cells) * (name == kind) for name in ("Verts", "Lines", "Strips", "Polys")}
    numbers = " ".join(f'NumberOf{name}="{count}"' for name, count in counts.items())
    scalars = f'Scalars="{carried.colours.field}"' if carried.colours.field in fields else ""
    shown = f'{scalars} Normals="{normals}"' if normals else scalars
    text = (
        '<?xml version="1.0" encoding="utf-8"?>\n'
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" '
        'compressor="vtkZLibDataCompressor">\n<PolyData>\n'
        f'<FieldData>\n{told}</FieldData>\n<Piece NumberOfPoints="{len(points)}" {numbers}>\n'
        f"<PointData {shown}>\n{known}</PointData>\n<Points>\n{place}</Points>\n"
        f"<{kind}>\n{corners}{ends}</{kind}>\n</Piece>\n</PolyData>\n"
        f'<AppendedData encoding="base64">\n_{"".join(data.data)}\n</AppendedData>\n</VTKFile>\n'
    )
    return text.encode()


def _text(name: str, value: str) -> str:
    """Return an element that says a text, as the codes of its bytes, which cannot be markup."""
    codes = " ".join(map(str, [*value.encode(errors="replace"), 0]))
    return (
        f'<DataArray type="String" Name="{marked_up(name)}" NumberOfTuples="1" format="ascii">'
        f"{codes}</DataArray>\n"
    )


def _packed(data: bytes) -> str:
    """Return bytes as VTK packs them: sizes of the blocks, then the blocks, each in base64."""
    blocks = [zlib.compress(data[i : i + BLOCK]) for i in range(0, len(data), BLOCK)]
    # The last size is that of a last block that is not whole.
    sizes = [len(blocks), BLOCK, len(data) % BLOCK, *map(len, blocks)]
    head = struct.pack(f"<{len(sizes)}Q", *sizes)
    return base64.b64encode(head).decode() + base64.b64encode(b"".join(blocks)).decode()
