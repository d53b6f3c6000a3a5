"""The page of the command line: each verb with its options, from the parsers themselves."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from pieces import code, fenced, page, table

from ribbonopt.cli.arguments import VERBS, parser

WORDS = """\
What `ribbonopt --help` and `ribbonopt COMMAND --help` print. [Commands](../commands.md) says what
they are for and what they write, [messages](../messages.md) what they end with.
"""


def pages(folder: Path) -> dict[str, str]:
    """Return the page of all verbs."""
    os.environ["COLUMNS"] = "68"  # the width that usages are broken to
    whole = parser()
    found = [action for action in whole._actions if isinstance(action, argparse._SubParsersAction)]
    sections = [_section(name, found[0].choices[name]) for name in VERBS]
    return {
        "options.md": page(
            "# Options of all commands", WORDS, fenced(whole.format_help()), *sections
        )
    }


def _section(name: str, verb: argparse.ArgumentParser) -> str:
    formatter = verb._get_formatter()
    actions = [action for action in verb._actions if action.dest != "help"]
    rows = [
        [_named(action, formatter), formatter._expand_help(action) if action.help else ""]
        for action in actions
    ]
    words = VERBS[name][0]
    return page(
        f"(command-{name})=",
        f"## `ribbonopt {name}`",
        f"{words[0].upper()}{words[1:]}.",
        fenced(verb.format_usage().replace("usage: ", "")),
        table(("option", "what it does"), rows) if rows else "",
        fenced(verb.epilog) if verb.epilog else "",
    )


def _named(action: argparse.Action, formatter: argparse.HelpFormatter) -> str:
    """Return an option with what it takes, as its usage does."""
    if not action.option_strings:
        return code(str(action.metavar or action.dest))
    taken = "" if action.nargs == 0 else f" {formatter._format_args(action, action.dest.upper())}"
    return ", ".join(code(f"{option}{taken}") for option in action.option_strings)
