"""`python -m ribbonopt`: the command line."""

import sys

from ribbonopt.cli import run

sys.exit(run())
