"""Formulas of scenes: their grammar, their parts, their values."""
