"""What leaves the package: summaries, reports, result folders."""
