"""One command: its words, what it runs, and what its errors come to."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from importlib import import_module

from ribbonopt.errors import (
    ConvergenceError,
    ModelError,
    PictureError,
    RibbonoptError,
    SceneError,
    no_memory,
)

from .arguments import parser
from .common import BAD_INPUT, NOT_CONVERGED
from .terminal import bounded, complain, say_json

MODULES = {
    "solve": "scene",
    "check": "scene",
    "plot": "plot",
    "export": "export",
    "view": "view",
    "schema": "scene",
    "modes": "modes",
    "compare": "comparison",
    "bench": "comparison",
    "stress": "stress",
    "continue": "branch",
    "map": "map",
    "batch": "batch",
    "verify": "verification",
}
#: what functions are called of verbs that are words of Python's own
OTHERWISE = {"continue": "follow", "map": "mapped"}


def run_command(arguments: Sequence[str] | None) -> int:
    """Run one command and return its exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    options = parser(given).parse_args(given)
    try:
        if getattr(options, "out", None) == "":  # such as a variable that is not set
            raise SceneError("--out: found '', expected a folder")
        return _verb(options.verb)(options)
    except PictureError as error:
        return _fail(options, str(error), "not_drawn", NOT_CONVERGED)
    except ConvergenceError as error:
        return _fail(options, str(error), error.status, NOT_CONVERGED)
    except ModelError as error:
        return _fail(options, f"{_place(options, error)}: {error}", "bad_input", BAD_INPUT)
    except RibbonoptError as error:
        return _fail(options, str(error), "bad_input", BAD_INPUT)
    except OSError as error:  # of a file or a disk that nobody has looked at before
        return _fail(options, str(error), "bad_input", BAD_INPUT)
    except (MemoryError, RuntimeError) as error:
        if not no_memory(error):
            raise
        message = "there is not enough memory; solve something smaller (fewer intervals under "
        message += "transcription.intervals), or on a larger machine"
        return _fail(options, message, "no_memory", NOT_CONVERGED)


def _place(options: argparse.Namespace, error: ModelError) -> str:
    """File and line of the key that an error blames."""
    from ribbonopt.scene import locate

    scene = getattr(options, "scene", None)
    if scene is None:  # of a folder, or of a study
        return str(getattr(options, "result", None) or ", ".join(options.study))
    where = locate(scene, options.set, error.key) if error.key else ""
    return f"{scene}, {where}" if where else str(scene)


def _fail(options: argparse.Namespace, error: str, status: str, code: int) -> int:
    complain(error)
    if getattr(options, "json", False):
        say_json({"status": status, "verified": False, "message": bounded(error)})
    return code


def _verb(name: str) -> Callable[[argparse.Namespace], int]:
    """Return what a verb runs; only its own module is imported."""
    module = import_module(f"ribbonopt.cli.{MODULES[name]}")
    verb: Callable[[argparse.Namespace], int] = getattr(module, OTHERWISE.get(name, name))
    return verb
