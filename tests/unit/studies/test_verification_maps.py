"""Rows of natural frequencies and of loci: what they read, and what is told where there is none."""

import pytest

from ribbonopt.scene import Scene, loads_scene
from ribbonopt.studies.verification.answers import Answers
from ribbonopt.studies.verification.measured import BAR, NoAnswerError
from ribbonopt.studies.verification.number import UnknownNumberError
from ribbonopt.studies.verification.quantities import quantity

FIRST = 3.51601526850  # cos x cosh x = -1, clamped and free


def strip(law: str = "{type: kirchhoff, B2: 1, B3: 2}", more: str = "") -> Scene:
    return loads_scene(
        f"""
        name: strip
        law: {law}
        boundary:
          start: {{support: clamped, position: [0, 0, 0], directors: identity}}
          end: {{support: free, force: [0, 0, load]}}
        parameters: {{load: 0}}
        tolerance: 1e-10
        {more}
        """
    )


def test_a_frequency_and_its_bar() -> None:
    scene = strip()
    found = quantity("frequency.1", scene)(Answers(scene))
    assert found.basis == BAR
    assert abs(found.value - FIRST) <= found.bar <= 1e-8


def test_a_law_without_energy_has_no_frequencies() -> None:
    scene = strip("{type: regularized, epsilon: 0.01}")
    with pytest.raises(NoAnswerError, match="no energy"):
        quantity("frequency.1", scene)(Answers(scene))


def test_no_frequency_has_the_number_zero() -> None:
    with pytest.raises(UnknownNumberError):
        quantity("frequency.0", strip())


def test_a_locus_is_asked_of_what_follows_none() -> None:
    branch = "continuation: {parameter: parameters.load, from: 0, to: -1}"
    with pytest.raises(UnknownNumberError, match="no locus"):
        quantity("locus(0.25)", strip(more=branch))


def test_a_locus_is_asked_at_a_word() -> None:
    locus = (
        "continuation: {parameter: [parameters.load, law.B2], of: branch point, "
        "between: [-1, -3], to: 2}"
    )
    with pytest.raises(UnknownNumberError, match="found 'here', expected the parameter's value"):
        quantity("locus(here)", strip(more=locus))
