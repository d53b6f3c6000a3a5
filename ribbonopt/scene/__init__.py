"""What a user writes: one scene as frozen data, read from YAML or built in Python."""

from __future__ import annotations

from .laws import (
    Homotopy,
    Kirchhoff,
    Law,
    Regularized,
    Sadowsky,
    SingleSheet,
    Variational,
)
from .model import (
    Algebraic,
    AnyVector,
    Auto,
    Boundary,
    Collocation,
    Directors,
    End,
    Ipopt,
    LabVector,
    LoadGuess,
    Newton,
    Scene,
    Shooting,
    SolutionGuess,
    StrainGuess,
    Value,
)
from .yamlio import dump_scene, json_schema, load_scene, loads_scene, locate, validate_scene

__all__ = [
    "Algebraic",
    "AnyVector",
    "Auto",
    "Boundary",
    "Collocation",
    "Directors",
    "End",
    "Homotopy",
    "Ipopt",
    "Kirchhoff",
    "LabVector",
    "Law",
    "LoadGuess",
    "Newton",
    "Regularized",
    "Sadowsky",
    "Scene",
    "Shooting",
    "SingleSheet",
    "SolutionGuess",
    "StrainGuess",
    "Value",
    "Variational",
    "dump_scene",
    "json_schema",
    "load_scene",
    "loads_scene",
    "locate",
    "validate_scene",
]
