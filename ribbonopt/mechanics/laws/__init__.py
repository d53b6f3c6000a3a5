"""Constitutive laws: relations between strains and moments, one file for each kind."""
