"""Solutions, branches and batches to files that other programs open."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ribbonopt.errors import OutputError
from ribbonopt.output.claims import claimed
from ribbonopt.output.places import unwritable
from ribbonopt.output.staging import replaced
from ribbonopt.text import name_fault
from ribbonopt.views.pieces import ROWS
from ribbonopt.views.shape import Shape, common_half_width, shape_from
from ribbonopt.views.subject import Subject, subject_of
from ribbonopt.views.surface import sweep

from . import series
from .carried import Carried
from .colours import FIELD, colours_of
from .formats import FORMATS
from .found import Ribbon, Thing, left_out_of, name_of, opened, ribbons_of
from .mesh import ACROSS
from .settings import Settings, place_in

NAME = "ribbon"  # of files, where a scene's own cannot be one


class Gathered(NamedTuple):
    """Ribbons and their shapes, the name of their files, and what was left out and why."""

    name: str
    ribbons: list[Ribbon]
    shapes: list[Shape]
    left_out: list[str]


def export(
    thing: Thing | str | Path,
    path: str | Path,
    formats: Sequence[str] = (),
    *,
    half_width: float | None = None,
    rows: int = ROWS,
    across: int = ACROSS,
    color: str = FIELD,
    complete: bool = True,
) -> list[Path]:
    """Write files that ParaView, Blender, pandas and others open.

    Parameters
    ----------
    thing
        A solution, whose other equilibria are exported too, a branch, a batch, or a folder of one.
    path
        A file, whose ending then is the format (`helix.glb`), or a folder for files that are named
        as the scene. Several ribbons have their numbers behind that name.
    formats
        One or several of vtp, glb, ply, obj, stl, csv, npz, json, where `path` is a folder.
    half_width
        Of the surface, in the scene's unit of length. Default: the ribbon's own where the scene
        says it, else one for all that keeps generatrices apart.
    rows
        About how many along the piece that was solved.
    across
        Strips from edge to edge.
    color
        The scalar by which `glb` and `ply` are coloured, such as u2, u3, eta, energy, m2.
    complete
        With the rest of a band, or of a strip, of which the solution is a piece by symmetry.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    ModelError
        If a format, a number or a field cannot be.
    OutputError
        If there is nothing to export, or a file cannot be written.
    """
    folder, name, formats = place_in(Path(path), formats)
    settings = Settings(tuple(formats), half_width, rows, across, color, complete).checked()
    return write(gather(thing, settings), folder, name, settings)


def gather(thing: Thing | str | Path, settings: Settings) -> Gathered:
    """Return all ribbons of something, sampled, before anything is written.

    Those that cannot be exported are left out, as long as there are others.

    Raises
    ------
    OutputError
        If there is nothing to export.
    """
    found = opened(thing) if isinstance(thing, str | Path) else thing
    left_out, ribbons, subjects = left_out_of(found), list[Ribbon](), list[Subject]()
    for ribbon in ribbons_of(found):
        subject = subject_of(ribbon.solution, settings.complete, settings.rows)
        if fault := _fault(subject):
            left_out.append(f"{ribbon.solution.scene.name}{ribbon.words}: {fault}")
        else:
            ribbons.append(ribbon)
            subjects.append(subject)
    if not ribbons:
        raise OutputError(f"nothing to export: {left_out[0] if left_out else 'there is no point'}")
    name, shapes = name_of(found), _shapes(subjects, settings)
    return Gathered(NAME if name_fault(name) else name, ribbons, shapes, left_out)


def write(gathered: Gathered, folder: Path, name: str | None, settings: Settings) -> list[Path]:
    """Write all files into a folder and return where.

    Parameters
    ----------
    gathered
        What is written.
    folder, name
        Where; what names of files begin with, None for the name of the scene.
    settings
        As in `gather`.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    name, paths = name or gathered.name, list[Path]()
    listed: dict[tuple[str, str], list[tuple[str, Ribbon]]] = {}
    with claimed(folder, (), alone=False) as place:

        def put(files: Mapping[str, bytes], common: str) -> None:
            paths.extend(_put(place / f"{common}{end}", content) for end, content in files.items())

        for ribbon, carried in _carried(gathered, settings):
            for kind in settings.formats:
                files = FORMATS[kind].write(carried)
                put(files, f"{name}{ribbon.label}")
                if ribbon.series is not None and FORMATS[kind].series:
                    for ending in files:
                        key = ribbon.series, ending.removesuffix(f".{kind}")
                        listed.setdefault(key, []).append((f"{name}{ribbon.label}{ending}", ribbon))
        for (label, which), members in listed.items():
            put(_series(members), f"{name}{label}{which}")
    return paths


def _fault(subject: Subject) -> str:
    """Return why a ribbon cannot be exported; empty if it can."""
    whole = all(np.isfinite(piece.r).all() for piece in subject.pieces)
    return "" if whole else "its solve failed, and has no positions that are finite"


def _shapes(subjects: list[Subject], settings: Settings) -> list[Shape]:
    """Return shapes; those whose scenes say no width have one in common."""
    width = settings.half_width
    unknown = [subject for subject in subjects if subject.drawn is None]
    usual = common_half_width(unknown) if width is None and len(unknown) > 1 else None
    return [shape_from(s, sweep(s.pieces, width or s.drawn or usual)) for s in subjects]


def _carried(gathered: Gathered, settings: Settings) -> Iterator[tuple[Ribbon, Carried]]:
    """Yield all ribbons as they are written, one by one: faces take more room than rows."""
    colours = colours_of(settings.color, gathered.shapes)
    for ribbon, shape in zip(gathered.ribbons, gathered.shapes, strict=True):
        title = f"{shape.name}{ribbon.words}"
        yield (
            ribbon,
            Carried(shape, ribbon.solution, title, colours, settings.across, ribbon.numbers),
        )


def _series(members: list[tuple[str, Ribbon]]) -> Mapping[str, bytes]:
    numbers = [ribbon.numbers for _, ribbon in members]
    times = series.times_of([n["parameter"] for n in numbers], [n["number"] for n in numbers])
    return series.write([file for file, _ in members], times)


def _put(path: Path, content: bytes) -> Path:
    try:
        with replaced(path) as new:
            new.write_bytes(content)
    except OSError as error:
        raise unwritable(path, error) from error
    return path
