"""Options of the verbs that solve, a function for each."""

from __future__ import annotations

import argparse

from .terminal import say


def solve(verb: argparse.ArgumentParser) -> None:
    """Options of `solve`."""
    scene(verb)
    verb.add_argument("--out", metavar="DIR", help="folder for the result (default: none written)")
    verb.add_argument(
        "--plot", action="store_true", help="draw pictures (into --out, or results/NAME)"
    )
    _verbose(verb, "print all numbers, what each step took, and what was skipped and why")


def check(verb: argparse.ArgumentParser) -> None:
    """Options of `check`."""
    scene(verb)
    verb.add_argument(
        "--versions",
        action=_Versions,
        nargs=0,
        help="print instead what answers depend on, the compiled kernel included, and exit",
    )


def compare(verb: argparse.ArgumentParser) -> None:
    """Options of `compare`."""
    scene(verb)
    _pairs(verb)
    verb.add_argument(
        "--tolerances",
        metavar="LIST",
        help="relative errors of n(0), m(0), such as 1e-6,1e-9 (default: 1e-4,1e-6,1e-8,1e-10)",
    )
    _laws(verb)


def bench(verb: argparse.ArgumentParser) -> None:
    """Options of `bench`."""
    scene(verb)
    _pairs(verb)
    verb.add_argument("--repeat", default="11", metavar="N", help="median of N solves")
    verb.add_argument("--quick", action="store_true", help="reduced states, low degrees only")


def stress(verb: argparse.ArgumentParser) -> None:
    """Options of `stress`."""
    scene(verb)
    verb.add_argument(
        "--only", action="append", metavar="KIND", help="such as noise or mesh (may be repeated)"
    )
    verb.add_argument("--quick", action="store_true", help="a few values of each kind")
    verb.add_argument(
        "--seconds", default="20", metavar="N", help="of the processor, for each trial"
    )
    verb.add_argument("--out", metavar="DIR", help="folder for CSV, JSON and figure")


def follow(verb: argparse.ArgumentParser) -> None:
    """Options of `continue`."""
    verb.formatter_class = _help_as_written
    verb.epilog = _branch_columns()
    scene(verb)
    verb.add_argument(
        "--out", metavar="DIR", help="folder of the branch (default: results/NAME-branch)"
    )
    verb.add_argument("--resume", action="store_true", help="go on with the branch in the folder")
    _verbose(verb, "print also what each stage took, and what was skipped and why")
    columns(
        verb,
        "draw columns, such as law.epsilon:energy u2:energy, and ribbons along the branch",
    )


def mapped(verb: argparse.ArgumentParser) -> None:
    """Options of `map`."""
    verb.epilog = (
        "The folder holds map.png, map.json, map.csv (points of all loci), and what was found on "
        "the way as results of their own: map-branches/N/M, map-loci/N, map-points/N/M."
    )
    scene(verb)
    verb.add_argument("--jobs", metavar="N", help="worker processes (default: one for each core)")
    verb.add_argument("--out", metavar="DIR", help="folder of the map (default: results/NAME-map)")
    verb.add_argument("--resume", action="store_true", help="go on with the map in the folder")


def batch(verb: argparse.ArgumentParser) -> None:
    """Options of `batch`."""
    verb.add_argument(
        "study", nargs="+", metavar="STUDY", help="study file, scenes, folder of them or pattern"
    )
    verb.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="override for all ribbons"
    )
    verb.add_argument("--jobs", metavar="N", help="worker processes (default: one for each core)")
    verb.add_argument("--out", metavar="DIR", help="folder of the rows (default: results/NAME)")
    verb.add_argument("--resume", action="store_true", help="complete the rows in the folder")
    verb.add_argument(
        "--retry",
        action="store_true",
        help="with --resume: also solve again what crashed, timed out or met an unforeseen error",
    )
    verb.add_argument("--scheduler", metavar="ADDRESS", help="Dask scheduler to use instead")
    columns(verb, "draw columns against each other too, such as law.epsilon:energy")
    _verbose(verb, "print also what it took: seconds, iterations, starts")
    verb.add_argument("--yes", action="store_true", help="solve more than 100,000 ribbons")
    verb.add_argument("--json", action="store_true", help="print exactly one JSON object")
    verb.add_argument("--quiet", action="store_true", help="print nothing unless it fails")


