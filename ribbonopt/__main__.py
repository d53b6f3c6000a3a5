"""`python -m ribbonopt`: the command line."""

import sys

from ribbonopt.cli import main

sys.exit(main())
