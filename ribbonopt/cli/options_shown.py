"""Options of the verbs that show or carry away what was saved, a function for each."""

from __future__ import annotations

import argparse

from .options import columns


def plot(verb: argparse.ArgumentParser) -> None:
    """Options of `plot`."""
    verb.add_argument("result", metavar="RESULT", help="folder written by solve, continue or batch")
    columns(verb, "columns of a branch or a batch to draw, such as u2:energy")
    verb.add_argument("--out", metavar="DIR", help="folder for the pictures (default: RESULT)")


def export(verb: argparse.ArgumentParser) -> None:
    """Options of `export`."""
    verb.add_argument("result", metavar="RESULT", help="folder written by solve, continue or batch")
    verb.add_argument(
        "--format",
        metavar="LIST",
        help="some of vtp, glb, ply, obj, stl, csv, npz, json (default: the ending of --out, or "
        "vtp)",
    )
    verb.add_argument(
        "--out", metavar="PATH", help="file, such as helix.glb, or folder (default: RESULT/exports)"
    )
    verb.add_argument(
        "--half-width",
        metavar="W",
        help="of the surface (default: the ribbon's own, or one that keeps generatrices apart)",
    )
    verb.add_argument(
        "--rows", default="241", metavar="N", help="about how many along the piece solved (241)"
    )
    verb.add_argument("--across", default="4", metavar="N", help="strips from edge to edge (4)")
    verb.add_argument(
        "--color", default="u2", metavar="FIELD", help="what glb and ply are coloured by (u2)"
    )
    verb.add_argument(
        "--piece", action="store_true", help="only what was solved, without what symmetry adds"
    )


def view(verb: argparse.ArgumentParser) -> None:
    """Options of `view`."""
    verb.add_argument("result", metavar="RESULT", help="folder written by solve, continue or batch")
    verb.add_argument("--out", metavar="FILE", help="the page (default: RESULT/view.html)")
    verb.add_argument(
        "--half-width",
        metavar="W",
        help="half-width to draw to, where the width is 1 in units of its own "
        "(default: the ribbon's own, or one with which generatrices keep apart)",
    )
    verb.add_argument("--open", action="store_true", help="open the page in the browser")