def verify(verb: argparse.ArgumentParser) -> None:
    """Options of `verify`."""
    verb.add_argument(
        "rows", nargs="*", metavar="ROWS", help="scenes or quantities, such as half 'fold.*'"
    )
    verb.add_argument("--file", metavar="YAML", help="other rows (default: those that are shipped)")
    verb.add_argument("--out", metavar="DIR", help="folder for CSV, JSON and a page")
    verb.add_argument("--json", action="store_true", help="print exactly one JSON object")
    verb.add_argument("--quiet", action="store_true", help="print nothing unless it fails")


def schema(verb: argparse.ArgumentParser) -> None:
    """Options of `schema`."""
    verb.add_argument(
        "what",
        metavar="WHAT",
        nargs="?",
        default="scene",
        choices=("scene", "study"),
        help="of which files: scene (default) or study",
    )


class _Versions(argparse.Action):
    """Prints versions and ends the command, which needs no scene then."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        """Print one line for each."""
        from ribbonopt.output.summary import versions

        width = max(map(len, versions()))
        say("\n".join(f"{name:{width}}  {found}" for name, found in versions().items()))
        parser.exit()


def columns(verb: argparse.ArgumentParser, words: str) -> None:
    """Add `--plot X:Y`."""
    verb.add_argument("--plot", nargs="*", metavar="X:Y", help=words)


def usual_help(prog: str) -> argparse.HelpFormatter:
    """Return a formatter of a given width."""
    # A given width spares the import that asks the terminal for its own.
    return argparse.HelpFormatter(prog, width=100)


def _help_as_written(prog: str) -> argparse.HelpFormatter:
    return argparse.RawDescriptionHelpFormatter(prog, width=100)


def _branch_columns() -> str:
    from textwrap import fill

    from ribbonopt.studies.continuation.columns import COLUMNS, HINT

    lines = [
        fill(text, 98, initial_indent=f"  {name:16}", subsequent_indent=" " * 18)
        for name, text in COLUMNS.items()
    ]
    return "\n".join(["columns of a branch:", *lines, "", fill(HINT, 98)])


def scene(verb: argparse.ArgumentParser, words: str = "YAML file") -> None:
    """Add the scene, and the options of all verbs that solve one."""
    verb.add_argument("scene", metavar="SCENE", help=words)
    verb.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="override one value, such as law.epsilon=1e-3 (may be repeated)",
    )
    verb.add_argument("--json", action="store_true", help="print exactly one JSON object")
    verb.add_argument("--quiet", action="store_true", help="print nothing unless it fails")


def _verbose(verb: argparse.ArgumentParser, words: str) -> None:
    verb.add_argument("--verbose", action="store_true", help=words)


def _pairs(verb: argparse.ArgumentParser) -> None:
    verb.add_argument(
        "--formulations", metavar="LIST", help="such as inverted,energy (default: all)"
    )
    verb.add_argument(
        "--transcriptions", metavar="LIST", help="such as gauss,radau,rk8 (default: all)"
    )
    verb.add_argument("--out", metavar="DIR", help="folder for CSV, JSON and figure")


def _laws(verb: argparse.ArgumentParser) -> None:
    verb.add_argument(
        "--laws",
        metavar="LIST",
        help="instead: solve it under several laws, such as sadowsky,wunderlich, or all; a scene "
        "with `continuation` as branches, a study ribbon by ribbon",
    )
    verb.add_argument("--width", metavar="W", help="with --laws: of a scene without `ribbon`")
    verb.add_argument("--thickness", metavar="H", help="with --laws: the same")
    verb.add_argument("--poisson", metavar="NU", help="with --laws: the same, Poisson's ratio")
    verb.add_argument(
        "--edges",
        metavar="A,B",
        help="with --laws, for wunderlich: does each end hold the edge straight, or is it free, "
        "such as straight,free; where the scene leaves that open",
    )
    verb.add_argument("--jobs", metavar="N", help="with --laws, of a study: worker processes")
