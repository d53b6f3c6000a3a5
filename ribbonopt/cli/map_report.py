"""What `map` says of a map: lines, loci, regions with their counts, doubts, files."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from ribbonopt.output.digits import upwards
from ribbonopt.plain import Row
from ribbonopt.text import one_line

from .common import listing

if TYPE_CHECKING:
    from ribbonopt.studies.maps.map import Map

SEARCHED = "shapes are searched for along branches: what no such branch meets is not found"
MOST = 12  # regions that are listed


def report(found: Map) -> str:
    """Return what is said of a map."""
    data = found.data
    x, y = data["x"], data["y"]
    (left, right), (low, high) = data["ranges"]
    special = sum(line["special"] for line in data["lines"])
    branches = sum(line["branches"] for line in data["lines"])
    lines = [
        f"{found.name}: {x} from {left:g} to {right:g}, {y} from {low:g} to {high:g}",
        f"  {_number(len(data['lines']), 'line')}: {_number(branches, 'branch')}, "
        f"{_number(special, 'special point')}",
        *(_failed(line) for line in data["lines"] if not line["verified"]),
        *(_locus(locus, x, y) for locus in data["loci"]),
        *_regions(data["regions"], x, y),
        *(f"  in doubt: {doubt}" for doubt in data["doubts"]),
        *(f"  note: {note}" for note in data["notes"]),
        *[f"  {SEARCHED}"] * any(point.get("told") for point in data["points"]),
        f"  written: {one_line(listing(found.folder))}",
    ]
    return "\n".join(lines)


def _failed(line: Row) -> str:
    return f"  the line {line['along']} at {line['value']:g} failed: {line['message']}"


def _locus(locus: Row, x: str, y: str) -> str:
    points = locus["points"]
    (x0, y0), (x1, y1) = points[0], points[-1]
    bar = "" if locus["error"] is None else f", relative error at most {upwards(locus['error'])}"
    kinds = Counter(mark["kind"] for mark in locus["special"])
    named = "".join(f", {kind} {count}" for kind, count in kinds.items())
    return (
        f"  locus {locus['number']}, {locus['kind']}: {len(points)} points from "
        f"({x0:.6g}, {y0:.6g}) to ({x1:.6g}, {y1:.6g}){named}{bar}"
    )


def _regions(regions: list[Row], x: str, y: str) -> list[str]:
    told = [_region(region) for region in regions[:MOST]]
    if len(regions) > MOST:
        told.append(f"  and {len(regions) - MOST} smaller regions")
    return told


def _region(region: Row) -> str:
    x, y = region["at"]
    where = f"  region {region['number']}, about ({x:.6g}, {y:.6g})"
    if region["narrow"]:
        return f"{where}: too narrow, not counted"
    if region["count"] is None:
        return f"{where}: not counted"
    shapes = f"{_number(region['count'], 'shape')} found"
    limit = "" if region["below"] is None else f" below the energy {region['below']:.6g}"
    return f"{where}: {shapes}{limit}, {region['stable']} stable"


def _number(count: int, word: str) -> str:
    """Return a number of things in words: 1 line, 2 branches."""
    return f"{count} {word}{'' if count == 1 else 'es' if word.endswith('ch') else 's'}"
