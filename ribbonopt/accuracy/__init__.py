"""Accuracy: what a solution is worth, checked on its dense output."""
