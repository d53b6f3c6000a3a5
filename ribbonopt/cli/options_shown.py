"""Options of the verbs that show or carry away what was saved, a function for each."""

from __future__ import annotations

import argparse

from .options import columns


def plot(verb: argparse.ArgumentParser) -> None:
    """Options of `plot`."""
    verb.add_argument("result", metavar="RESULT", help="folder written by solve, continue or batch")
    columns(verb, "columns of a branch or a batch to draw, such as u2:energy")
    verb.add_argument("--out", metavar="DIR", help="folder for the pictures (default: RESULT)")
