"""Options of the verbs that show, or carry away, what was solved, a function for each."""

from __future__ import annotations

import argparse

from .options import columns, scene


def plot(verb: argparse.ArgumentParser) -> None:
    """Options of `plot`."""
    verb.add_argument("result", metavar="RESULT", help="folder written by solve, continue or batch")
    columns(verb, "columns of a branch or a batch to draw, such as u2:energy")
    verb.add_argument("--out", metavar="DIR", help="folder for the pictures (default: RESULT)")
    _look(verb)
    _ribbons(verb)


def modes(verb: argparse.ArgumentParser) -> None:
    """Options of `modes`."""
    scene(verb, "YAML file, or a folder written by solve")
    verb.add_argument("--count", default="8", metavar="N", help="the N lowest (8)")
    verb.add_argument(
        "--planar", action="store_true", help="of a planar ribbon: only motion in its plane"
    )
    verb.add_argument(
        "--out",
        metavar="DIR",
        help="folder for solution and modes (default: none written; of a saved result its own)",
    )
    verb.add_argument(
        "--plot", action="store_true", help="draw modes.png (into --out, or results/NAME)"
    )


def _look(verb: argparse.ArgumentParser) -> None:
    """Options that say how figures look on paper."""
    look = verb.add_argument_group("how figures look")
    look.add_argument("--style", metavar="FILE", help="YAML of what follows; options go before it")
    look.add_argument("--format", metavar="LIST", help="png, svg, pdf, or several: pdf,png")
    look.add_argument("--width", metavar="IN", help="inches; 3.35 is a single column")
    look.add_argument("--height", metavar="IN", help="inches (default: follows the width)")
    look.add_argument("--dpi", metavar="N", help="pixels per inch (default: 150)")
    look.add_argument("--font", metavar="NAME", help="sans, serif or a family of this machine")
    look.add_argument("--font-size", metavar="PT", help="of axes (default: follows the width)")
    look.add_argument("--line-scale", metavar="X", help="1: as in a figure of its own size")
    look.add_argument("--letters", action="store_true", help="letter the panels (a), (b), ...")
    look.add_argument("--no-titles", action="store_true", help="no names, units and captions")


def _ribbons(verb: argparse.ArgumentParser) -> None:
    """Options that say how ribbons are seen, and where."""
    seen = verb.add_argument_group("how ribbons are seen")
    seen.add_argument(
        "--camera", metavar="A,E", help="azimuth,elevation in degrees, or an axis: --camera=-x"
    )
    seen.add_argument("--color", metavar="FIELD", help="u2, u3, eta or energy; of a batch a column")
    seen.add_argument("--half-width", metavar="W", help="to which ribbons are drawn")
    seen.add_argument(
        "--inset", metavar="LIST", help="of a branch: points whose ribbons stand in its diagram"
    )
    seen.add_argument(
        "--animate", choices=("gif", "mp4"), help="of a branch: branch.gif or .mp4 along it"
    )


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
        "--modes",
        action="store_true",
        help="of a result: with its modes of small vibrations in motion (by itself where "
        "`ribbonopt modes` has written them)",
    )
    verb.add_argument(
        "--half-width",
        metavar="W",
        help="half-width to draw to, where the width is 1 in units of its own "
        "(default: the ribbon's own, or one with which generatrices keep apart)",
    )
    verb.add_argument("--open", action="store_true", help="open the page in the browser")
