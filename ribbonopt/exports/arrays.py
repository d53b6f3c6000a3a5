"""NPZ and JSON: everything there is of a ribbon, for programs of one's own.

Rows along s, the surface as points and faces, and in JSON meanings, units, loads and the summary.
"""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np

from ribbonopt.output.summary import summarize
from ribbonopt.plain import finite

from .carried import Carried
from .quantities import ROWS, known_of, values_of
from .tables import loads_of


def write_npz(carried: Carried) -> dict[str, bytes]:
    """Return arrays by the names of quantities: (k,), vectors (k, 3); points, faces and normals."""
    shape, mesh, file = carried.shape, carried.mesh, io.BytesIO()
    arrays: dict[str, Any] = {quantity.name: values_of(shape, quantity.name) for quantity in ROWS}
    arrays |= {"starts": np.array(shape.starts), "closing": np.array(shape.closing)}
    arrays |= {"points": mesh.points, "quads": mesh.quads, "normals": mesh.normals}
    arrays |= {"point_rows": np.repeat(mesh.rows, len(mesh.across))}
    arrays |= {"about": np.array(json.dumps(carried.remarks))}
    np.savez_compressed(file, **arrays)
    return {".npz": file.getvalue()}


def write_json(carried: Carried) -> dict[str, bytes]:
    """Return the same as text, with meanings, units, loads and the summary of the solution."""
    shape, mesh = carried.shape, carried.mesh
    known = known_of(shape, ROWS)
    rows = {
        quantity.name: {
            "means": quantity.means,
            "unit": quantity.unit(shape.units),
            "values": known[quantity.name].tolist(),
        }
        for quantity in ROWS
        if quantity.name in known
    }
    found = {
        "about": carried.remarks,
        "numbers": dict(carried.numbers),
        "starts": list(shape.starts),
        "closing": shape.closing,
        "half_width": shape.half_width,
        "rows": rows,
        "surface": {
            "points": mesh.points.tolist(),
            "quads": mesh.quads.tolist(),
            "rows": mesh.rows.tolist(),
            "across": mesh.across.tolist(),
        },
        "loads": list(loads_of(carried.solution)),
        "summary": summarize(carried.solution),
    }
    # In one line: a number a line is no easier to read, and three times as long.
    return {".json": (json.dumps(finite(found), allow_nan=False) + "\n").encode()}
