"""STL, for printers and finite elements: bare triangles in single precision, little-endian."""

from __future__ import annotations

import numpy as np

from .carried import Carried

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEAD = 80  # bytes


def write(carried: Carried) -> dict[str, bytes]:
    """Return the surface; its header says the units."""
    mesh = carried.mesh
    corners = mesh.points[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    found = np.zeros(len(corners), _TRIANGLE)
    # By the standard the normal may be zero where a triangle has none.
    found["normal"] = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0)
    found["corners"] = corners
    # It must not begin with `solid`, as texts do.
    head = f"binary STL of ribbonopt; units: {carried.shape.units.name}".encode()[:_HEAD]
    count = np.array(len(found), "<u4").tobytes()
    return {".stl": head.ljust(_HEAD) + count + found.tobytes()}
