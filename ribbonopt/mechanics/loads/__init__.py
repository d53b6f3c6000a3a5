"""Loads along a ribbon: force and couple per length, a file for each kind."""
