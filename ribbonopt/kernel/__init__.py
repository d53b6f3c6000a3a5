"""The compiled kernel: stage functions, condensed system and Newton's loop in C, if it was built.

Optional: CasADi stays the only source of equations, and numpy does what the kernel does where it
was not built, where the environment says `RIBBONOPT_KERNEL=off`, and for what it does not cover.
"""

from __future__ import annotations

import os
from importlib import import_module
from types import ModuleType


def _loaded() -> tuple[ModuleType | None, str]:
    if os.environ.get("RIBBONOPT_KERNEL", "on").strip().lower() in ("off", "0", "no", "false"):
        return None, "off (RIBBONOPT_KERNEL)"
    try:
        return import_module("ribbonopt.kernel._compiled"), "compiled"
    except ImportError:
        return None, "not built"


#: the compiled module, or None; and which of these it is, in words
COMPILED, STATE = _loaded()
