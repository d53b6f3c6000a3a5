"""The figures of a branch, and a moving picture along it: from its rows and stored points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .common import say_left_out

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.plain import Rows
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.recorded import Recorder
    from ribbonopt.views.branch_rows import BranchFigure

    from .drawing import Wanted


def draw_branch(
    continuation: Continuation,
    lines: list[dict[str, Any]],
    pairs: list[tuple[str, str]],
    out: Path,
    source: Path,
    asked: Wanted | None = None,
) -> list[Path]:
    """Draw what is asked for, or else the usual, into a folder and return where.

    Parameters
    ----------
    continuation, lines
        Of the scene, and what its folder, `source`, says of each point.
    pairs
        Columns (x, y) of the panels; the usual ones if there are none.
    """
    from ribbonopt.studies.continuation.files import FILE, rows_of
    from ribbonopt.studies.continuation.stored import restored
    from ribbonopt.views.branch import save_branch_figures
    from ribbonopt.views.paper_style import PLAIN

    rows = rows_of(lines)
    inset, style = (asked.inset, asked.style) if asked else ((), PLAIN)
    figure = _figure(continuation, rows, pairs, dict(style.labels))
    if asked:
        from .drawing import refuse_points

        refuse_points(inset, [row["number"] for row in rows])
    numbers = {row["number"] for row in figure.pictured} | {*inset}
    solutions = dict(restored(continuation, lines, sorted(numbers), source / FILE))
    drawn = save_branch_figures(figure, solutions, out, style, inset)
    say_left_out(drawn.left_out)
    if asked is None or asked.moving is None:
        return drawn.paths
    from ribbonopt.views.animation import frames_of, save_animation
    from ribbonopt.views.branch_words import caption_of

    frames = frames_of(rows)
    by_number = {row["number"]: row for row in rows}
    shown = dict(restored(continuation, lines, frames, source / FILE))
    captions = [", ".join(caption_of(by_number[n], figure).splitlines()) for n in shown]
    path = out / f"branch.{asked.moving}"
    save_animation([*shown.values()], captions, path, style, figure.title)
    if len(frames) < len(rows):
        say_left_out([f"{path.name}: {len(rows) - len(frames)} of {len(rows)} points"])
    return [*drawn.paths, path]


def _figure(
    continuation: Continuation,
    rows: Rows,
    pairs: list[tuple[str, str]],
    labels: dict[str, str],
) -> BranchFigure:
    """Return what the figures show; `labels` go before those of the scene."""
    from ribbonopt.studies.continuation.walk.steps import JUMPED
    from ribbonopt.views.branch_rows import BranchFigure

    scene = continuation.scene
    return BranchFigure(
        rows,
        tuple(pairs or _planes_of(continuation) or _usual(rows, continuation.recorder)),
        title=scene.name,
        log=[stage.moved for stage in continuation.stages if stage.scale == "log"],
        jumps=[row["number"] for row in rows if JUMPED in row.get("note", "")],
        si=scene.ribbon is not None,
        labels={**scene.labels, **labels},
    )


def _planes_of(continuation: Continuation) -> list[tuple[str, str]]:
    """Return the planes of parameters in which loci are followed, each once."""
    loci = (stage.paths for stage in continuation.stages if stage.is_locus)
    return list(dict.fromkeys((first, second) for first, second in loci))[:4]


def _usual(rows: Rows, recorder: Recorder) -> list[tuple[str, str]]:
    """Return what is worth seeing: what the scene records, and of all rows what changes."""
    from ribbonopt.views.columns import varied

    x = recorder.parameters[0] if len(recorder.parameters) == 1 else "value"
    others = [name for name in ("u2", "energy", "H0", "u3") if varied(rows, name)]
    return [(x, name) for name in [*recorder.formulas, *others] or ["energy"]][:4]
