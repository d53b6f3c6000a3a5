"""Figures of the paper, a module for each, and its misprints: see `scripts/paper_figures.py`."""
