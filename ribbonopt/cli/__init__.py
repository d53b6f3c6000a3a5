"""The command line: `ribbonopt VERB ...`. The only room that prints.

Exit status: 0 done, 2 bad input (nothing written), 3 not converged or not the problem asked for
(what there is is kept beside the wanted folder) or not all of it drawn; 128 + the number of a
signal that ended it, 141 if the reader of stdout has left. Heavy imports happen in the verb that
needs them.
"""

from __future__ import annotations

import argparse
import gc
import os
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import NoReturn

from ribbonopt.errors import ConvergenceError, ModelError, PictureError, RibbonoptError

from .arguments import parser
from .common import BAD_INPUT, INTERRUPTED, NOT_CONVERGED
from .signals import Signals
from .streams import flushed, open_standard_streams, unheard
from .terminal import UnheardError, bounded, complain, say_json


def run() -> NoReturn:
    """Run the command line in a process of its own; entry point of `ribbonopt`."""
    # Before numpy is loaded: threads cost small matrices more than they bring.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    open_standard_streams()
    signals = Signals()
    try:
        status = main()
    except SystemExit as end:  # of the parser, which has said why
        status = flushed(end.code if isinstance(end.code, int) else BAD_INPUT)
    os._exit(signals.status(status))  # taking all objects apart would cost an eighth more


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status; what it printed has left."""
    # Commands are short: collecting garbage on the way costs a tenth of the time, frees nothing.
    collecting = gc.isenabled()
    gc.disable()
    try:
        return flushed(_run(parser().parse_args(arguments)))
    except UnheardError as error:
        return unheard(error.__cause__)
    except KeyboardInterrupt:
        complain("interrupted; nothing half-written is left")
        return INTERRUPTED
    finally:
        if collecting:
            gc.enable()


def _run(options: argparse.Namespace) -> int:
    try:
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
    except MemoryError:
        message = "there is not enough memory; solve something smaller, or on a larger machine"
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
    module = import_module(f"{__name__}.{MODULES[name]}")
    # `continue` is no name of a Python function.
    verb: Callable[[argparse.Namespace], int] = getattr(module, name.replace("continue", "follow"))
    return verb


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
