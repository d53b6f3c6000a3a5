"""The command line: `ribbonopt VERB ...`. The only room that prints.

Exit status: 0 done, 2 bad input (nothing written), 3 not converged or not the problem asked for
(what there is is kept beside the wanted folder) or not all of it drawn; 128 + the number of a
signal that ended it, 141 if the reader of stdout has left. Heavy imports happen in the verb that
needs them.
"""

from __future__ import annotations

import gc
import os
import warnings
from collections.abc import Sequence
from typing import NoReturn

from .command import run_command
from .common import BAD_INPUT, INTERRUPTED
from .signals import Signals
from .streams import flushed, open_standard_streams, unheard
from .terminal import UnheardError, complain


def run() -> NoReturn:
    """Run the command line in a process of its own; entry point of `ribbonopt`."""
    # Before numpy is loaded: threads cost small matrices more than they bring.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Numbers that overflow on the way to a solution are no news: it is verified, or says it failed.
    warnings.simplefilter("ignore", RuntimeWarning)
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
        return flushed(run_command(arguments))
    except UnheardError as error:
        return unheard(error.__cause__)
    except KeyboardInterrupt:
        complain("interrupted; nothing half-written is left")
        return INTERRUPTED
    finally:
        if collecting:
            gc.enable()
