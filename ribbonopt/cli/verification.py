"""The verb `verify`: numbers with sources, computed again."""

from __future__ import annotations

import argparse
import gc
from contextlib import closing
from typing import TYPE_CHECKING

from .common import NOT_CONVERGED, listing
from .progress import ProgressLine
from .terminal import complain, say, say_json, say_line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ribbonopt.studies.verification.claims import Claim
    from ribbonopt.studies.verification.run import Verification


def verify(options: argparse.Namespace) -> int:
    """Compute all numbers of a file, or some, and compare them with their sources."""
    from ribbonopt.studies.verification.claims import chosen
    from ribbonopt.studies.verification.written import OWN, load_claims

    gc.enable()  # many scenes, each soon done with
    file, name = (OWN, OWN.name) if options.file is None else (options.file, options.file)
    claims = chosen(load_claims(file), options.rows)
    written = None
    if options.out:
        from ribbonopt.output.staging import staged_result
        from ribbonopt.studies.verification.files import FILES, save_verification

        # The place is known to be good before a minute is spent.
        with staged_result(options.out, FILES) as stage:
            study = _shown(options, claims, name)
            save_verification(study, stage.folder)
            written = stage.commit()
    else:
        study = _shown(options, claims, name)
    if options.json:
        say_json(study.plain())
    elif not options.quiet:
        from ribbonopt.studies.verification.table import table

        say(table(study))
        if written:
            say_line(f"written: {listing(written)}")
    if study.right:
        return 0
    off = len(study.verdicts) - study.counts["ok"]
    complain(f"{name}: {off} of {len(study.verdicts)} rows are not confirmed")
    return NOT_CONVERGED


def _shown(options: argparse.Namespace, claims: Sequence[Claim], name: str) -> Verification:
    """Compute with a line of progress on a terminal."""
    from ribbonopt.studies.verification.run import verify

    line = ProgressLine(quiet=options.quiet)

    def told(text: str) -> None:
        if line.due:
            line.show(text)

    with closing(line):
        return verify(claims, name, told)
