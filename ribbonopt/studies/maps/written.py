"""A survey as plain data: `map.json`, and the rows of `map.csv`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.output.summary import versions
from ribbonopt.plain import Row, finite
from ribbonopt.studies.machine import machine

from .jobs import LINES, LOCI
from .loci import Locus, value_of
from .survey import Survey

SHAPE = ("energy", "negative", "in_plane", "stable", "image", "symmetry", "error")
CONVERGED, NOTHING, FAILED = "converged", "nothing_found", "no_branch"


def data_of(survey: Survey) -> dict[str, Any]:
    """Return what `map.json` says."""
    plan = survey.plan
    status, message = _status(survey)
    data = {
        "name": survey.scene.name,
        "status": status,
        "message": message,
        "x": plan.x,
        "y": plan.y,
        "ranges": plan.ranges,
        "si": survey.scene.ribbon is not None,
        "labels": survey.scene.labels,
        "lines": [_line(row, i, survey) for i, row in enumerate(survey.lines, start=1)],
        "loci": [_locus(locus, survey) for locus in survey.loci if len(locus.points) > 1],
        "regions": [_region(i, survey) for i in range(len(survey.regions))],
        "points": [_point(i, row, survey) for i, row in enumerate(survey.points, start=1)],
        "doubts": survey.doubts,
        "notes": survey.notes,
        "machine": machine(),
        "versions": versions(),
    }
    found: dict[str, Any] = finite(data)
    return found


def rows_of(survey: Survey) -> Iterator[Row]:
    """Yield a row for each point of each locus: its number and kind, then what was recorded."""
    for locus in survey.loci:
        for row in locus.rows if len(locus.points) > 1 else ():
            recorded = {k: v for k, v in row.items() if k not in ("number", "stage", "origin")}
            yield {"locus": locus.number, "of": locus.kind, "point": row["number"], **recorded}


def _status(survey: Survey) -> tuple[str, str]:
    """Return how it went, and a sentence where it found nothing."""
    if not any(row["verified"] for row in survey.lines):
        first = next((row["message"] for row in survey.lines), "")
        return FAILED, f"no branch could be followed on any line: {first}"
    if not survey.loci:
        count, other = len(survey.lines), " or ".join(survey.plan.of)
        said = f"{count} lines" if count > 1 else "the one line"
        others = f"; {survey.found} special points of other kinds" if survey.found else ""
        return NOTHING, (
            f"no {other} on {said} that {'were' if count > 1 else 'was'} followed{others}; choose "
            "other `lines`, or wider ranges"
        )
    return CONVERGED, ""


def _line(row: Row, number: int, survey: Survey) -> Row:
    other = survey.plan.y if row["along"] == survey.plan.x else survey.plan.x
    return {
        "along": row["along"],
        "value": row[other],
        "verified": row["verified"],
        "folder": f"{LINES}/{number}",
        "branches": row.get("branches", 0),
        "special": len(row.get("specials", ())),
        "message": row["message"],
        "endings": row.get("endings", []),
    }


def _locus(locus: Locus, survey: Survey) -> Row:
    negative = [row["negative"] for row in locus.rows if row.get("negative") is not None]
    errors = [row["error"] for row in locus.rows if row.get("error") is not None]
    plan = survey.plan
    return {
        "number": locus.number,
        "kind": locus.kind,
        "folder": f"{LOCI}/{locus.number}",
        "ending": locus.ending,
        "negative": min(negative, default=None),
        "changes": survey.changes(locus),
        "error": max(errors, default=None),
        "points": _values(locus.points, survey),
        "curve": _values(locus.curve, survey),
        "special": [
            {"kind": row["kind"], "at": [row[plan.x], row[plan.y]], "error": row["error"]}
            for row in locus.special
        ],
    }


def _region(i: int, survey: Survey) -> Row:
    region, best = survey.regions[i], survey.best(i)
    return {
        "number": i + 1,
        "at": value_of(region.point, survey.plan),
        "area": region.face.area,
        "clear": region.clear,
        "narrow": region.narrow,
        "count": best["count"] if best else None,
        "stable": best["stable"] if best else None,
        "below": best.get("below") if best else None,
        "beside": [other + 1 for other in sorted(region.beside)],
        "rings": [_values(ring, survey) for ring in region.face.rings],
    }


def _point(number: int, row: Row, survey: Survey) -> Row:
    plan = survey.plan
    said = {key: row.get(key) for key in ("count", "stable", "told") if row.get(key) is not None}
    return {
        "number": number,
        "region": row["region"] + 1,
        "at": [row[plan.x], row[plan.y]],
        "verified": row["verified"],
        "message": row["message"],
        "folder": row["folder"],
        "shapes": [{key: shape.get(key) for key in SHAPE} for shape in row.get("shapes", ())],
        **said,
    }


def _values(points: Array, survey: Survey) -> list[list[float]]:
    """Return points (k, 2) of the square in the units of the scene."""
    low, high = np.array(survey.plan.ranges).T
    found: list[list[float]] = (low + points * (high - low)).tolist()
    return found
