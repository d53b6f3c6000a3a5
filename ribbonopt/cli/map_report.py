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
        f"  {len(data['lines'])} lines: {branches} branches, {special} special points",
        *(_failed(line) for line in data["lines"] if not line["verified"]),
        *(_locus(locus, x, y) for locus in data["loci"]),
        *_regions(data["regions"], x, y),
        *(f"  in doubt: {doubt}" for doubt in data["doubts"]),
        *_told(data["points"]),
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
    shapes = f"{region['count']} shape{'s' * (region['count'] != 1)} found"
    return f"{where}: {shapes}, {region['stable']} stable"


def _told(points: list[Row]) -> list[str]:
    """Return how shapes were looked for, once."""
    said = dict.fromkeys(point["told"] for point in points if point.get("told"))
    return [f"  {one_line(text)}" for text in list(said)[:1]]
