"""Collocation: polynomials on elements, their equations at stages."""
