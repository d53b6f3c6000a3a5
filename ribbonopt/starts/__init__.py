"""Starts: from a scene alone to a guess that Newton's method can finish."""
