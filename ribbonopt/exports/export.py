"""Solutions, branches and batches to files that other programs open."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import ExitStack
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


class Exported(NamedTuple):
    """Files that were written, what was left out and why, and which ribbons are not verified."""

    paths: list[Path]
    left_out: list[str]
    unverified: list[str]


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
        One or several of vtp, obj, ply, stl, glb, csv, npz, json; not needed where `path` ends
        with one.
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
    return export_files(thing, folder, name, settings).paths


def export_files(
    thing: Thing | str | Path, folder: Path, name: str | None, settings: Settings
) -> Exported:
    """Write files as `export` does, into a folder and under a name, the scene's if it is None.

    Ribbons that cannot be exported are left out, as long as there are others.

    Raises
    ------
    OutputError
        As `export`.
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
    name = name or name_of(found)
    carried = _carried(ribbons, _shapes(subjects, settings), settings)
    paths = _written(folder, NAME if name_fault(name) else name, carried, settings.formats)
    unverified = [c.title for _, c in carried if not c.solution.verified]
    return Exported(paths, left_out, unverified)


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


def _carried(
    ribbons: list[Ribbon], shapes: list[Shape], settings: Settings
) -> list[tuple[Ribbon, Carried]]:
    colours = colours_of(settings.color, shapes)
    return [
        (
            ribbon,
            Carried(
                shape,
                ribbon.solution,
                f"{shape.name}{ribbon.words}",
                colours,
                settings.across,
                ribbon.numbers,
            ),
        )
        for ribbon, shape in zip(ribbons, shapes, strict=True)
    ]


def _written(
    folder: Path,
    name: str,
    carried: Iterable[tuple[Ribbon, Carried]],
    formats: Sequence[str],
) -> list[Path]:
    """Write all files and return where; OutputError if that cannot be."""
    paths: list[Path] = []
    listed: dict[tuple[str, str], list[tuple[str, Ribbon]]] = {}
    with ExitStack() as stack:
        place = stack.enter_context(claimed(folder, (), alone=False))

        def put(files: Mapping[str, bytes], common: str) -> None:
            for ending, content in files.items():
                paths.append(_put(place / f"{common}{ending}", content))

        for ribbon, one in carried:
            for kind in formats:
                files = FORMATS[kind].write(one)
                put(files, f"{name}{ribbon.label}")
                if ribbon.series is not None and FORMATS[kind].series:
                    for ending in files:
                        line = ending.removesuffix(f".{kind}")
                        file = f"{name}{ribbon.label}{ending}"
                        listed.setdefault((ribbon.series, line), []).append((file, ribbon))
        for (label, line), members in listed.items():
            put(_series(members), f"{name}{label}{line}")
    return paths


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
