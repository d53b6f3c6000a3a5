"""`python -m ribbonopt`: the command line."""

from ribbonopt.cli import run

run()
