"""What a user writes: one scene as frozen data, read from YAML or built in Python."""

from __future__ import annotations

from .along import Along, Scaled, Table, TableFile
from .continuation import ContinuationStage
from .ends import Boundary, End, Loop
from .frames import (
    AnyVector,
    Directors,
    LabVector,
    Quaternion,
    Rotation,
    RotationVector,
    Turn,
    Turns,
    Value,
)
from .guesses import (
    ArcGuess,
    Band,
    Guess,
    Helix,
    HelixGuess,
    LoadGuess,
    MoebiusGuess,
    SolutionGuess,
    StrainGuess,
)
from .laws import (
    Homotopy,
    Kirchhoff,
    Law,
    OwnLaw,
    Regularized,
    Rod,
    Sadowsky,
    SingleSheet,
    Variational,
)
from .loads import Loads, OwnLoad
from .membrane import Membrane
from .model import Reference, RibbonSizes, Scene
from .natural import Natural
from .sized import Extensible, Sano, Wunderlich
from .solving import Algebraic, Auto, Collocation, Ipopt, Newton, Shooting
from .stations import InteriorSupport, PointLoad
from .supports import Support, SupportName
from .yamlio import (
    dump_scene,
    json_schema,
    load_scene,
    loads_scene,
    locate,
    unsayable,
    validate_scene,
)

__all__ = [
    "Algebraic",
    "Along",
    "AnyVector",
    "ArcGuess",
    "Auto",
    "Band",
    "Boundary",
    "Collocation",
    "ContinuationStage",
    "Directors",
    "End",
    "Extensible",
    "Guess",
    "Helix",
    "HelixGuess",
    "Homotopy",
    "InteriorSupport",
    "Ipopt",
    "Kirchhoff",
    "LabVector",
    "Law",
    "LoadGuess",
    "Loads",
    "Loop",
    "Membrane",
    "MoebiusGuess",
    "Natural",
    "Newton",
    "OwnLaw",
    "OwnLoad",
    "PointLoad",
    "Quaternion",
    "Reference",
    "Regularized",
    "RibbonSizes",
    "Rod",
    "Rotation",
    "RotationVector",
    "Sadowsky",
    "Sano",
    "Scaled",
    "Scene",
    "Shooting",
    "SingleSheet",
    "SolutionGuess",
    "StrainGuess",
    "Support",
    "SupportName",
    "Table",
    "TableFile",
    "Turn",
    "Turns",
    "Value",
    "Variational",
    "Wunderlich",
    "dump_scene",
    "json_schema",
    "load_scene",
    "loads_scene",
    "locate",
    "unsayable",
    "validate_scene",
]
