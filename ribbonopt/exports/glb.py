"""GLB, binary glTF 2.0, for Blender, browsers and slides: one file with normals and colours.

Numbers are those of the lab frame in single precision. In glTF y is up, where in scenes it is z: a
turn of the node says so, and Blender, which turns back, has the axes of the lab. glTF is in
metres, which in SI they are; else 1 (L) is a metre.
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

from ribbonopt.plain import finite

from .carried import Carried
from .colours import as_light

FLOAT, INDEX = 5126, 5125  # float32, uint32
VERTICES, ELEMENTS = 34962, 34963
LINE_STRIP = 3
UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # quaternion x, y, z, w: the lab's z is glTF's y
MATERIAL = {
    "doubleSided": True,
    "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.6},
}
LINE = {"pbrMetallicRoughness": {"baseColorFactor": [0.02, 0.02, 0.02, 1.0], "metallicFactor": 0.0}}


class _Binary:
    """The binary chunk, with its views and accessors."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.data = b""
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, values: np.ndarray[Any, Any], kind: str, target: int = VERTICES) -> int:
        """Add an array, (k, 3) of float32 or (k,) of uint32, and return its accessor."""
        self.views.append(
            {
                "buffer": 0,
                "byteOffset": len(self.data),
                "byteLength": values.nbytes,
                "target": target,
            }
        )
        self.accessors.append(
            {
                "bufferView": len(self.views) - 1,
                "componentType": FLOAT if values.dtype.kind == "f" else INDEX,
                "count": len(values),
                "type": kind,
            }
        )
        self.data += values.astype(values.dtype.newbyteorder("<")).tobytes()  # each 4 bytes
        return len(self.accessors) - 1

    def place(self, points: np.ndarray[Any, Any]) -> int:
        """Add positions, of which the standard asks for the bounds."""
        single = points.astype(np.float32)
        at = self.add(single, "VEC3")
        bounds = {"min": single.min(axis=0).tolist(), "max": single.max(axis=0).tolist()}
        self.accessors[at] |= bounds
        return at


def write(carried: Carried) -> dict[str, bytes]:
    """Return the surface, coloured by a field, and the centre line."""
    mesh, binary = carried.mesh, _Binary()
    colours = mesh.spread(as_light(carried.colours.of(carried.shape)))
    surface = {
        "attributes": {
            "POSITION": binary.place(mesh.points),
            "NORMAL": binary.add(_unit(mesh.normals), "VEC3"),
            "COLOR_0": binary.add(colours.astype(np.float32), "VEC3"),
        },
        "indices": binary.add(mesh.triangles.astype(np.uint32).ravel(), "SCALAR", ELEMENTS),
        "material": 0,
    }
    line = {
        "attributes": {"POSITION": binary.place(carried.shape.r[mesh.rows])},
        "mode": LINE_STRIP,
        "material": 1,
    }
    colour = {"color": carried.colours.field, "color_largest": carried.colours.largest}
    scene = {
        "asset": {"version": "2.0", "generator": "ribbonopt"},
        "scene": 0,
        "scenes": [{"nodes": [0], "extras": {**carried.remarks, **carried.numbers, **colour}}],
        "nodes": [
            {"name": "lab", "rotation": UP, "children": [1, 2]},
            {"name": "ribbon", "mesh": 0},
            {"name": "centre line", "mesh": 1},
        ],
        "meshes": [
            {"name": "ribbon", "primitives": [surface]},
            {"name": "centre line", "primitives": [line]},
        ],
        "materials": [MATERIAL, LINE],
        "buffers": [{"byteLength": len(binary.data)}],
        "bufferViews": binary.views,
        "accessors": binary.accessors,
    }
    text = json.dumps(finite(scene)).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(binary.data), b"BIN\0") + binary.data
    return {".glb": struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks}


def _unit(normals: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return normals in single precision, as long as one is there."""
    single = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(single, np.float32)
