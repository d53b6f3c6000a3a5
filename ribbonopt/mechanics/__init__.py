"""Mechanics: the physics of ribbons as CasADi expressions; knows no mesh, solver or YAML."""

from .laws.catalogue import LAWS, ConstitutiveLaw
from .rod import MODELS, RodFields, RodModel, RodState

__all__ = ["LAWS", "MODELS", "ConstitutiveLaw", "RodFields", "RodModel", "RodState"]
