"""Transcription: boundary-value problem and mesh to NLP; knows nothing of ribbons.

Multiple shooting, and the interfaces for the type checker, are imported when first used.
"""

from typing import TYPE_CHECKING, Any

from .collocation.collocation import CollocationMethod
from .layout import Layout
from .mesh import Mesh
from .nlp import NLP, NLPFunctions
from .tableaus import Tableau, gauss, lobatto, radau

if TYPE_CHECKING:
    from .shooting.shooting import MultipleShooting
    from .structure import Blocks, Output

__all__ = [
    "NLP",
    "Blocks",
    "CollocationMethod",
    "Layout",
    "Mesh",
    "MultipleShooting",
    "NLPFunctions",
    "Output",
    "Tableau",
    "gauss",
    "lobatto",
    "radau",
]


def __getattr__(name: str) -> Any:
    if name == "MultipleShooting":
        from .shooting.shooting import MultipleShooting

        return MultipleShooting
    if name in ("Blocks", "Output"):
        from . import structure

        return getattr(structure, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
