"""`python -m ribbonopt`: the command line."""

from .cli import run

run()
