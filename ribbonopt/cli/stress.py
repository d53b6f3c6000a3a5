"""The verb `stress`: a scene far from what it was made for."""

from __future__ import annotations

import argparse
import gc
from typing import TYPE_CHECKING

from ribbonopt.scene.limits import SECONDS

from .common import NOT_CONVERGED, drawn, load
from .progress import ProgressLine
from .terminal import complain, say, say_json
from .values import size

if TYPE_CHECKING:
    from ribbonopt.studies.stress.stress import Stress


def stress(options: argparse.Namespace) -> int:
    """Put a scene under stress; 3 where anything is wrong."""
    seconds = size("--seconds", options.seconds, most=SECONDS)
    scene, _ = load(options)
    from ribbonopt.studies.stress.stress import stress

    gc.enable()  # many scenes, and most of what they build is soon done with
    line = ProgressLine(quiet=options.quiet)

    def run() -> Stress:
        try:
            return stress(
                scene,
                options.only,
                options.quick,
                float(seconds or 0),
                lambda text: line.show(text),
            )
        finally:
            line.close()

    status = 0
    if options.out:
        from ribbonopt.output.staging import staged_result
        from ribbonopt.studies.stress.files import FIGURE, FILES, save_stress
        from ribbonopt.views.stress import save_figure

        # The place is known to be good before minutes are spent.
        with staged_result(options.out, FILES) as stage:
            study = run()
            save_stress(study, stage.folder)
            written = stage.commit()
            status = drawn(lambda: save_figure(study.plain(), written / FIGURE))
    else:
        study = run()
    if options.json:
        say_json(study.plain())
    elif not options.quiet:
        from ribbonopt.studies.stress.table import table

        say(table(study))
    if not study.bad:
        return status
    complain(f"{study.name}: {len(study.bad)} of {len(study.rows)} trials wrong or crashed")
    return NOT_CONVERGED
