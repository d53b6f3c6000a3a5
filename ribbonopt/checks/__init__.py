"""Verdicts on a solution: whether it is what was asked, stable, in the range of the model."""
