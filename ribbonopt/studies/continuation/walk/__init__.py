"""Following any curve of solutions: steps, special points, branches, stages; no ribbons here."""
