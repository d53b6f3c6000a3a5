"""Verbs of many solves: `compare`, `bench`."""

from __future__ import annotations

import argparse
import gc
from collections.abc import Callable
from typing import TYPE_CHECKING

from ribbonopt.scene.limits import REPEATS

from .common import NOT_CONVERGED, drawn, load
from .terminal import complain, say, say_json
from .values import chosen, count, numbers

if TYPE_CHECKING:
    from ribbonopt.studies.comparison.benchmark import Benchmark
    from ribbonopt.studies.comparison.compare import Comparison


def compare(options: argparse.Namespace) -> int:
    """Solve a scene by all formulations and transcriptions, or under several laws."""
    from .laws import laws, refuse_without

    if options.laws is not None:
        return laws(options)
    refuse_without(options)
    tolerances = numbers("--tolerances", options.tolerances)
    scene, _ = load(options)
    from ribbonopt.studies.comparison.compare import compare

    return _study(options, "comparison", lambda: compare(scene, *chosen(options), tolerances))


def bench(options: argparse.Namespace) -> int:
    """Measure time against error over degrees and meshes."""
    repeat = count("--repeat", options.repeat, REPEATS)
    scene, _ = load(options)
    from ribbonopt.studies.comparison.benchmark import benchmark

    return _study(
        options, "benchmark", lambda: benchmark(scene, *chosen(options), repeat, options.quick)
    )


def _study(
    options: argparse.Namespace, name: str, run: Callable[[], Comparison | Benchmark]
) -> int:
    gc.enable()  # many scenes, and most of what they build is soon done with
    if options.out:
        from ribbonopt.output.staging import staged_result
        from ribbonopt.studies.comparison.files import files_of, save_study
        from ribbonopt.views.comparison import save_figure

        # The place is known to be good before minutes are spent.
        with staged_result(options.out, files_of(name)) as stage:
            study = run()
            save_study(study, stage.folder, name)
            written = stage.commit()
            status = drawn(lambda: save_figure(study.plain(), written / f"{name}.png"))
    else:
        study, status = run(), 0
    if options.json:
        say_json(study.plain())
    elif not options.quiet:
        from ribbonopt.studies.comparison.table import table

        say(table(study))
    if study.solved:
        return status
    complain(f"{study.name}: no pair gave a verified solution")
    return NOT_CONVERGED
