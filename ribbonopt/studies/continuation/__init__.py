"""Continuation: branches of equilibria as a number of the scene moves."""
