"""Mechanics: the physics of ribbons as CasADi expressions; knows no mesh, solver or YAML."""
