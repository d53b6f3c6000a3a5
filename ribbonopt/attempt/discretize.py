"""From what a scene says of its transcription to the transcription itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ribbonopt.scene import Collocation, Scene
from ribbonopt.transcription import CollocationMethod

if TYPE_CHECKING:
    from ribbonopt.transcription.shooting.shooting import MultipleShooting


def transcription_of(scene: Scene) -> CollocationMethod | MultipleShooting:
    """Return the transcription a scene asks for; TranscriptionError where there is none such."""
    settings = scene.transcription
    if isinstance(settings, Collocation):
        return CollocationMethod.named(settings.scheme, settings.degree)
    from ribbonopt.transcription.shooting.shooting import MultipleShooting  # few scenes need it

    return MultipleShooting.named(settings.scheme, settings.degree, settings.steps)
