"""The words of the command line: its verbs. Their options: `options.py`, `options_shown.py`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from ribbonopt.version import VERSION

from . import options, options_shown
from .options import usual_help
from .terminal import Parser

VERBS = {
    "solve": ("solve a scene and report its numbers", options.solve),
    "check": ("validate a scene and count unknowns and conditions", options.check),
    "compare": (
        "solve a scene by all formulations and transcriptions, and say which is cheapest",
        options.compare,
    ),
    "bench": ("time against error over degrees and meshes", options.bench),
    "stress": ("try a scene far from what it was made for, and judge every answer", options.stress),
    "modes": (
        "natural frequencies and shapes of small vibrations about a scene's equilibrium",
        options_shown.modes,
    ),
    "continue": (
        "follow a scene's equilibria as a parameter moves (its `continuation`)",
        options.follow,
    ),
    "map": (
        "draw where a scene's shapes come and go as two numbers vary, and how many there are",
        options.mapped,
    ),
    "batch": ("solve all ribbons of a study, on all cores", options.batch),
    "verify": ("compute numbers with sources again, and say which are confirmed", options.verify),
    "schema": ("print the JSON schema of scenes or studies, for editors", options.schema),
    "plot": ("draw the pictures of a saved result", options_shown.plot),
    "export": ("write a saved result for ParaView, Blender, pandas, ...", options_shown.export),
    "view": (
        "write a page on which a saved result, branch or batch is turned and looked at",
        options_shown.view,
    ),
}


def parser(given: Sequence[str] = ()) -> argparse.ArgumentParser:
    """Return the parser of all verbs; `verb` names the one that was given.

    Where the words begin with a verb, the others, which nobody will hear of, are left out.
    """
    result = Parser(
        prog="ribbonopt",
        description="Equilibria of elastic ribbons from YAML scenes.",
        formatter_class=usual_help,
    )
    result.add_argument("--version", action="version", version=f"ribbonopt {VERSION}")
    verbs = result.add_subparsers(prog="ribbonopt", dest="verb", required=True, metavar="COMMAND")
    for name in [given[0]] if given and given[0] in VERBS else VERBS:
        words, fill = VERBS[name]
        fill(verbs.add_parser(name, help=words, formatter_class=usual_help))
    return result
