"""Batches: many ribbons from one study file, by worker processes that may die."""
