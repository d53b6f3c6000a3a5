"""Buckling loads of ribbons that are straight and without bending or twisting moment."""
