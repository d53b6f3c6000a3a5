"""Transcription: boundary-value problem and mesh to NLP; knows nothing of ribbons."""

from .collocation import Collocation
from .layout import Layout
from .mesh import Mesh
from .nlp import NLP, NLPFunctions
from .tableaus import Tableau, gauss, radau

__all__ = [
    "NLP",
    "Collocation",
    "Layout",
    "Mesh",
    "NLPFunctions",
    "Tableau",
    "gauss",
    "radau",
]
