"""The command line: `ribbonopt VERB ...`. The only room that prints.

Exit status: 0 done, 2 bad input (nothing written), 3 not converged or not the problem asked for
(what there is is kept beside the wanted folder). Heavy imports happen in the verb that needs them.
"""

from __future__ import annotations

import argparse
import gc
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import NoReturn

from ribbonopt.errors import ConvergenceError, ModelError, RibbonoptError, no_memory

from .arguments import parser
from .common import BAD_INPUT, INTERRUPTED, NOT_CONVERGED, READER_GONE, print_json


def run() -> NoReturn:
    """Run the command line in a process of its own; entry point of `ribbonopt`."""
    # Before numpy is loaded: threads cost small matrices more than they bring.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Numbers that overflow on the way to a solution are no news: it is verified, or says it failed.
    warnings.simplefilter("ignore", RuntimeWarning)
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
        return _verb(options.verb)(options)
    except ConvergenceError as error:
        return _fail(options, str(error), error.status, NOT_CONVERGED)
    except ModelError as error:
        return _fail(options, f"{_place(options, error)}: {error}", "bad_input", BAD_INPUT)
    except RibbonoptError as error:
        return _fail(options, str(error), "bad_input", BAD_INPUT)
    except (MemoryError, RuntimeError) as error:
        if not no_memory(error):
            raise
        return _fail(options, NO_MEMORY, "no_memory", NOT_CONVERGED)
    except KeyboardInterrupt:
        print("ribbonopt: interrupted; nothing written", file=sys.stderr)
        return INTERRUPTED


def _place(options: argparse.Namespace, error: ModelError) -> str:
    """File and line of the key that an error blames."""
    from ribbonopt.scene import locate

    scene = getattr(options, "scene", None)
    if scene is None:  # of a folder, or of a study
        return str(getattr(options, "result", None) or ", ".join(options.study))
    where = locate(scene, options.set, error.key) if error.key else ""
    return f"{scene}, {where}" if where else str(scene)


def _fail(options: argparse.Namespace, error: str, status: str, code: int) -> int:
    if getattr(options, "json", False):
        print_json({"status": status, "verified": False, "message": error})
    print(f"ribbonopt: {error}", file=sys.stderr)
    return code


def _verb(name: str) -> Callable[[argparse.Namespace], int]:
    """Return what a verb runs; only its own module is imported."""
    module = import_module(f"{__name__}.{MODULES[name]}")
    # `continue` is no name of a Python function.
    verb: Callable[[argparse.Namespace], int] = getattr(module, name.replace("continue", "follow"))
    return verb


NO_MEMORY = (
    "there is not enough memory; choose fewer intervals (transcription.intervals), "
    "or give the process more"
)
MODULES = {
    "solve": "scene",
    "check": "scene",
    "plot": "scene",
    "schema": "scene",
    "compare": "comparison",
    "bench": "comparison",
    "continue": "branch",
    "batch": "batch",
}
