"""Ribbons of a branch as one animation in ParaView: `.pvd`, and `.vtp.series` for short names.

Time is the parameter where it grows from point to point; elsewhere, as behind a fold, it is the
number of the point, and every file tells its parameter itself (field data `parameter`).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from ribbonopt.plain import json_text
from ribbonopt.text import marked_up


def times_of(parameters: Sequence[float], numbers: Sequence[float]) -> Sequence[float]:
    """Return the times of points that have these parameters and numbers."""
    grows = all(a < b for a, b in pairwise(parameters))
    return parameters if grows else numbers


def write(files: Sequence[str], times: Sequence[float]) -> dict[str, bytes]:
    """Return both files of a series, by what follows their common name."""
    pairs = list(zip(files, times, strict=True))
    sets = "".join(
        f'<DataSet timestep="{time!r}" file="{marked_up(file)}"/>\n' for file, time in pairs
    )
    pvd = (
        '<?xml version="1.0" encoding="utf-8"?>\n<VTKFile type="Collection" version="0.1">\n'
        f"<Collection>\n{sets}</Collection>\n</VTKFile>\n"
    )
    listed = [{"name": file, "time": time} for file, time in pairs]
    series = json_text({"file-series-version": "1.0", "files": listed})
    return {".pvd": pvd.encode(), ".vtp.series": series.encode()}
