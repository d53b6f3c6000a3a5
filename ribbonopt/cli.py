"""The command line: `ribbonopt VERB ...`. The only place that prints.

Exit status: 0 done, 2 bad input (nothing written), 3 not converged or not the problem asked for
(what there is is kept beside the wanted folder). Heavy imports happen in the verb that needs them.
"""

from __future__ import annotations

import argparse
import gc
import os
import sys
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

from ribbonopt.arguments import chosen, count, numbers, parser
from ribbonopt.errors import ConvergenceError, ModelError, RibbonoptError

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.scene import Scene
    from ribbonopt.solution import Solution
    from ribbonopt.studies.benchmark import Benchmark
    from ribbonopt.studies.compare import Comparison

BAD_INPUT, NOT_CONVERGED = 2, 3
INTERRUPTED, READER_GONE = 130, 141


def run() -> NoReturn:
    """Run the command line in a process of its own; entry point of `ribbonopt`."""
    # Before numpy is loaded: threads cost small matrices more than they bring.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    os._exit(main())  # taking all objects apart would cost an eighth more


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status; what it printed has left."""
    options = parser().parse_args(arguments)
    # Commands are short: collecting garbage on the way costs a tenth of the time, frees nothing.
    collecting = gc.isenabled()
    gc.disable()
    try:
        status = _run(options)
        sys.stdout.flush()
        return status
    except BrokenPipeError:
        # The reader of stdout has left: nobody to tell, and nothing more to flush at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return READER_GONE
    finally:
        if collecting:
            gc.enable()


def _run(options: argparse.Namespace) -> int:
    try:
        return VERBS[options.verb](options)
    except ConvergenceError as error:
        return _fail(options, str(error), error.status, NOT_CONVERGED)
    except ModelError as error:
        return _fail(options, f"{_place(options, error)}: {error}", "bad_input", BAD_INPUT)
    except RibbonoptError as error:
        return _fail(options, str(error), "bad_input", BAD_INPUT)
    except KeyboardInterrupt:
        print("ribbonopt: interrupted; nothing written", file=sys.stderr)
        return INTERRUPTED


def _solve(options: argparse.Namespace) -> int:
    scene, import_seconds = _load(options)
    from ribbonopt.pipeline import solve

    if not (options.out or options.plot):
        return _tell(options, solve(scene), import_seconds, None)
    from ribbonopt.results import save_solution
    from ribbonopt.staging import staged_result

    # Claimed before solving, so that a folder that cannot be written costs no solve.
    with staged_result(options.out or f"results/{scene.name}") as stage:
        solution = solve(scene)
        save_solution(solution, stage.folder)
        if options.plot:
            from ribbonopt.views import save_figures

            save_figures(solution, stage.folder)
        written = stage.commit(solution.status.failure)
    return _tell(options, solution, import_seconds, written)


def _load(options: argparse.Namespace) -> tuple[Scene, float]:
    """Read the scene; also return the seconds that imports took."""
    start = time.perf_counter()
    from ribbonopt.scene import load_scene

    reading = time.perf_counter()
    scene = load_scene(options.scene, options.set)
    # The heavy import comes after the scene is known to be good.
    read = time.perf_counter()
    import ribbonopt.pipeline  # noqa: F401

    return scene, (reading - start) + (time.perf_counter() - read)


def _tell(
    options: argparse.Namespace, solution: Solution, import_seconds: float, written: Path | None
) -> int:
    from ribbonopt.report import report
    from ribbonopt.summary import summarize

    summary = summarize(solution)
    summary["timings"] = {"import": import_seconds} | summary["timings"]
    if options.json:
        _print_json(summary)
    elif not options.quiet:
        print(report(summary))
        if written:
            names = ", ".join(sorted(p.name for p in written.iterdir()))
            print(f"  written: {written}: {names}")
    if solution.verified:
        return 0
    kept = f"; kept in {written}" if written else ""
    print(f"ribbonopt: {solution.scene.name}: {solution.message}{kept}", file=sys.stderr)
    return NOT_CONVERGED


def _check(options: argparse.Namespace) -> int:
    scene, _ = _load(options)
    from ribbonopt.check import check_scene

    found = check_scene(scene)
    if options.json:
        _print_json(found)
    elif not options.quiet:
        print(_checked(found))
    return 0


def _checked(found: dict[str, Any]) -> str:
    unknowns = ", ".join(f"{name} {count}" for name, count in found["unknowns"].items())
    lines = [
        f"{found['name']}: valid",
        f"  {sum(found['unknowns'].values())} unknown numbers: {unknowns}",
        f"  {len(found['conditions'])} conditions:",
        *(f"    {name}" for name in found["conditions"]),
        f"  {found['size']} unknowns once discretised",
        "  will be skipped:",
        *(f"    {reason}" for reason in found["skipped"]),
    ]
    return "\n".join(lines)


def _compare(options: argparse.Namespace) -> int:
    tolerances = numbers("--tolerances", options.tolerances)
    scene, _ = _load(options)
    from ribbonopt.studies.compare import compare

    return _study(options, "comparison", lambda: compare(scene, *chosen(options), tolerances))


def _bench(options: argparse.Namespace) -> int:
    repeat = count("--repeat", options.repeat)
    scene, _ = _load(options)
    from ribbonopt.studies.benchmark import benchmark

    return _study(
        options, "benchmark", lambda: benchmark(scene, *chosen(options), repeat, options.quick)
    )


def _study(
    options: argparse.Namespace, name: str, run: Callable[[], Comparison | Benchmark]
) -> int:
    gc.enable()  # many scenes, and most of what they build is soon done with
    if options.out:
        from ribbonopt.staging import staged_result
        from ribbonopt.studies.files import save_study
        from ribbonopt.views.comparison import save_figure

        # The place is known to be good before minutes are spent.
        own = frozenset(f"{name}.{kind}" for kind in ("csv", "json", "png"))
        with staged_result(options.out, own) as stage:
            study = run()
            save_study(study, stage.folder, name)
            save_figure(study.plain(), stage.folder / f"{name}.png")
            stage.commit()
    else:
        study = run()
    if options.json:
        _print_json(study.plain())
    elif not options.quiet:
        from ribbonopt.studies.table import table

        print(table(study))
    if study.solved:
        return 0
    print(f"ribbonopt: {study.name}: no pair gave a verified solution", file=sys.stderr)
    return NOT_CONVERGED


def _schema(options: argparse.Namespace) -> int:
    from ribbonopt.scene import json_schema

    _print_json(json_schema(), indent=2)
    return 0


def _plot(options: argparse.Namespace) -> int:
    from ribbonopt.results import load_solution
    from ribbonopt.staging import picture_folder
    from ribbonopt.views import save_figures

    solution = load_solution(options.result)
    folder = picture_folder(options.out or options.result)
    for path in save_figures(solution, folder):
        print(path)
    return 0


def _print_json(value: dict[str, Any], indent: int | None = None) -> None:
    import json  # most commands print text

    print(json.dumps(value, indent=indent, allow_nan=False))


def _place(options: argparse.Namespace, error: ModelError) -> str:
    """File and line of the key that an error blames."""
    from ribbonopt.scene import locate

    where = locate(options.scene, options.set, error.key) if error.key else ""
    return f"{options.scene}, {where}" if where else str(options.scene)


def _fail(options: argparse.Namespace, error: str, status: str, code: int) -> int:
    if getattr(options, "json", False):
        _print_json({"status": status, "verified": False, "message": error})
    print(f"ribbonopt: {error}", file=sys.stderr)
    return code


VERBS: dict[str, Callable[[argparse.Namespace], int]] = {
    "solve": _solve,
    "check": _check,
    "compare": _compare,
    "bench": _bench,
    "schema": _schema,
    "plot": _plot,
}
